//! Closed meshes as leaves of a tree.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;

use super::{MaterialId, Transform, TransformError};
use crate::closed_mesh::{ClosedMesh, WindingRule};

/// A closed mesh as a leaf of a tree: where it lies, what of it is inside, and what its surfaces are made of. Copies share the mesh.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::saved::SavedMeshBody", into = "super::saved::SavedMeshBody"))]
pub struct MeshBody {
    mesh: Arc<ClosedMesh>,
    transform: Transform,
    rule: WindingRule,
    /// The material of each surface that triangles of the mesh name.
    materials: Vec<MaterialId>,
}

impl PartialEq for MeshBody {
    fn eq(&self, other: &Self) -> bool {
        let is_one = Arc::ptr_eq(&self.mesh, &other.mesh) || self.mesh == other.mesh;
        is_one && (self.transform, self.rule) == (other.transform, other.rule) && self.materials == other.materials
    }
}

impl MeshBody {
    /// A mesh where it is, and the material of each surface that its triangles name.
    ///
    /// # Panics
    /// Where a triangle names a surface that is not in the list.
    #[must_use]
    pub fn new(mesh: impl Into<Arc<ClosedMesh>>, materials: Vec<MaterialId>) -> Self {
        let mesh = mesh.into();
        let surfaces = mesh.surfaces().iter().max().map_or(0, |last| *last as usize + 1);
        assert!(surfaces <= materials.len(), "found {surfaces} surfaces, expected a material for each");
        Self { mesh, transform: Transform::identity(), rule: WindingRule::default(), materials }
    }

    /// The mesh as it was given, before it is moved.
    #[must_use]
    pub fn mesh(&self) -> &Arc<ClosedMesh> {
        &self.mesh
    }

    /// What of it is inside.
    #[must_use]
    pub fn rule(&self) -> WindingRule {
        self.rule
    }

    /// The same with another rule for what is inside.
    #[must_use]
    pub fn with_rule(mut self, rule: WindingRule) -> Self {
        self.rule = rule;
        self
    }

    /// Where the mesh goes: vertices are moved by all transforms at once, and rounded once.
    #[must_use]
    pub fn transform(&self) -> &Transform {
        &self.transform
    }

    /// The mesh moved by a further map.
    ///
    /// # Errors
    /// [`TransformError`] where products leave the range of numbers.
    pub fn transformed(mut self, transform: &Transform) -> Result<Self, TransformError> {
        self.transform = self.transform.then(transform)?;
        Ok(self)
    }

    /// The materials of surfaces.
    #[must_use]
    pub fn materials(&self) -> &[MaterialId] {
        &self.materials
    }

    /// The materials of surfaces, to be changed one by one.
    pub fn materials_mut(&mut self) -> &mut [MaterialId] {
        &mut self.materials
    }

    /// Whether the mesh is moved to where its mirror image is.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        self.transform.linear().determinant() < 0.0
    }

    /// The places of vertices, after the transform.
    #[must_use]
    pub fn positions(&self) -> Cow<'_, [DVec3]> {
        if self.transform == Transform::identity() {
            return Cow::Borrowed(self.mesh.positions());
        }
        Cow::Owned(self.mesh.positions().iter().map(|position| self.transform.point(*position) + 0.0).collect())
    }

    /// The vertices of each triangle, counter-clockwise seen from outside after the transform.
    #[must_use]
    pub fn triangles(&self) -> Cow<'_, [[u32; 3]]> {
        if self.is_mirrored() {
            return Cow::Owned(self.mesh.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect());
        }
        Cow::Borrowed(self.mesh.triangles())
    }

    /// The material of a triangle.
    #[must_use]
    pub fn material(&self, triangle: usize) -> MaterialId {
        self.materials[self.mesh.surfaces()[triangle] as usize]
    }
}
