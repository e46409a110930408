//! Which way the projections of three meeting points turn.

use crate::sign::{
    DOUBLE_DOUBLE_BOUND, Homogeneous, OffsetColumn, Row, Sign, homogeneous_exactly, homogeneous_in_double_doubles,
};

/// The turn that the projections of three meeting points onto the coordinates `u`, `v` make: positive to the left, exactly.
///
/// Each point is given by three planes with right-handed normals. Not by plain numbers: for what a filter left open.
#[must_use]
pub fn planar_turn(points: [[&Row; 3]; 3], u: usize, v: usize) -> Sign {
    if let Some(sign) = certain_turn(points, u, v) {
        return sign;
    }
    let [p, q, r] = points.map(homogeneous_exactly);
    let minor = |i: usize, j: usize| &q[i] * &r[j] - &q[j] * &r[i];
    let determinant = &p[u] * minor(v, 3) + &p[v] * minor(3, u) + &p[3] * minor(u, v);
    Sign::of_big(&determinant)
}

/// The same, where double-doubles decide it.
///
/// Entries of the 3×3 determinant are off by [`DOUBLE_DOUBLE_BOUND`] of their permanents, so each term, a product of three, by
/// little more than three times that of its own, and the twelve operations on terms add less than another.
fn certain_turn(points: [[&Row; 3]; 3], u: usize, v: usize) -> Option<Sign> {
    const TURN_BOUND: f64 = 4.5 * DOUBLE_DOUBLE_BOUND;
    let permanents = points.map(|[a, b, c]| Homogeneous::of(a, b, c, OffsetColumn::Finite).permanent);
    // products of three stay within the range of numbers, and so do their low words
    if permanents.iter().flatten().any(|p| *p != 0.0 && !(1e-60..=1e60).contains(p)) {
        return None;
    }
    let [p, q, r] = points.map(homogeneous_in_double_doubles);
    let minor = |i: usize, j: usize| q[i].times_sum(r[j]).plus(q[j].times_sum(r[i]).negated());
    let value = p[u].times_sum(minor(v, 3)).plus(p[v].times_sum(minor(3, u))).plus(p[3].times_sum(minor(u, v)));
    let [p, q, r] = permanents;
    let minor = |i: usize, j: usize| q[i] * r[j] + q[j] * r[i];
    let permanent = p[u] * minor(v, 3) + p[v] * minor(3, u) + p[3] * minor(u, v);
    // the permanents are rounded themselves
    (value.high.abs() > 1.001 * TURN_BOUND * permanent).then(|| Sign::of(value.high))
}
