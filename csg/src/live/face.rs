//! The faces of a live model, however its boundary is worked out.

use planecut_kernel::DVec3;

use crate::mesh::Mesh;
use crate::model::MaterialId;
use crate::weld::WeldedFace;

/// A planar, connected region of the boundary of a live model, with its triangles.
#[derive(Clone, Copy)]
pub struct LiveFace<'a>(Kind<'a>);

#[derive(Clone, Copy)]
enum Kind<'a> {
    Welded(WeldedFace<'a>),
    Evaluated { mesh: &'a Mesh, triangles: &'a [[u32; 3]], material: MaterialId },
}

impl<'a> LiveFace<'a> {
    pub(super) fn welded(face: WeldedFace<'a>) -> Self {
        Self(Kind::Welded(face))
    }

    pub(super) fn evaluated(mesh: &'a Mesh, triangles: &'a [[u32; 3]], material: MaterialId) -> Self {
        Self(Kind::Evaluated { mesh, triangles, material })
    }

    /// What it is made of.
    #[must_use]
    pub fn material(&self) -> MaterialId {
        match self.0 {
            Kind::Welded(face) => face.material(),
            Kind::Evaluated { material, .. } => material,
        }
    }

    /// The triangles, counter-clockwise seen from outside: for each corner the number of its vertex, equal for what is one
    /// corner of the solid as long as nothing changes there, and its position. While a brush of the model is a closed mesh,
    /// vertices are numbered again by each edit.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [(u32, DVec3); 3]> + use<'a> {
        let Self(kind) = *self;
        let count = match kind {
            Kind::Welded(face) => face.triangle_count(),
            Kind::Evaluated { triangles, .. } => triangles.len(),
        };
        (0..count).map(move |place| match kind {
            Kind::Welded(face) => face.triangle(place),
            Kind::Evaluated { mesh, triangles, .. } => {
                triangles[place].map(|vertex| (vertex, mesh.positions[vertex as usize]))
            }
        })
    }
}
