//! What a file holds: meshes in the precision of its format.

use glam::DVec3;
use planecut_csg::Mesh;

use super::Part;
use crate::ExportError;

/// The triangles of some parts as a file holds them, in the units of the parts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Written {
    /// Corners at the places that the file gives them.
    pub positions: Vec<DVec3>,
    /// The triangles, each by its corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// How many planar faces they belong to.
    pub faces: usize,
    /// Whether triangles are missing that the parts have: those at edges that are too short for the format's precision.
    pub is_reduced: bool,
}

impl Written {
    /// Adds a mesh that was made from a part, its corners at their places in the file.
    pub(crate) fn push(
        &mut self,
        part: &Part<'_>,
        mesh: &Mesh,
        is_kept: impl Fn(&[u32; 3]) -> bool,
        place: impl Fn(DVec3) -> DVec3,
    ) -> Result<(), ExportError> {
        let first = u32::try_from(self.positions.len());
        let (Ok(first), Ok(_)) = (first, u32::try_from(self.positions.len() + mesh.positions.len())) else {
            return Err(ExportError::TooLarge { what: format!("{} and more vertices", self.positions.len()) });
        };
        let before = self.triangles.len();
        self.positions.extend(mesh.positions.iter().map(|position| place(*position)));
        let kept = mesh.triangles.iter().filter(|triangle| is_kept(triangle));
        self.triangles.extend(kept.map(|triangle| triangle.map(|corner| corner + first)));
        self.faces += mesh.faces.len();
        self.is_reduced |= self.triangles.len() - before < part.mesh.triangles.len();
        Ok(())
    }
}
