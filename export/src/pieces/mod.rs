//! One file of many meshes that together are one surface, of which one at a time is in memory.
//!
//! Way of a file through this folder: a survey reads each piece once, counts what is in it and collects the edges at which it is open
//! ([`seams`]); the two sides of each seam are put together there. Then the writer of the format reads the pieces again, as often as it
//! needs them ([`piece`] brings each into the same form), and [`numbers`] says which number a vertex has in the file.

mod numbers;
mod piece;
mod seams;

use std::io;

use glam::DVec3;
use planecut_csg::Mesh;

pub(crate) use numbers::{Numbering, Numbers};
pub(crate) use piece::Piece;

use self::seams::{Joined, Seams};
use crate::ExportError;
use crate::part::check_mesh;

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
    /// Reads each once and finds which open edges belong together.
    pub(crate) fn survey(source: &'a dyn MeshPieces) -> Result<Self, ExportError> {
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

    /// Edges at which a piece is open and no other goes on.
    pub(crate) fn open_edges(&self) -> u64 {
        self.joined.open_edges
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
