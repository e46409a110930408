//! Convex cells.

use planecut::csg::{ConvexPiece, MaterialId};
use planecut::expression::{self, DEFAULT_MATERIAL, Node};
use planecut::kernel::{DVec3, HalfSpace};
use wasm_bindgen::prelude::*;

use crate::failure::Outcome;

/// A bounded convex body.
#[wasm_bindgen(getter_with_clone)]
pub struct Cell {
    /// The planes that carry a face: outward normals, which need not have unit length, and offsets `d` of `n · x <= d`.
    pub planes: Vec<f64>,
    /// x, y and z of each corner.
    pub positions: Vec<f64>,
    /// Three numbers of corners of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<u32>,
    /// The volume.
    pub volume: f64,
    /// The name of what it is made of.
    pub material: String,
}

impl Cell {
    pub(crate) fn of_piece(piece: &ConvexPiece, material: String) -> Self {
        let ConvexPiece { half_spaces, positions, triangles, volume } = piece;
        Self {
            planes: half_spaces.iter().flat_map(HalfSpace::to_array).collect(),
            positions: positions.iter().flat_map(DVec3::to_array).collect(),
            triangles: triangles.as_flattened().to_vec(),
            volume: *volume,
            material,
        }
    }
}

/// The disjoint convex cells of a solid.
pub(crate) fn cells_of(node: &Node) -> Outcome<Vec<Cell>> {
    let model = node.model()?;
    let name = |material: MaterialId| {
        model.materials.get(material.0 as usize).map_or(DEFAULT_MATERIAL, |material| material.name.as_str()).to_owned()
    };
    let cells = expression::cells_of(&model)?;
    Ok(cells.iter().map(|(piece, material)| Cell::of_piece(piece, name(*material))).collect())
}
