//! Leaves of a tree: convex bodies with a material on each face, and closed meshes.

use glam::DVec3;
use planecut_kernel::HalfSpace;

use super::{MaterialId, MeshBody, Transform, TransformError};

/// One bounding plane of a [`Brush`] and what its face is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BrushFace {
    /// The body lies inside this half-space.
    pub half_space: HalfSpace,
    /// The material of the face.
    pub material: MaterialId,
}

/// A leaf of a tree: a convex body, which is the intersection of the half-spaces of its faces; or a closed mesh, which has no such faces.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Brush {
    /// The bounding planes, in the input's order.
    pub faces: Vec<BrushFace>,
    /// A name, where the input gives one.
    pub name: Option<String>,
    /// The closed mesh that it is, where it is no convex body; then `faces` is empty and says nothing.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub mesh: Option<MeshBody>,
}

impl Brush {
    /// The body of all points within every half-space; may be unbounded or empty.
    #[must_use]
    pub fn from_half_spaces(half_spaces: impl IntoIterator<Item = HalfSpace>, material: MaterialId) -> Self {
        let faces = half_spaces.into_iter().map(|half_space| BrushFace { half_space, material }).collect();
        Self { faces, ..Self::default() }
    }

    /// A closed mesh as a leaf.
    #[must_use]
    pub fn of_mesh(mesh: MeshBody) -> Self {
        Self { mesh: Some(mesh), ..Self::default() }
    }

    /// Whether it is a closed mesh, no convex body.
    #[must_use]
    pub fn is_mesh(&self) -> bool {
        self.mesh.is_some()
    }

    /// The materials of its faces, or of the surfaces of its mesh.
    pub fn materials(&self) -> impl Iterator<Item = MaterialId> {
        let of_mesh = self.mesh.iter().flat_map(MeshBody::materials).copied();
        self.faces.iter().map(|face| face.material).chain(of_mesh)
    }

    /// The same, to be changed one by one.
    pub fn materials_mut(&mut self) -> impl Iterator<Item = &mut MaterialId> {
        let of_mesh = self.mesh.iter_mut().flat_map(MeshBody::materials_mut);
        self.faces.iter_mut().map(|face| &mut face.material).chain(of_mesh)
    }

    /// It moved by an affine map.
    ///
    /// # Errors
    /// [`TransformError`] where a plane, or the map of a mesh, leaves the accepted range.
    pub fn transformed(mut self, transform: &Transform) -> Result<Self, TransformError> {
        for face in &mut self.faces {
            face.half_space = transform.half_space(&face.half_space)?;
        }
        self.mesh = self.mesh.map(|mesh| mesh.transformed(transform)).transpose()?;
        Ok(self)
    }

    /// The half-spaces whose intersection the brush is, in the order of its faces; none for a mesh.
    pub fn half_spaces(&self) -> impl Iterator<Item = &HalfSpace> + Clone {
        self.faces.iter().map(|face| &face.half_space)
    }

    /// The box between two corners; empty where a minimum is not below its maximum, as any brush is empty whose half-spaces have no
    /// common volume. The primitive `planecut_shapes::primitives::cuboid` is for sizes that a user gives: it refuses such corners.
    ///
    /// # Panics
    /// Where a coordinate is not finite or beyond `±2^200`.
    #[must_use]
    pub fn cuboid(min: impl Into<DVec3>, max: impl Into<DVec3>, material: MaterialId) -> Self {
        let (min, max) = (min.into(), max.into());
        let sides = DVec3::AXES.into_iter().flat_map(|axis| [(axis, axis.dot(max)), (-axis, -axis.dot(min))]);
        let half_spaces =
            sides.map(|(normal, offset)| HalfSpace::new(normal, offset).expect("finite corners, not too far away"));
        Self::from_half_spaces(half_spaces, material)
    }
}
