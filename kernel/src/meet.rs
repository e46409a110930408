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

/// `(X, Y, Z, W)` of a meeting point, each with an error of at most [`DOUBLE_DOUBLE_BOUND`] times its permanent.
fn homogeneous_in_double_doubles(planes: [&Row; 3]) -> [DoubleDouble; 4] {
    let [a, b, c] = planes.map(Row::coefficients);
    let mut w = DoubleDouble::default();
    let mut numerators = [DoubleDouble::default(); 3];
    for (axis, numerator) in numerators.iter_mut().enumerate() {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (bc, ca, ab) = (minor(b, c, u, v), minor(c, a, u, v), minor(a, b, u, v));
        *numerator = bc.times(a[3]).plus(ca.times(b[3])).plus(ab.times(c[3]));
        w = w.plus(bc.times(a[axis]));
    }
    let [x, y, z] = numerators;
    [x, y, z, w]
}

/// On which side of a plane the meeting point of three others lies, times the sign of `W`, where double-doubles decide it;
/// `permanent` is that of the whole determinant.
///
/// The coordinates are off by [`DOUBLE_DOUBLE_BOUND`] of their permanents, and seven operations follow.
pub(crate) fn certain_side(planes: [&Row; 3], h: &Row, permanent: f64) -> Option<Sign> {
    const SIDE_BOUND: f64 = 1.5 * DOUBLE_DOUBLE_BOUND;
    // outside this range the low words could underflow
    if !(1e-150..=1e150).contains(&permanent) {
        return None;
    }
    let [x, y, z, w] = homogeneous_in_double_doubles(planes);
    let [a, b, c, d] = *h.coefficients();
    let value = x.times(a).plus(y.times(b)).plus(z.times(c)).plus(w.times(-d));
    (value.high.abs() > SIDE_BOUND * permanent).then(|| Sign::of(value.high))
}

/// The determinant of the columns `u`, `v` of two rows. Inlined, so that each number is split into halves once for all
/// products that it is in.
#[inline(always)]
fn minor(p: &[f64; 4], q: &[f64; 4], u: usize, v: usize) -> DoubleDouble {
    DoubleDouble::product(p[u], q[v]).plus(DoubleDouble::product(p[v], q[u]).negated())
}

/// What tells the line of two planes from all others, each number correctly rounded: its slopes against the coordinate `axis`
/// in the two coordinates after it in cyclic order, and these coordinates of the point at which `axis` is zero.
///
/// `None` where the line is perpendicular to the axis, or there is none.
#[must_use]
pub fn line_coordinates(a: &Row, b: &Row, axis: usize) -> Option<[f64; 4]> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    // the numerators, and last the denominator of all
    let columns = [(v, axis), (axis, u), (3, v), (u, 3), (u, v)];
    line_coordinates_in_double_doubles(a, b, columns).or_else(|| {
        let [p, q] = [a, b].map(|row| big_integers(*row.coefficients()));
        let minors = columns.map(|(i, j)| &p[i] * &q[j] - &p[j] * &q[i]);
        let [x, y, z, w, denominator] = minors;
        (!denominator.is_zero()).then(|| [x, y, z, w].map(|numerator| round_quotient(numerator, &denominator)))
    })
}

/// `None` where some number cannot be rounded with certainty.
fn line_coordinates_in_double_doubles(a: &Row, b: &Row, columns: [(usize, usize); 5]) -> Option<[f64; 4]> {
    let (a, b) = (a.coefficients(), b.coefficients());
    let permanents = columns.map(|(i, j)| (a[i] * b[j]).abs() + (a[j] * b[i]).abs());
    // outside this range the low words could underflow
    if permanents.iter().any(|p| *p != 0.0 && !(1e-200..=1e200).contains(p)) {
        return None;
    }
    let [x, y, z, w, denominator] = columns.map(|(i, j)| minor(a, b, i, j));
    rounded_quotients([x, y, z, w], denominator, |k| permanents[k], permanents[4])
}

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
    match determinant.cmp(&IBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
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

/// The unit direction of `nₐ × n_b`, off by a few roundings; zero where the normals are parallel.
#[must_use]
pub fn line_direction(a: &Row, b: &Row) -> DVec3 {
    let (p, q) = (a.coefficients(), b.coefficients());
    let columns = [(1, 2), (2, 0), (0, 1)];
    let cross = columns.map(|(u, v)| minor(p, q, u, v).high);
    let permanent = columns.map(|(u, v)| (p[u] * q[v]).abs() + (p[v] * q[u]).abs()).into_iter().fold(0.0, f64::max);
    let cross = DVec3::from_array(cross);
    let largest = cross.abs().max_element();
    // within this range nothing underflows, and the error is far below the last place
    if permanent > 1e-200 && largest > permanent * 1e-12 { (cross / largest).normalize() } else { direction(a, b) }
}

/// The same, each component accurate to a few roundings of its own.
#[must_use]
pub(crate) fn direction(a: &Row, b: &Row) -> DVec3 {
    rounded_direction(big_cross_of([a, b]))
}

/// The unit direction of `(nₐ × n_b) × (n_c × n_d)`, each component accurate to a few roundings of its own, for pairs `a, b` and `c, d`;
/// zero where it is. It is perpendicular to both lines, however small the angle between them.
#[must_use]
pub fn direction_across([first, second]: [[&Row; 2]; 2]) -> DVec3 {
    let vector = |pair| {
        let [x, y, z] = big_cross_of(pair);
        [x, y, z, IBig::ZERO]
    };
    rounded_direction(big_cross(&vector(first), &vector(second)))
}

fn big_cross_of(pair: [&Row; 2]) -> [IBig; 3] {
    let [a, b] = pair.map(|row| big_integers(*row.coefficients()));
    big_cross(&a, &b)
}

fn rounded_direction(cross: [IBig; 3]) -> DVec3 {
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
