//! What every writer is given, a list of named meshes and options, and what it tells of a file.

mod check;
mod options;
mod written;

use planecut_csg::{FaceSource, Mesh};

pub(crate) use check::{check_mesh, check_parts};
pub use options::{ExportOptions, Projection, Shading, TextureMapping, Unit};
pub use written::Written;

/// One named mesh of a file that holds several, such as a convex cell of a decomposition.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// The name of the mesh node (glTF) or object (OBJ); may be empty.
    pub name: &'a str,
    /// The mesh, in the same coordinates as all others.
    pub mesh: &'a Mesh,
    /// Where the faces of each material come from, where that is known: as long as the mesh's materials, or empty.
    pub sources: &'a [FaceSource],
}

impl<'a> Part<'a> {
    /// A mesh of which no sources are known.
    #[must_use]
    pub fn new(name: &'a str, mesh: &'a Mesh) -> Self {
        Self { name, mesh, sources: &[] }
    }
}
