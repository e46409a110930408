//! The frame in which the triangles of an operand are compared with one another: large flat faces and their edges are likely to be parallel
//! to its axes, so that boxes around slivers are thin.

use glam::{DMat3, DVec3};
use rustc_hash::FxHashMap;

use crate::arrangement::operand::Operand;

/// Triangles that are looked at to choose the frame.
const SAMPLES: usize = 4096;

/// Directions whose components differ by less than this share of their length are counted as one.
const STEP: f64 = 1.0 / 256.0;

/// Turns, and makes the largest extent 2, around the middle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    turn: DMat3,
    origin: DVec3,
    /// Whether the size of the operand is one that numbers can hold.
    pub(super) is_known: bool,
}

impl Frame {
    pub(super) fn new(operand: &Operand<'_>) -> Self {
        let order = operand.tree().order();
        let bounds = operand.tree().all_bounds();
        let origin = if order.is_empty() { DVec3::ZERO } else { 0.5 * bounds.min + 0.5 * bounds.max };
        // by its size, which single precision may not hold
        let scale = (0.5 * bounds.max - 0.5 * bounds.min).max_element().recip();
        let is_known = scale.is_finite();
        let turn = if is_known { turn(operand, order) * scale } else { DMat3::IDENTITY };
        Self { turn, origin, is_known }
    }

    /// Where a place is in the frame.
    #[inline]
    pub(super) fn place(&self, position: DVec3) -> DVec3 {
        self.turn * (position - self.origin)
    }
}

/// A turn after which the plane in which most of the surface lies is perpendicular to an axis, and most edges in it parallel to one.
fn turn(operand: &Operand<'_>, order: &[u32]) -> DMat3 {
    let places = |triangle: u32| operand.triangles()[triangle as usize].map(|v| operand.positions()[v as usize]);
    let step = order.len().div_ceil(SAMPLES).max(1);
    let sample = || order.iter().step_by(step).map(|triangle| places(*triangle));
    let normals = sample().map(|[a, b, c]| (b - a).cross(c - a));
    let Some(normal) = most_common(normals) else { return DMat3::IDENTITY };
    let is_across =
        |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).normalize_or_zero().dot(normal).abs() > 1.0 - STEP * STEP;
    let edges = sample().filter(is_across).flat_map(|[a, b, c]| [b - a, c - b, a - c]);
    let Some(along) = most_common(edges) else { return DMat3::IDENTITY };
    let along = (along - normal * along.dot(normal)).normalize_or_zero();
    let turn = DMat3::from_cols(along, normal.cross(along), normal).transpose();
    if turn.is_finite() && (turn.determinant().abs() - 1.0).abs() < 1e-6 { turn } else { DMat3::IDENTITY }
}

/// The direction, whichever way, in which the most length lies.
fn most_common(vectors: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let mut sums: FxHashMap<[i32; 3], (f64, DVec3)> = FxHashMap::default();
    for vector in vectors {
        let Some(unit) = vector.try_normalize() else { continue };
        // of opposite directions the one whose largest component is positive
        let unit = unit * unit[unit.abs().max_position()].signum();
        let entry = sums.entry((unit / STEP).round().as_ivec3().to_array()).or_insert((0.0, DVec3::ZERO));
        entry.0 += vector.length();
        entry.1 += unit * vector.length();
    }
    let largest = sums.into_iter().max_by(|(p, a), (q, b)| a.0.total_cmp(&b.0).then(p.cmp(q)))?;
    largest.1.1.try_normalize()
}
