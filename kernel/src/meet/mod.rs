//! The meeting point of three planes, each coordinate rounded correctly.
//!
//! Correct rounding makes the coordinates a function of the point alone, whichever three of the planes through it are
//! used: equal points get equal coordinates, and the order of coordinates never contradicts the exact order. So
//! coordinates can propose (hash, sort) while signs decide.

mod line;
mod refine;
mod turn;

use std::cmp::Ordering;

use glam::DVec3;

use crate::arithmetic::{DoubleDouble, round_quotient};
use crate::sign::{
    DOUBLE_DOUBLE_BOUND, Homogeneous, OffsetColumn, Row, homogeneous_exactly, homogeneous_in_double_doubles,
};

pub(crate) use line::direction;
pub use line::{direction_across, line_coordinates, line_direction};
pub use turn::planar_turn;

/// The point where three planes meet, each coordinate correctly rounded (to nearest, ties to even; zero is `+0`).
///
/// `None` where the normals are linearly dependent.
#[must_use]
pub fn meet(a: &Row, b: &Row, c: &Row) -> Option<DVec3> {
    let fast = Homogeneous::of(a, b, c, OffsetColumn::Finite);
    let integer = a.is_integer() && b.is_integer() && c.is_integer();
    if integer && fast.permanent.iter().all(|p| *p < (1u64 << 52) as f64) {
        // every intermediate is an exact integer, and one division rounds once
        let [x, y, z, w] = fast.value;
        return (w != 0.0).then(|| DVec3::new(x / w + 0.0, y / w + 0.0, z / w + 0.0));
    }
    let refined = refine::refined([a, b, c], &fast).map(DVec3::from_array);
    refined.or_else(|| meet_double_double(a, b, c, &fast.permanent)).or_else(|| meet_exact(a, b, c))
}

/// `None` where some coordinate cannot be rounded with certainty.
fn meet_double_double(a: &Row, b: &Row, c: &Row, permanent: &[f64; 4]) -> Option<DVec3> {
    // Outside this range the low words could underflow.
    if permanent.iter().any(|p| *p != 0.0 && !(1e-200..=1e200).contains(p)) {
        return None;
    }
    let [x, y, z, w] = homogeneous_in_double_doubles([a, b, c]);
    let coordinates = rounded_quotients([x, y, z], w, |k| permanent[k], permanent[3])?;
    Some(DVec3::from_array(coordinates))
}

/// Numerators over one denominator, each correctly rounded, where all are off by at most [`DOUBLE_DOUBLE_BOUND`] of their permanents;
/// `None` where some quotient cannot be rounded with certainty.
fn rounded_quotients<const N: usize>(
    numerators: [DoubleDouble; N],
    denominator: DoubleDouble,
    permanent: impl Fn(usize) -> f64,
    denominator_permanent: f64,
) -> Option<[f64; N]> {
    let error = DOUBLE_DOUBLE_BOUND * denominator_permanent / denominator.high.abs();
    if error.is_nan() || error > 1e-3 {
        return None;
    }
    let mut rounded = [0.0; N];
    // one division for all: the reciprocal and a product are off by less than 2⁻¹⁰⁰, for which the factor below has room
    let reciprocal = DoubleDouble::sum(1.0, 0.0).over(denominator);
    for (k, numerator) in numerators.into_iter().enumerate() {
        if permanent(k) == 0.0 {
            continue;
        }
        let quotient = numerator.times_sum(reciprocal);
        let magnitude = quotient.high.abs();
        let off = error * magnitude + DOUBLE_DOUBLE_BOUND * permanent(k) * reciprocal.high.abs();
        rounded[k] = quotient.rounded_with(2.0 * off)?;
    }
    Some(rounded)
}

/// The exact lexicographic order of two meeting points by the coordinates `axes`, each point given by three planes with
/// right-handed normals.
#[must_use]
pub fn compare_exactly(p: [&Row; 3], q: [&Row; 3], axes: &[usize]) -> Ordering {
    let (p, q) = (homogeneous_exactly(p), homogeneous_exactly(q));
    let by_axis = |axis: &usize| (&p[*axis] * &q[3]).cmp(&(&q[*axis] * &p[3]));
    axes.iter().map(by_axis).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

fn meet_exact(a: &Row, b: &Row, c: &Row) -> Option<DVec3> {
    let [x, y, z, w] = homogeneous_exactly([a, b, c]);
    (!w.is_zero()).then(|| DVec3::new(round_quotient(x, &w), round_quotient(y, &w), round_quotient(z, &w)))
}
