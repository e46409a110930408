//! The meeting point of three planes, each coordinate rounded correctly.
//!
//! Correct rounding makes the coordinates a function of the point alone, whichever three of the planes through it are
//! used: equal points get equal coordinates, and the order of coordinates never contradicts the exact order. So
//! coordinates can propose (hash, sort) while signs decide.

use std::cmp::Ordering;

use dashu_int::{IBig, UBig, ops::BitTest};
use glam::DVec3;

use crate::double_double::DoubleDouble;
use crate::sign::{Homogeneous, OffsetColumn, Row, Sign, big_cross, big_dot, big_integers};

/// Relative error of the double-double evaluation, in units of the permanent. Each term passes at most 12 operations of
/// relative error `2⁻¹⁰²`, and a product of permanents leaves room.
const DOUBLE_DOUBLE_BOUND: f64 = f64::from_bits((1023 - 97) << 52);

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
    meet_double_double(a, b, c, &fast.permanent).or_else(|| meet_exact(a, b, c))
}

/// `None` where some coordinate cannot be rounded with certainty.
fn meet_double_double(a: &Row, b: &Row, c: &Row, permanent: &[f64; 4]) -> Option<DVec3> {
    // Outside this range the low words could underflow.
    if permanent.iter().any(|p| *p != 0.0 && !(1e-200..=1e200).contains(p)) {
        return None;
    }
    let [a, b, c] = [a, b, c].map(Row::coefficients);
    let cross = |p: &[f64; 4], q: &[f64; 4], u: usize, v: usize| {
        DoubleDouble::product(p[u], q[v]).plus(DoubleDouble::product(p[v], q[u]).negated())
    };
    let mut w = DoubleDouble::default();
    let mut numerators = [DoubleDouble::default(); 3];
    for (axis, numerator) in numerators.iter_mut().enumerate() {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (bc, ca, ab) = (cross(b, c, u, v), cross(c, a, u, v), cross(a, b, u, v));
        *numerator = bc.times(a[3]).plus(ca.times(b[3])).plus(ab.times(c[3]));
        w = w.plus(bc.times(a[axis]));
    }
    let w_error = DOUBLE_DOUBLE_BOUND * permanent[3] / w.high.abs();
    if w_error.is_nan() || w_error > 1e-3 {
        return None;
    }
    let mut coordinates = [0.0; 3];
    for axis in 0..3 {
        let numerator = numerators[axis];
        if permanent[axis] == 0.0 {
            continue;
        }
        let relative = w_error + DOUBLE_DOUBLE_BOUND * permanent[axis] / numerator.high.abs();
        let quotient = numerator.over(w);
        coordinates[axis] = quotient.rounded_with(2.0 * relative * quotient.high.abs())?;
    }
    Some(DVec3::from_array(coordinates))
}

/// The turn that the projections of three meeting points onto the coordinates `u`, `v` make: positive to the left, exactly.
///
/// Each point is given by three planes with right-handed normals. Always by big integers: for what a filter left open.
#[must_use]
pub fn planar_turn(points: [[&Row; 3]; 3], u: usize, v: usize) -> Sign {
    let [p, q, r] = points.map(homogeneous_exactly);
    let minor = |i: usize, j: usize| &q[i] * &r[j] - &q[j] * &r[i];
    let determinant = &p[u] * minor(v, 3) + &p[v] * minor(3, u) + &p[3] * minor(u, v);
    match determinant.cmp(&IBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

/// The exact lexicographic order of two meeting points by the coordinates `axes`, each point given by three planes with
/// right-handed normals.
#[must_use]
pub fn compare_exactly(p: [&Row; 3], q: [&Row; 3], axes: &[usize]) -> Ordering {
    let (p, q) = (homogeneous_exactly(p), homogeneous_exactly(q));
    let by_axis = |axis: &usize| (&p[*axis] * &q[3]).cmp(&(&q[*axis] * &p[3]));
    axes.iter().map(by_axis).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// `(X, Y, Z, W)` of a meeting point.
pub(crate) fn homogeneous_exactly(planes: [&Row; 3]) -> [IBig; 4] {
    let [a, b, c] = planes.map(|row| big_integers(*row.coefficients()));
    let (bc, ca, ab) = (big_cross(&b, &c), big_cross(&c, &a), big_cross(&a, &b));
    let coordinate = |k: usize| &a[3] * &bc[k] + &b[3] * &ca[k] + &c[3] * &ab[k];
    [coordinate(0), coordinate(1), coordinate(2), big_dot(&a, &bc)]
}

/// The unit direction of `nₐ × n_b`, each component accurate to a few roundings; zero where the normals are parallel.
#[must_use]
pub(crate) fn direction(a: &Row, b: &Row) -> DVec3 {
    let [a, b] = [a, b].map(|row| big_integers(*row.coefficients()));
    let cross = big_cross(&a, &b);
    // Keep the leading 100 bits of the longest component: what is lost lies far below its last place.
    let surplus = cross.iter().map(|v| v.bit_len()).max().unwrap_or(0).saturating_sub(100);
    let [x, y, z] = cross.map(|v| i128::try_from(v >> surplus).unwrap_or_default() as f64);
    DVec3::new(x, y, z).normalize_or_zero()
}

fn meet_exact(a: &Row, b: &Row, c: &Row) -> Option<DVec3> {
    let [x, y, z, w] = homogeneous_exactly([a, b, c]);
    (!w.is_zero()).then(|| DVec3::new(round_quotient(x, &w), round_quotient(y, &w), round_quotient(z, &w)))
}

/// `numerator / denominator`, rounded to nearest, ties to even.
///
/// The quotient is taken to be in the range of normal numbers; below it the last bits may be lost.
pub(crate) fn round_quotient(numerator: IBig, denominator: &IBig) -> f64 {
    use dashu_int::Sign as BigSign;
    let (numerator_sign, numerator) = numerator.into_parts();
    let (denominator_sign, denominator) = denominator.clone().into_parts();
    if numerator.is_zero() {
        return 0.0;
    }
    // A quotient of 65 or 66 bits, its last bit made sticky: more than 53 + 2, so one more rounding is the right one.
    let shift = 65 + denominator.bit_len() as i64 - numerator.bit_len() as i64;
    let (scaled, divisor) = if shift >= 0 {
        (numerator << shift as usize, denominator)
    } else {
        (numerator, denominator << (-shift) as usize)
    };
    let (mut quotient, remainder) = (&scaled / &divisor, &scaled % &divisor);
    if !remainder.is_zero() {
        quotient |= UBig::ONE;
    }
    let mantissa = u128::try_from(quotient).unwrap_or(u128::MAX) as f64;
    let magnitude = ldexp(mantissa, -shift);
    if numerator_sign == BigSign::Negative && denominator_sign == BigSign::Positive
        || numerator_sign == BigSign::Positive && denominator_sign == BigSign::Negative
    {
        -magnitude
    } else {
        magnitude
    }
}

pub(crate) fn ldexp(mut v: f64, mut power: i64) -> f64 {
    const STEP: i64 = 1000;
    let factor = |p: i64| f64::from_bits(((1023 + p) as u64) << 52);
    while power > STEP && v.is_finite() {
        v *= factor(STEP);
        power -= STEP;
    }
    while power < -STEP && v != 0.0 {
        v *= factor(-STEP);
        power += STEP;
    }
    v * factor(power.clamp(-STEP, STEP))
}
