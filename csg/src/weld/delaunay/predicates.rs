//! The two signs that decide a Delaunay triangulation, both exact for the coordinates as they are.

use std::cmp::Ordering;

use planecut_kernel::{DVec2, DoubleDouble};

use super::{Conflict, Delaunay};
use crate::ids::SiteId;

/// Coordinates that are not zero lie between these sizes, or a product of four of them, and what it takes to make such products exact, may leave the range of numbers.
const RANGE: [f64; 2] = [1e-60, 1e60];

/// Checks the size of coordinates.
pub(super) fn check_range(at: DVec2) -> Result<(), Conflict> {
    let is_fit = |value: f64| value == 0.0 || (RANGE[0]..RANGE[1]).contains(&value.abs());
    if is_fit(at.x) && is_fit(at.y) { Ok(()) } else { Err(Conflict) }
}

/// Positive where three points turn left, zero where they are collinear.
pub(super) fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    super::super::triangulate::orient(a, b, c)
}

/// Whether a fourth point lies within the circle through three that turn left.
///
/// Of four points on one circle the one that is last from left to right, then upwards, is taken as raised a little from the paraboloid on which
/// the Delaunay triangulation is the lower hull of the points, so as to break the tie the same way whichever circle is asked for (Devillers and Teillaud, "Perturbations for
/// Delaunay and weighted Delaunay 3D triangulations", 2011).
pub(super) fn is_in_circle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let sign = in_circle(a, b, c, d);
    if sign != 0.0 {
        return sign > 0.0;
    }
    let order = |p: &DVec2, q: &DVec2| {
        let by = |p: f64, q: f64| p.partial_cmp(&q).unwrap_or(Ordering::Equal);
        by(p.x, q.x).then(by(p.y, q.y))
    };
    let last = [a, b, c, d].into_iter().max_by(order).unwrap_or(d);
    // raising a corner raises the plane above d by the weight that the corner has there
    if last == d {
        false
    } else if last == a {
        orient(d, b, c) > 0.0
    } else if last == b {
        orient(a, d, c) > 0.0
    } else {
        orient(a, b, d) > 0.0
    }
}

/// A number with the sign of the determinant of four points lifted to the paraboloid: positive where `d` lies within the circle
/// of the others, which turn left.
fn in_circle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> f64 {
    let [p, q, r] = [a - d, b - d, c - d];
    let (lift_p, lift_q, lift_r) = (p.length_squared(), q.length_squared(), r.length_squared());
    let value = lift_p * q.perp_dot(r) + lift_q * r.perp_dot(p) + lift_r * p.perp_dot(q);
    let size = |q: DVec2, r: DVec2| (q.x * r.y).abs() + (q.y * r.x).abs();
    let permanent = lift_p * size(q, r) + lift_q * size(r, p) + lift_r * size(p, q);
    if value.abs() > ROUNDED_ERROR * permanent {
        return value;
    }
    if is_rectangle(a, b, c, d) {
        return 0.0;
    }
    // points of a polygon around a circle, as nearly as they can be: common, and too close for the above
    let value = in_circle_doubled(a, b, c, d);
    if value.abs() > DOUBLED_ERROR * permanent {
        return value;
    }
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::incircle(coord(a), coord(b), coord(c), coord(d))
}

/// Whether four points are the corners of a rectangle along the axes, in any order: those lie on one circle. They are common, and that
/// their determinant is zero takes long to find out.
fn is_rectangle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    // each has one other on its vertical line and one on its horizontal line
    let opposite = |p: DVec2, q: DVec2, r: DVec2, s: DVec2| p.x == q.x && r.x == s.x && p.y == s.y && q.y == r.y;
    let is_around = |p, q, r, s| opposite(p, q, r, s) || opposite(q, r, s, p);
    is_around(a, b, c, d) || is_around(a, c, b, d) || is_around(a, b, d, c)
}

/// The error of the determinant in rounded arithmetic, as a share of the sum of the sizes of its terms (Shewchuk, "Adaptive precision
/// floating-point arithmetic", 1997, section 4.4: `(10 + 96ε)ε`, and `ε` is half of this one).
const ROUNDED_ERROR: f64 = 5.1 * f64::EPSILON;

/// The error of the determinant in arithmetic of twice the precision. Differences of coordinates are exact there; each of the seven operations on the way of a term to the sum
/// errs by less than `2⁻¹⁰⁰` of the sizes of its terms.
const DOUBLED_ERROR: f64 = 8.0 / (1_u128 << 100) as f64;

fn in_circle_doubled(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> f64 {
    let [p, q, r] = [a, b, c].map(|at| [DoubleDouble::sum(at.x, -d.x), DoubleDouble::sum(at.y, -d.y)]);
    let minor =
        |[px, py]: [DoubleDouble; 2], [qx, qy]: [DoubleDouble; 2]| px.times_sum(qy).plus(py.times_sum(qx).negated());
    let lift = |[x, y]: [DoubleDouble; 2]| x.times_sum(x).plus(y.times_sum(y));
    let term = |p, q, r| lift(p).times_sum(minor(q, r));
    term(p, q, r).plus(term(q, r, p)).plus(term(r, p, q)).high
}

impl Delaunay {
    /// Positive where three sites turn left.
    pub(super) fn turn(&self, a: SiteId, b: SiteId, c: SiteId) -> f64 {
        orient(self.at(a), self.at(b), self.at(c))
    }
}
