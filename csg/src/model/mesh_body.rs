//! Closed meshes as leaves of a tree.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;

use super::{MaterialId, TextureAxes, Transform, TransformError};
use crate::closed_mesh::{ClosedMesh, WindingRule};

/// A closed mesh as a leaf of a tree: where it lies, what of it is inside, and what its surfaces are made of. Copies share the mesh.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::saved::SavedMeshBody", into = "super::saved::SavedMeshBody"))]
pub struct MeshBody {
    // boxed, so that convex bodies, of which there may be a million, do not pay for it
    parts: Box<Parts>,
}

/// What a mesh body is.
#[derive(Debug, Clone)]
struct Parts {
    mesh: Arc<ClosedMesh>,
    transform: Transform,
    rule: WindingRule,
    /// The material of each surface that triangles of the mesh name.
    materials: Vec<MaterialId>,
    /// How the texture of each surface lies on the mesh before it is moved; empty where nothing is known of any.
    textures: Arc<[Option<TextureAxes>]>,
}

impl PartialEq for MeshBody {
    fn eq(&self, other: &Self) -> bool {
        let is_one = Arc::ptr_eq(&self.parts.mesh, &other.parts.mesh) || self.parts.mesh == other.parts.mesh;
        is_one
            && (self.parts.transform, self.parts.rule) == (other.parts.transform, other.parts.rule)
            && self.parts.materials == other.parts.materials
            && self.parts.textures == other.parts.textures
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
        let transform = Transform::identity();
        let textures = Arc::default();
        Self { parts: Box::new(Parts { mesh, transform, rule: WindingRule::default(), materials, textures }) }
    }

    /// The mesh as it was given, before it is moved.
    #[must_use]
    pub fn mesh(&self) -> &Arc<ClosedMesh> {
        &self.parts.mesh
    }

    /// What of it is inside.
    #[must_use]
    pub fn rule(&self) -> WindingRule {
        self.parts.rule
    }

    /// The same with another rule for what is inside.
    #[must_use]
    pub fn with_rule(mut self, rule: WindingRule) -> Self {
        self.parts.rule = rule;
        self
    }

    /// The same with how the texture of each surface lies on the mesh before it is moved, as far as that is known.
    ///
    /// # Panics
    /// Where there are some, but not as many as materials.
    #[must_use]
    pub fn with_textures(mut self, textures: impl Into<Arc<[Option<TextureAxes>]>>) -> Self {
        let textures = textures.into();
        let surfaces = self.parts.materials.len();
        assert!(
            textures.is_empty() || textures.len() == surfaces,
            "found {} textures for {surfaces} surfaces",
            textures.len()
        );
        self.parts.textures = textures;
        self
    }

    /// How the texture of each surface lies on the mesh before it is moved; empty where nothing is known of any.
    #[must_use]
    pub fn textures(&self) -> &[Option<TextureAxes>] {
        &self.parts.textures
    }

    /// The same where the mesh ends up: textures go with it.
    #[must_use]
    pub fn moved_textures(&self) -> Vec<Option<TextureAxes>> {
        if self.parts.transform == Transform::identity() {
            return self.parts.textures.to_vec();
        }
        let moved = |axes: &TextureAxes| Some(axes.transformed(&self.parts.transform)).filter(TextureAxes::is_finite);
        self.parts.textures.iter().map(|axes| axes.as_ref().and_then(moved)).collect()
    }

    /// Where the mesh goes: vertices are moved by all transforms at once, and rounded once.
    #[must_use]
    pub fn transform(&self) -> &Transform {
        &self.parts.transform
    }

    /// The mesh moved by a further map.
    ///
    /// # Errors
    /// [`TransformError`] where products leave the range of numbers.
    pub fn transformed(mut self, transform: &Transform) -> Result<Self, TransformError> {
        self.parts.transform = self.parts.transform.then(transform)?;
        Ok(self)
    }

    /// The materials of surfaces.
    #[must_use]
    pub fn materials(&self) -> &[MaterialId] {
        &self.parts.materials
    }

    /// The materials of surfaces, to be changed one by one.
    pub fn materials_mut(&mut self) -> &mut [MaterialId] {
        &mut self.parts.materials
    }

    /// Whether the mesh is moved to where its mirror image is.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        self.parts.transform.linear().determinant() < 0.0
    }

    /// The places of vertices, after the transform.
    #[must_use]
    pub fn positions(&self) -> Cow<'_, [DVec3]> {
        if self.parts.transform == Transform::identity() {
            return Cow::Borrowed(self.parts.mesh.positions());
        }
        Cow::Owned(
            self.parts.mesh.positions().iter().map(|position| self.parts.transform.point(*position) + 0.0).collect(),
        )
    }

    /// The vertices of each triangle, counter-clockwise seen from outside after the transform.
    #[must_use]
    pub fn triangles(&self) -> Cow<'_, [[u32; 3]]> {
        if self.is_mirrored() {
            return Cow::Owned(self.parts.mesh.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect());
        }
        Cow::Borrowed(self.parts.mesh.triangles())
    }

    /// The material of a triangle.
    #[must_use]
    pub fn material(&self, triangle: usize) -> MaterialId {
        self.parts.materials[self.parts.mesh.surfaces()[triangle] as usize]
    }
}
