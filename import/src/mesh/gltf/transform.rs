//! The node tree of a glTF document, flattened to placed meshes.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use super::super::error::{Fault, Place};
use super::document::{Document, Node};

/// Entries of a rotation this close to 0 or ±1 are taken as that: quarter turns, which swap axes, then change no coordinate.
const QUARTER_TURN: f64 = 8.0 * f64::EPSILON;

/// A node with a mesh.
pub(super) struct PlacedMesh {
    pub(super) node: usize,
    pub(super) mesh: usize,
    /// The node's name, or else the mesh's.
    pub(super) name: Option<String>,
    /// From the mesh's coordinates to the scene's.
    pub(super) transform: DAffine3,
}

/// All nodes with meshes that scenes reach, in the order of a walk through them; without scenes, all that no other node holds.
pub(super) fn placed_meshes(document: &Document) -> Result<Vec<PlacedMesh>, Fault> {
    let mut is_reached = vec![false; document.nodes.len()];
    let mut placed = Vec::new();
    for root in roots(document) {
        // A root that several scenes share counts once.
        if is_reached.get(root).copied().unwrap_or(false) {
            continue;
        }
        let mut open = vec![(root, DAffine3::IDENTITY)];
        while let Some((number, outer)) = open.pop() {
            let place = || Place::Json(format!("nodes/{number}"));
            let Some(node) = document.nodes.get(number) else {
                return Err(Fault::new(place(), "no such node", format!("one of {}", document.nodes.len())));
            };
            if std::mem::replace(&mut is_reached[number], true) {
                return Err(Fault::new(place(), "a node with two parents", "a tree"));
            }
            let transform = outer * local_transform(node);
            open.extend(node.children.iter().rev().map(|&child| (child, transform)));
            let Some(mesh) = node.mesh else { continue };
            let Some(source) = document.meshes.get(mesh) else {
                return Err(Fault::new(place(), format!("mesh {mesh}"), format!("one of {}", document.meshes.len())));
            };
            let name = node.name.clone().or_else(|| source.name.clone());
            placed.push(PlacedMesh { node: number, mesh, name, transform });
        }
    }
    Ok(placed)
}

fn roots(document: &Document) -> Vec<usize> {
    if !document.scenes.is_empty() {
        return document.scenes.iter().flat_map(|scene| scene.nodes.iter().copied()).collect();
    }
    let mut has_parent = vec![false; document.nodes.len()];
    for &child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(flag) = has_parent.get_mut(child) {
            *flag = true;
        }
    }
    (0..document.nodes.len()).filter(|&n| !has_parent[n]).collect()
}

fn local_transform(node: &Node) -> DAffine3 {
    if let Some(matrix) = &node.matrix {
        return DAffine3::from_mat4(DMat4::from_cols_array(matrix));
    }
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = node.rotation.map_or(DMat3::IDENTITY, |q| rotation_matrix(DQuat::from_array(q)));
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from_array);
    DAffine3 { matrix3: rotation * DMat3::from_diagonal(scale), translation }
}

/// The rotation of a quaternion, which files round to `f32` and which so has not quite unit length.
fn rotation_matrix(q: DQuat) -> DMat3 {
    if !(q.length_squared() > 0.0 && q.is_finite()) {
        return DMat3::IDENTITY;
    }
    let exact = |entry: f64| {
        let whole = entry.round();
        if (entry - whole).abs() <= QUARTER_TURN { whole } else { entry }
    };
    DMat3::from_cols_array(&DMat3::from_quat(q.normalize()).to_cols_array().map(exact))
}
