//! The triangles of all operands, with vertices that are joined where they are at the same place.

use std::sync::OnceLock;

use glam::DVec3;
use planecut_kernel::decompose;
use planecut_parallel::prelude::*;

use crate::ids::{Id, PointId, TriangleId};
use crate::model::MaterialId;

/// Coordinates, other than zero, of which products of five are computed without overflow and without loss of their last bits.
const SAFE: std::ops::RangeInclusive<f64> = 1e-40..=1e50;

/// Vertices that one thread looks at in a row.
const CHUNK: usize = 1 << 14;

/// The triangles of all operands. Vertices are joined: two of them are never at the same place where operands come near each other.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// The places of vertices.
    pub(super) positions: Vec<DVec3>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    pub(super) corners: Vec<[PointId; 3]>,
    /// For each half-edge, numbered as in [`crate::closed_mesh::connectivity`], the one that runs back along the same edge; none where
    /// there is not exactly one of both.
    pub(super) twins: Vec<u32>,
    /// The operand of each triangle.
    pub(super) operands: Vec<u32>,
    /// The material of each triangle.
    pub(super) materials: Vec<MaterialId>,
    /// Whether floating-point filters and expansions hold for all coordinates.
    pub(super) is_safe: bool,
    /// The exponent of the smallest unit of any coordinate.
    pub(super) lowest: OnceLock<i32>,
}

/// Whether floating-point filters and expansions hold for these coordinates.
pub(super) fn are_safe(positions: &[DVec3]) -> bool {
    let is_safe = |v: f64| v == 0.0 || SAFE.contains(&v.abs());
    positions.par_iter().with_min_len(CHUNK).all(|p| is_safe(p.x) && is_safe(p.y) && is_safe(p.z))
}

impl Surface {
    /// The number of triangles.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// The place of a vertex.
    #[inline]
    pub(super) fn at(&self, vertex: PointId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// The vertices of a triangle.
    #[inline]
    pub(super) fn corners(&self, triangle: TriangleId) -> [PointId; 3] {
        self.corners[triangle.index()]
    }

    /// The material of a triangle.
    pub(super) fn material(&self, triangle: TriangleId) -> MaterialId {
        self.materials[triangle.index()]
    }

    /// The places of a triangle's vertices.
    #[inline]
    pub(super) fn places(&self, triangle: TriangleId) -> [DVec3; 3] {
        self.corners(triangle).map(|vertex| self.at(vertex))
    }

    /// The ends of an edge of a triangle, the smaller one first.
    #[inline]
    pub(super) fn edge(&self, triangle: TriangleId, side: usize) -> [PointId; 2] {
        let corners = self.corners(triangle);
        sorted(corners[side], corners[(side + 1) % 3])
    }

    /// The exponent of the smallest unit of any coordinate: all are integers in it.
    pub(super) fn lowest(&self) -> i32 {
        *self.lowest.get_or_init(|| {
            let unit = |v: f64| if v == 0.0 { i32::MAX } else { decompose(v).1 };
            let of_place = |p: &DVec3| unit(p.x).min(unit(p.y)).min(unit(p.z));
            let of_chunk = |chunk: &[DVec3]| chunk.iter().map(of_place).min();
            let of_chunks: Vec<Option<i32>> = self.positions.par_chunks(CHUNK).map(of_chunk).collect();
            let lowest = of_chunks.into_iter().flatten().min().unwrap_or(i32::MAX);
            if lowest == i32::MAX { 0 } else { lowest }
        })
    }
}

/// Two points in ascending order.
#[inline]
pub(super) fn sorted(a: PointId, b: PointId) -> [PointId; 2] {
    if a < b { [a, b] } else { [b, a] }
}
