//! Which way three exact points turn.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, planar_turn};

use super::{Corner, orient};
use crate::ids::{HalfEdgeId, Id, PointId};
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::cancel::HalfEdge;
use crate::weld::nest::Projection;
use crate::weld::points::Points;

const U: f64 = f64::EPSILON / 2.0;

/// Points that are known exactly, by their numbers.
pub(crate) trait ExactPoints: Sync {
    /// Which way three points of a plane turn as it is projected; positive is left. Asked for where rounded coordinates do not tell.
    fn turn(&self, points: [PointId; 3], projection: Projection) -> Sign;

    /// The order of two points from left to right, then upwards.
    fn order(&self, a: PointId, b: PointId, projection: Projection) -> Ordering;

    /// Which way a loop turns from a half-edge to the one that follows, where more is known of them than their points; positive is left. However
    /// short they are, their planes tell.
    fn corner(&self, _before: HalfEdgeId, _after: HalfEdgeId) -> Option<Sign> {
        None
    }
}

/// The points of a weld with the planes that meet there.
pub(in crate::weld) struct WeldPoints<'a> {
    pub(in crate::weld) table: &'a PlaneTable,
    pub(in crate::weld) points: &'a Points,
    pub(in crate::weld) half_edges: &'a [HalfEdge],
    /// The planes of the regions.
    pub(in crate::weld) planes: &'a [PlaneId],
}

impl ExactPoints for WeldPoints<'_> {
    fn turn(&self, points: [PointId; 3], projection: Projection) -> Sign {
        let Projection { u, v } = projection;
        if points.iter().all(|point| self.points.are_exact(*point, u, v)) {
            let [a, b, c] = points.map(|point| projection.of(self.points.positions[point.index()]));
            return sign(orient(a, b, c));
        }
        let rows = points.map(|point| self.points.planes[point.index()].map(|plane| self.table.row(plane)));
        planar_turn(rows, u, v)
    }

    fn order(&self, a: PointId, b: PointId, projection: Projection) -> Ordering {
        self.points.compare(self.table, a, b, &[projection.u, projection.v])
    }

    fn corner(&self, before: HalfEdgeId, after: HalfEdgeId) -> Option<Sign> {
        let [before, after] = [before, after].map(|piece| &self.half_edges[piece.index()]);
        // outward normals: where they are right-handed with that of the face, the loop turns left
        Some(self.table.orient3(self.planes[before.region.index()], before.edge, after.edge))
    }
}

/// The turns of corners on one plane.
#[derive(Clone, Copy)]
pub(super) struct Turns<'a> {
    pub(super) points: &'a dyn ExactPoints,
    pub(super) projection: Projection,
}

impl Turns<'_> {
    /// Positive where the exact points turn left: from the rounded coordinates where their error cannot matter, else exactly.
    pub(super) fn of(&self, a: &Corner, b: &Corner, c: &Corner) -> Sign {
        if a.point == b.point || b.point == c.point || c.point == a.point {
            return Sign::Zero;
        }
        let (value, bound) = rounded_turn(a.at, b.at, c.at);
        if value.abs() > bound {
            return sign(value);
        }
        self.points.turn([a.point, b.point, c.point], self.projection)
    }

    /// Whether a loop turns left for certain at the second of three corners that follow one another.
    pub(super) fn is_left_at([a, b, c]: [&Corner; 3], exact: impl FnOnce() -> Option<Sign>) -> bool {
        let (value, bound) = rounded_turn(a.at, b.at, c.at);
        value > bound || value >= -bound && exact() == Some(Sign::Positive)
    }

    /// Whether the exact points certainly turn right, from the rounded coordinates.
    pub(super) fn is_surely_right(a: &Corner, b: &Corner, c: &Corner) -> bool {
        let (value, bound) = rounded_turn(a.at, b.at, c.at);
        value < -bound
    }

    /// The exact order of two corners from left to right, then upwards.
    pub(super) fn order(&self, a: &Corner, b: &Corner) -> Ordering {
        self.points.order(a.point, b.point, self.projection)
    }
}

fn sign(value: f64) -> Sign {
    match value.partial_cmp(&0.0) {
        Some(Ordering::Greater) => Sign::Positive,
        Some(Ordering::Less) => Sign::Negative,
        _ => Sign::Zero,
    }
}

/// `(b − a) × (c − a)` from correctly rounded coordinates, and a bound on its error.
///
/// With all coordinates at most `m`, each is off by `u·m`, a difference by `3u·m`; the product of two differences by `3u·m` times
/// their sum, `9u²m²`, and its own rounding. Two products are subtracted.
pub(crate) fn rounded_turn(a: DVec2, b: DVec2, c: DVec2) -> (f64, f64) {
    let (p, q) = (b - a, c - a);
    let (left, right) = (p.x * q.y, p.y * q.x);
    let m = a.abs().max(b.abs()).max(c.abs()).max_element();
    let sum = p.x.abs() + p.y.abs() + q.x.abs() + q.y.abs();
    (left - right, 4.0 * U * (m * sum + left.abs() + right.abs()) + 32.0 * (U * m) * (U * m))
}
