//! Trees and transforms as data: what is read is checked, so that their guarantees hold.

use std::num::NonZeroU32;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::tree::known_lines;
use super::{Brush, MaterialId, MeshBody, TextureAxes, Transform, TransformError, Tree, TreeNode};
use crate::closed_mesh::{ClosedMesh, ClosedMeshError, WindingRule};

/// What is read of a [`Tree`], which is written as it is.
#[derive(Deserialize)]
#[serde(rename = "Tree", deny_unknown_fields)]
pub(super) struct SavedTree {
    brushes: Vec<Brush>,
    nodes: Vec<TreeNode>,
    /// The source line of each brush; left out where no brush has one.
    #[serde(default)]
    lines: Vec<Option<NonZeroU32>>,
}

/// Why data is no tree.
#[derive(Debug, Error)]
pub(super) enum TreeDataError {
    #[error("node {node} of the tree takes {operands} operands, found {found} before it")]
    MissingOperands { node: usize, operands: u32, found: usize },
    #[error("the nodes of the tree leave {0} results, expected one")]
    Results(usize),
    #[error("the tree has {leaves} leaves, but {brushes} brushes")]
    Leaves { leaves: usize, brushes: usize },
    #[error("the tree has {lines} source lines, but {brushes} brushes")]
    Lines { lines: usize, brushes: usize },
}

impl TryFrom<SavedTree> for Tree {
    type Error = TreeDataError;

    fn try_from(saved: SavedTree) -> Result<Self, TreeDataError> {
        let SavedTree { brushes, nodes, lines } = saved;
        let (mut results, mut leaves) = (0_usize, 0);
        for (place, node) in nodes.iter().enumerate() {
            match *node {
                TreeNode::Leaf => leaves += 1,
                TreeNode::Operation { operands, .. } => {
                    let missing = TreeDataError::MissingOperands { node: place, operands, found: results };
                    results = results.checked_sub(operands as usize).ok_or(missing)?;
                }
            }
            results += 1;
        }
        if results != 1 {
            return Err(TreeDataError::Results(results));
        }
        if leaves != brushes.len() {
            return Err(TreeDataError::Leaves { leaves, brushes: brushes.len() });
        }
        if !lines.is_empty() && lines.len() != brushes.len() {
            return Err(TreeDataError::Lines { lines: lines.len(), brushes: brushes.len() });
        }
        Ok(Self { brushes, nodes, lines: known_lines(lines) })
    }
}

/// What is written of a [`Transform`]: the rest follows from it.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Transform", deny_unknown_fields)]
pub(super) struct SavedTransform {
    /// By columns.
    linear: [[f64; 3]; 3],
    translation: [f64; 3],
}

impl From<Transform> for SavedTransform {
    fn from(transform: Transform) -> Self {
        Self { linear: transform.linear().to_cols_array_2d(), translation: transform.offset().to_array() }
    }
}

impl TryFrom<SavedTransform> for Transform {
    type Error = TransformError;

    fn try_from(saved: SavedTransform) -> Result<Self, TransformError> {
        let [x, y, z] = saved.linear;
        Self::from_columns([x, y, z, saved.translation])
    }
}

/// What is written of a [`MeshBody`].
#[derive(Serialize, Deserialize)]
#[serde(rename = "MeshBody", deny_unknown_fields)]
pub(super) struct SavedMeshBody {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The surface of each triangle.
    surfaces: Vec<u32>,
    /// The material of each surface.
    materials: Vec<MaterialId>,
    /// How the texture of each surface lies; left out where nothing is known of any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    textures: Vec<Option<TextureAxes>>,
    transform: Transform,
    rule: WindingRule,
}

/// Why data is no mesh.
#[derive(Debug, Error)]
pub(super) enum MeshDataError {
    #[error(transparent)]
    Mesh(#[from] ClosedMeshError),
    #[error("the mesh has {surfaces} surfaces, but {triangles} triangles")]
    Surfaces { surfaces: usize, triangles: usize },
    #[error("a triangle has surface {surface}, expected a number below {materials}, as many as there are materials")]
    NoMaterial { surface: u32, materials: usize },
    #[error("the mesh has {textures} textures, but {materials} materials")]
    Textures { textures: usize, materials: usize },
    #[error(transparent)]
    Transform(#[from] TransformError),
}

impl From<MeshBody> for SavedMeshBody {
    fn from(body: MeshBody) -> Self {
        Self {
            positions: body.mesh().positions().to_vec(),
            triangles: body.mesh().triangles().to_vec(),
            surfaces: body.mesh().surfaces().to_vec(),
            materials: body.materials().to_vec(),
            textures: body.textures().to_vec(),
            transform: *body.transform(),
            rule: body.rule(),
        }
    }
}

impl TryFrom<SavedMeshBody> for MeshBody {
    type Error = MeshDataError;

    fn try_from(saved: SavedMeshBody) -> Result<Self, MeshDataError> {
        let SavedMeshBody { positions, triangles, surfaces, materials, textures, transform, rule } = saved;
        if surfaces.len() != triangles.len() {
            return Err(MeshDataError::Surfaces { surfaces: surfaces.len(), triangles: triangles.len() });
        }
        if let Some(surface) = surfaces.iter().copied().find(|surface| *surface as usize >= materials.len()) {
            return Err(MeshDataError::NoMaterial { surface, materials: materials.len() });
        }
        if !textures.is_empty() && textures.len() != materials.len() {
            return Err(MeshDataError::Textures { textures: textures.len(), materials: materials.len() });
        }
        let mesh = ClosedMesh::new(&positions, &triangles, |triangle| surfaces[triangle])?;
        Ok(Self::new(mesh, materials).with_rule(rule).with_textures(textures).transformed(&transform)?)
    }
}
