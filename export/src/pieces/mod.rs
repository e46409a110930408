//! One file of many meshes that together are one surface, of which one at a time is in memory.
//!
//! Way of a file through this folder: a survey reads each piece once, counts what is in it and collects the edges at which it is open
//! ([`seams`]); the two sides of each seam are put together there. Then the writer of the format reads the pieces again, as often as it
//! needs them ([`piece`] brings each into the same form), and [`numbers`] says which number a vertex has in the file.

mod numbers;
mod piece;
mod seams;

use std::io::{self, Write};

use glam::DVec3;
use planecut_csg::Mesh;

pub(crate) use numbers::{Numbering, Numbers};
pub(crate) use piece::Piece;

use self::seams::{Joined, Seams};
use crate::part::check_mesh;
use crate::{ExportError, ExportOptions, Format, gltf, obj, ply, stl};

/// Meshes that together are one closed surface, read one at a time, as often as a writer asks.
///
/// Each is closed but for the edges at which it meets others: along these the other has an edge in the opposite direction, between the same
/// positions to the last bit (0 and -0 are one).
pub trait MeshPieces {
    /// How many there are.
    fn count(&self) -> usize;

    /// Reads one of them, by its number from 0: the same mesh each time. It has its own materials.
    ///
    /// # Errors
    /// Whatever keeps it from being read; writers give it as [`ExportError::ReadPiece`].
    fn piece(&self, number: usize) -> io::Result<Mesh>;

    /// What one of them is called, where the format has a place for it; may be empty.
    fn name(&self, number: usize) -> String {
        format!("piece {number}")
    }

    /// An empty file to write to and to read from, which is gone when it is closed: one in the system's folder of temporary files, unless this is
    /// replaced. glTF needs one as large as the file that is written.
    ///
    /// # Errors
    /// Those of the file system.
    fn temporary_file(&self) -> io::Result<std::fs::File> {
        tempfile::tempfile()
    }
}

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
        open_edges: pieces.joined.open_edges,
    })
}

/// What is known of a piece after the survey.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Known {
    vertices: usize,
    triangles: usize,
    /// Vertices at open edges.
    open_vertices: usize,
    bounds: Option<[DVec3; 2]>,
}

impl Known {
    fn of(piece: &Piece) -> Self {
        let (vertices, triangles) = (piece.mesh.positions.len(), piece.mesh.triangles.len());
        let bounds = piece.mesh.positions.iter().fold(None, |bounds: Option<[DVec3; 2]>, at| {
            let [min, max] = bounds.unwrap_or([*at; 2]);
            Some([min.min(*at), max.max(*at)])
        });
        Self { vertices, triangles, open_vertices: piece.open_vertices.len(), bounds }
    }
}

/// Pieces that were read once.
pub(crate) struct Pieces<'a> {
    source: &'a dyn MeshPieces,
    known: Vec<Known>,
    joined: Joined,
}

impl<'a> Pieces<'a> {
    fn survey(source: &'a dyn MeshPieces) -> Result<Self, ExportError> {
        let (mut known, mut seams) = (Vec::new(), Seams::default());
        for number in 0..source.count() {
            let piece = read(source, number)?;
            known.push(Known::of(&piece));
            seams.add(&piece)?;
        }
        Ok(Self { source, known, joined: seams.join() })
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.known.len()
    }

    /// Reads one of them again.
    pub(crate) fn read(&self, number: usize) -> Result<Piece, ExportError> {
        let piece = read(self.source, number)?;
        if Known::of(&piece) == self.known[number] {
            Ok(piece)
        } else {
            Err(ExportError::ChangedPiece { piece: number })
        }
    }

    /// The corners of the box around each; none where a piece is empty.
    pub(crate) fn bounds(&self) -> impl Iterator<Item = Option<[DVec3; 2]>> {
        self.known.iter().map(|known| known.bounds)
    }

    /// Vertices of all; those that are shared are counted once.
    pub(crate) fn vertices(&self) -> u64 {
        self.known.iter().map(|known| known.vertices as u64).sum::<u64>() - self.joined.repeated()
    }

    /// Triangles of all.
    pub(crate) fn triangles(&self) -> u64 {
        self.known.iter().map(|known| known.triangles as u64).sum()
    }

    /// Numbers vertices in the order of the pieces, from a first number on.
    pub(crate) fn numbering(&self, first: u64) -> Numbering<'_> {
        Numbering::new(&self.joined, first)
    }

    /// See [`MeshPieces::temporary_file`].
    pub(crate) fn temporary_file(&self) -> Result<std::fs::File, ExportError> {
        Ok(self.source.temporary_file()?)
    }
}

fn read(source: &dyn MeshPieces, number: usize) -> Result<Piece, ExportError> {
    let mesh = source.piece(number).map_err(|source| ExportError::ReadPiece { piece: number, source })?;
    check_mesh(&mesh).map_err(|error| match error {
        ExportError::InvalidMesh(what) => ExportError::InvalidMesh(format!("piece {number} (counted from 0): {what}")),
        other => other,
    })?;
    Ok(Piece::new(source.name(number), mesh))
}
