//! Which way three exact points turn.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, planar_turn};

use super::{Corner, orient};
use crate::ids::Id;
use crate::plane_table::PlaneTable;
use crate::weld::nest::Projection;
use crate::weld::points::Points;

const U: f64 = f64::EPSILON / 2.0;

/// The turns of corners on one plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turns<'a> {
    pub(super) table: &'a PlaneTable,
    pub(super) points: &'a Points,
    pub(super) projection: Projection,
}

impl Turns<'_> {
    /// Positive where the exact points turn left: from the rounded coordinates where their error cannot matter or there is
    /// none, else by big integers.
    pub(super) fn of(&self, a: &Corner, b: &Corner, c: &Corner) -> Sign {
        if a.point == b.point || b.point == c.point || c.point == a.point {
            return Sign::Zero;
        }
        let (value, bound) = rounded_turn(a.at, b.at, c.at);
        if value.abs() > bound {
            return sign(value);
        }
        let Projection { u, v } = self.projection;
        if [a, b, c].iter().all(|corner| self.points.are_exact(corner.point, u, v)) {
            return sign(orient(a.at, b.at, c.at));
        }
        let rows = [a, b, c].map(|corner| self.points.planes[corner.point.index()].map(|plane| self.table.row(plane)));
        planar_turn(rows, u, v)
    }

    /// Whether the exact points certainly turn right, from the rounded coordinates.
    pub(super) fn is_surely_right(a: &Corner, b: &Corner, c: &Corner) -> bool {
        let (value, bound) = rounded_turn(a.at, b.at, c.at);
        value < -bound
    }

    /// The exact order of two corners from left to right, then upwards.
    pub(super) fn order(&self, a: &Corner, b: &Corner) -> Ordering {
        self.points.compare(self.table, a.point, b.point, &[self.projection.u, self.projection.v])
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
fn rounded_turn(a: DVec2, b: DVec2, c: DVec2) -> (f64, f64) {
    let (p, q) = (b - a, c - a);
    let (left, right) = (p.x * q.y, p.y * q.x);
    let m = a.abs().max(b.abs()).max(c.abs()).max_element();
    let sum = p.x.abs() + p.y.abs() + q.x.abs() + q.y.abs();
    (left - right, 4.0 * U * (m * sum + left.abs() + right.abs()) + 32.0 * (U * m) * (U * m))
}
