//! The one door to the writers of pieces.

use std::io::Write;

use crate::pieces::{MeshPieces, Pieces};
use crate::{ExportError, ExportOptions, Format, gltf, obj, ply, stl};

/// What [`write_pieces`] has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct PiecesWritten {
    /// How many pieces there are.
    pub pieces: usize,
    /// Vertices of the surface; what several pieces share is counted once.
    pub vertices: u64,
    /// Triangles, before any of them go that single precision cannot hold. Those that name a vertex twice are left out.
    pub triangles: u64,
    /// Edges at which a piece is open and no other goes on: 0 where all of them together are watertight.
    pub open_edges: u64,
}

/// Writes pieces of a surface as one file, in memory for a few of them at a time and for the edges at which they meet.
///
/// | | |
/// |---|---|
/// | OBJ | an object for each piece; vertices at which pieces meet stand in the file once, so that its indices are watertight |
/// | PLY | the same as one list, unless normals or texture coordinates are asked for: these split vertices |
/// | STL | one list of triangles; positions at which pieces meet are equal |
/// | glTF | a mesh node for each piece, on one grid: where pieces meet, translation and position have the same sum to the last bit |
/// | 3MF | not written: each of its objects must be closed |
///
/// The grid of glTF is as fine as single precision (or 16 bits, quantized) at the farthest corner of the largest piece: a step of it is at most
/// 2⁻²³ (2⁻¹⁴) of how far that reaches from the middle. Nearer to the middle of a piece, and in pieces that are smaller, files of parts are more precise.
/// `EXT_mesh_manifold` is said of closed pieces alone.
///
/// Where a piece touches itself at an open edge, what belongs together is found by the edges, not by positions. Smooth normals, texture coordinates and
/// tangents follow from each piece by itself. Pieces are read two to four times. glTF is written to a temporary file first
/// ([`MeshPieces::temporary_file`]), so `out` gets nothing before it is known that the file is not too large; for other formats the survey tells.
///
/// # Errors
/// As for [`write_parts`](crate::write_parts); [`ExportError::NotInPieces`] for 3MF; [`ExportError::ReadPiece`] and [`ExportError::ChangedPiece`] where
/// a piece cannot be read as it was.
pub fn write_pieces(
    pieces: &dyn MeshPieces,
    format: Format,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<PiecesWritten, ExportError> {
    options.check()?;
    if format == Format::ThreeMf {
        return Err(ExportError::NotInPieces { extension: format.extension() });
    }
    let pieces = Pieces::survey(pieces)?;
    match format {
        Format::Glb => gltf::write_glb_pieces(&pieces, options, out)?,
        Format::Gltf => gltf::write_gltf_pieces(&pieces, options, out)?,
        Format::Obj => obj::write_obj_pieces(&pieces, options, out)?,
        Format::Stl => stl::write_stl_pieces(&pieces, options, out)?,
        Format::Ply => ply::write_ply_pieces(&pieces, options, out)?,
        Format::ThreeMf => {}
    }
    Ok(PiecesWritten {
        pieces: pieces.count(),
        vertices: pieces.vertices(),
        triangles: pieces.triangles(),
        open_edges: pieces.open_edges(),
    })
}
