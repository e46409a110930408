//! The welded, triangulated boundary of a solid.

mod collapse;
mod contract;
mod flip_caps;
mod measures;
mod noise;
mod proof;

use crate::ids::number32;
use glam::DVec3;
use planecut_parallel::prelude::*;

use crate::model::{Material, MaterialId};
pub use contract::{contract_edges, contract_short_edges};
pub use measures::SolidMeasures;
pub use noise::Noise;
pub(crate) use noise::may_be_noise;
use noise::without_noise;
pub(crate) use proof::{Flaw, prove_part, proven};

/// Triangles that a thread works on in a row, at least.
const CHUNK: usize = 4096;

/// One planar, connected region of a [`Mesh`] with one material.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct MeshFace {
    /// Unit outward normal.
    pub normal: DVec3,
    /// What the face is made of.
    pub material: MaterialId,
}

/// An indexed triangle mesh, counter-clockwise seen from outside.
///
/// # Guarantees
/// When made by the weld: every directed index edge occurs once and has its opposite (an oriented 2-manifold).
/// Positions may repeat: where the solid touches itself, vertices are split and must not be merged by coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Mesh {
    /// Vertex positions in the input's units.
    pub positions: Vec<DVec3>,
    /// Vertex indices of each triangle; triangles of one face follow one another.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the index of its face in [`Mesh::faces`]; as long as `triangles`.
    pub triangle_faces: Vec<u32>,
    /// The planar regions.
    pub faces: Vec<MeshFace>,
    /// The materials that faces refer to.
    pub materials: Vec<Material>,
}

impl Mesh {
    /// Drops the faces that have no triangle left.
    pub(crate) fn drop_empty_faces(&mut self) {
        let mut faces = Vec::with_capacity(self.faces.len());
        let mut last = None;
        for face in &mut self.triangle_faces {
            if last != Some(*face) {
                last = Some(*face);
                faces.push(self.faces[*face as usize]);
            }
            *face = number32(faces.len()) - 1;
        }
        self.faces = faces;
    }

    /// Drops the positions that no triangle has; the others keep their order.
    pub(crate) fn drop_unused_positions(&mut self) {
        let mut new = vec![u32::MAX; self.positions.len()];
        self.triangles.iter().flatten().for_each(|vertex| new[*vertex as usize] = 0);
        for (count, number) in new.iter_mut().filter(|number| **number == 0).enumerate() {
            *number = number32(count);
        }
        let mut old = 0;
        self.positions.retain(|_| {
            old += 1;
            new[old - 1] != u32::MAX
        });
        let renumbered = |triangle: &mut [u32; 3]| *triangle = triangle.map(|vertex| new[vertex as usize]);
        self.triangles.par_iter_mut().with_min_len(CHUNK).for_each(renumbered);
    }
}
