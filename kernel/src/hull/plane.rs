//! A half-space for a facet: exact where its coefficients fit, else rounded so that it contains every point.
//!
//! Nearly all facets of points in general position are done in double-double arithmetic, each result with a bound of its
//! error; what the bound leaves open, and what may be exact, is done in big integers.

use std::array::from_fn;

use dashu_int::{IBig, UBig, ops::BitTest, ops::Gcd};
use glam::DVec3;

use crate::arithmetic::{DoubleDouble, big_integers, exponent, lowest_bit, round_quotient};
use crate::half_space::HalfSpace;
use crate::sign::{Row, Sign, side_of_point};

use super::neighbours::Neighbours;

/// Components of a rounded normal that are this much smaller than the largest are left out; the offset makes up for it.
const NEGLIGIBLE: f64 = f64::from_bits((1023 - 100) << 52);
/// The smallest ratio of an offset to a normal that half-spaces accept, with room.
const SMALLEST_OFFSET: f64 = f64::from_bits((1023 - 190) << 52);
/// Error of a double-double sum of three products or of a 2×2 minor, of exact differences, in units of the permanent: at most
/// five operations of relative error `3·2⁻¹⁰⁶` (Joldes, Muller, Popescu 2017), with room for the rounding of the permanent.
const DOUBLE_DOUBLE_BOUND: f64 = f64::from_bits((1023 - 101) << 52);
/// Components that are this much smaller than the largest are left to big integers.
const SMALLEST_CERTAIN: f64 = f64::from_bits((1023 - 90) << 52);
/// Bits of the whole numbers that are looked for in a normal, and of the grids whose planes are all tried exactly.
const WHOLE_BITS: i32 = 24;

/// The half-space through three points of a hull, counter-clockwise seen from outside, that contains all of them.
pub(super) fn through(points: &[DVec3], corners: [u32; 3], neighbours: &Neighbours) -> HalfSpace {
    let [a, b, c] = corners.map(|p| points[p as usize]);
    if let Some(half_space) = small_integers(a, b, c) {
        return half_space;
    }
    let normal = match certain_normal([a, b, c]) {
        Some(normal) => normal,
        None => {
            let coefficients = exact_coefficients(a, b, c);
            if let Some(half_space) = representable(&coefficients) {
                return half_space;
            }
            rounded_normal(&coefficients)
        }
    };
    let top = farthest(points, corners[0], normal, neighbours);
    containing(normal, points[top as usize])
}

/// A half-space that touches the hull at a sharp edge, given by its two ends and the opposite corners of its triangles;
/// `None` where they are too near each other to tell.
pub(super) fn across_edge(points: &[DVec3], edge: &[u32; 4], neighbours: &Neighbours) -> Option<HalfSpace> {
    let [from, to, first, second] = edge.map(|p| points[p as usize]);
    let along = (to - from).normalize_or_zero();
    let away = |p: DVec3| {
        let inward = p - from;
        -(inward - along * inward.dot(along)).normalize_or_zero()
    };
    let normal = (away(first) + away(second)).normalize_or_zero();
    let normal = normal.map(|v| if v.abs() < NEGLIGIBLE { 0.0 } else { v });
    if normal == DVec3::ZERO {
        return None;
    }
    Some(containing(normal, points[farthest(points, edge[0], normal, neighbours) as usize]))
}

/// The exact plane where everything is a small integer.
fn small_integers(a: DVec3, b: DVec3, c: DVec3) -> Option<HalfSpace> {
    const SMALL: f64 = (1u64 << 15) as f64;
    let is_small = |p: DVec3| p == p.trunc() && p.abs().max_element() < SMALL;
    if ![a, b, c].into_iter().all(is_small) {
        return None;
    }
    let normal = (b - a).cross(c - a);
    HalfSpace::new(normal, normal.dot(a)).ok()
}

/// The same as [`rounded_normal`] where double-double arithmetic can tell it, and nothing suggests that the plane might be
/// [`representable`]: no grid of few steps, no normal of few digits.
fn certain_normal(corners: [DVec3; 3]) -> Option<DVec3> {
    if is_on_coarse_grid(corners) {
        return None;
    }
    let [a, b, c] = corners.map(|p| p.to_array());
    let from_a = |p: [f64; 3]| -> [DoubleDouble; 3] { from_fn(|k| DoubleDouble::sum(p[k], -a[k])) };
    let (u, v) = (from_a(b), from_a(c));
    let mut normal = [DoubleDouble::default(); 3];
    let mut errors = [0.0; 3];
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (u[i].times_sum(v[j]), u[j].times_sum(v[i]));
        normal[k] = left.plus(right.negated());
        errors[k] = DOUBLE_DOUBLE_BOUND * (left.high.abs() + right.high.abs()) / normal[k].high.abs();
    }
    let top = (0..3).fold(0, |top, k| if normal[k].high.abs() > normal[top].high.abs() { k } else { top });
    let length = if normal[top].high < 0.0 { normal[top].negated() } else { normal[top] };
    let mut rounded = [normal[top].high.signum(); 3];
    for k in (0..3).filter(|k| *k != top) {
        let quotient = normal[k].over(length);
        let size = quotient.high.abs();
        // also where an error is not a number
        let relative = errors[k] + errors[top] + DOUBLE_DOUBLE_BOUND;
        if !(size > SMALLEST_CERTAIN && size < 1.0 - f64::EPSILON && relative < 1e-6) {
            return None;
        }
        rounded[k] = quotient.rounded_with(2.0 * relative * size)?;
    }
    let ratios = (0..3).filter(|k| *k != top).map(|k| rounded[k].abs());
    ratios.into_iter().any(|ratio| !is_simple_ratio(ratio)).then(|| DVec3::from_array(rounded))
}

/// Whether all coordinates are multiples, of at most [`WHOLE_BITS`] bits, of one power of two.
fn is_on_coarse_grid(corners: [DVec3; 3]) -> bool {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for v in corners.iter().flat_map(|p| p.to_array()).filter(|v| *v != 0.0) {
        lowest = lowest.min(lowest_bit(v));
        highest = highest.max(exponent(v));
        if highest - lowest >= WHOLE_BITS {
            return false;
        }
    }
    true
}

/// Whether a number in `[0, 1]`, off by at most one rounding, may be a quotient of whole numbers below `2^WHOLE_BITS`: one of
/// the convergents of its continued fraction is then as near as that.
fn is_simple_ratio(ratio: f64) -> bool {
    const ONE: u64 = 1 << 62;
    // what is cut off, and one rounding
    const ERROR: u64 = 1 << 10;
    let whole = (ratio * ONE as f64) as u64;
    let (mut longer, mut shorter) = (ONE, whole);
    // the numerators and denominators of two convergents
    let (mut before, mut last) = ((1u64, 0u64), (0u64, 1u64));
    while last.1 < 1 << WHOLE_BITS {
        // |whole/ONE − p/q| ≤ ERROR/ONE
        let off = i128::from(whole) * i128::from(last.1) - i128::from(last.0) * i128::from(ONE);
        if off.unsigned_abs() <= u128::from(ERROR) * u128::from(last.1) {
            return true;
        }
        let (digit, rest) = (longer / shorter, longer % shorter);
        (longer, shorter) = (shorter, rest);
        let Some(next) = digit.checked_mul(last.1).and_then(|q| q.checked_add(before.1)) else { return false };
        (before, last) = (last, (digit.saturating_mul(last.0).saturating_add(before.0), next));
    }
    false
}

/// `[n | d]` of the plane through three points, up to one positive scale.
fn exact_coefficients(a: DVec3, b: DVec3, c: DVec3) -> [IBig; 4] {
    let [ax, ay, az, bx, by, bz, cx, cy, cz, one] = big_integers([a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, 1.0]);
    let (u, v) = ([bx - &ax, by - &ay, bz - &az], [cx - &ax, cy - &ay, cz - &az]);
    let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    let normal = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let offset = &normal[0] * ax + &normal[1] * ay + &normal[2] * az;
    let [x, y, z] = normal;
    [x * &one, y * &one, z * &one, offset]
}

/// The plane itself, where its coprime coefficients are below 2⁵³ (or up to powers of two, so few bits long).
fn representable(coefficients: &[IBig; 4]) -> Option<HalfSpace> {
    let magnitudes = coefficients.each_ref().map(|v| v.clone().into_parts().1);
    let divisor = magnitudes.into_iter().filter(|v| !v.is_zero()).reduce(UBig::gcd)?;
    let divisor = IBig::from(divisor);
    let coprime = coefficients.each_ref().map(|v| v / &divisor);
    if coprime.iter().any(|v| v.bit_len() > 53) {
        return None;
    }
    let [x, y, z, d] = coprime.map(|v| i64::try_from(v).unwrap_or_default() as f64);
    HalfSpace::new(DVec3::new(x, y, z), d).ok()
}

/// The normal scaled to a largest component of one, each component correctly rounded.
fn rounded_normal(coefficients: &[IBig; 4]) -> DVec3 {
    let largest = (0..3).map(|k| coefficients[k].clone().into_parts().1).max().unwrap_or(UBig::ONE);
    let largest = IBig::from(largest);
    DVec3::from_array(from_fn(|k| {
        let component = round_quotient(coefficients[k].clone(), &largest);
        if component.abs() < NEGLIGIBLE { 0.0 } else { component }
    }))
}

/// The vertex of the hull that is farthest along a normal: a local maximum among neighbours is one of all.
fn farthest(points: &[DVec3], start: u32, normal: DVec3, neighbours: &Neighbours) -> u32 {
    let mut top = start;
    'climb: loop {
        for other in neighbours.that_may_be_farther(points, top, normal) {
            if is_farther(normal, points[other as usize], points[top as usize]) {
                top = other;
                continue 'climb;
            }
        }
        return top;
    }
}

/// Whether `n·p > n·q`, exactly.
fn is_farther(normal: DVec3, p: DVec3, q: DVec3) -> bool {
    let (n, p, q) = (normal.to_array(), p.to_array(), q.to_array());
    let value = (0..3).map(|k| n[k] * (p[k] - q[k])).sum::<f64>();
    let permanent: f64 = (0..3).map(|k| n[k].abs() * (p[k] - q[k]).abs()).sum();
    // difference, product and two sums: 4 roundings a term
    if value.abs() > 4.0 * f64::EPSILON * permanent {
        return value > 0.0;
    }
    let terms: [DoubleDouble; 3] = from_fn(|k| DoubleDouble::sum(p[k], -q[k]).times(n[k]));
    let sum = terms[0].plus(terms[1]).plus(terms[2]);
    if sum.high.abs() > DOUBLE_DOUBLE_BOUND * permanent {
        return sum.high > 0.0;
    }
    let [nx, ny, nz] = big_integers(n);
    let [px, py, pz, qx, qy, qz] = big_integers([p[0], p[1], p[2], q[0], q[1], q[2]]);
    nx * (px - qx) + ny * (py - qy) + nz * (pz - qz) > IBig::ZERO
}

/// The half-space of a normal whose offset is the smallest number that lets it contain a point.
fn containing(normal: DVec3, point: DVec3) -> HalfSpace {
    let terms: [DoubleDouble; 3] = from_fn(|k| DoubleDouble::product(normal[k], point[k]));
    let sum = terms[0].plus(terms[1]).plus(terms[2]);
    let permanent = terms.iter().map(|term| term.high.abs()).sum::<f64>();
    let mut offset = sum.high;
    if offset.abs() > SMALLEST_OFFSET && sum.low.abs() > DOUBLE_DOUBLE_BOUND * permanent {
        offset = if sum.low > 0.0 { offset.next_up() } else { offset };
        return HalfSpace::new(normal, offset).expect("the points are in the accepted range");
    }
    loop {
        // an offset too small for a half-space is moved outward to one that fits
        if offset != 0.0 && offset.abs() < SMALLEST_OFFSET {
            offset = if offset > 0.0 { SMALLEST_OFFSET } else { 0.0 };
        }
        let half_space = HalfSpace::new(normal, offset).expect("the points are in the accepted range");
        if side_of_point(&Row::new(&half_space), point) != Sign::Positive {
            return half_space;
        }
        offset = offset.next_up();
    }
}

#[cfg(test)]
mod tests {
    use planecut_oracle::random::Rng;
    use planecut_oracle::settings::first_seed;

    use super::*;

    fn some_corners(rng: &mut Rng, kind: usize) -> [DVec3; 3] {
        from_fn(|_| {
            let direction = DVec3::from_array(rng.direction());
            match kind {
                0 => direction,
                1 => direction * 2f64.powi(rng.integer(-140, 140) as i32),
                2 => DVec3::new(1e8, -3e7, 2e5) + direction,
                // nearly on a line
                3 => DVec3::new(0.3, 0.7, -0.2) * rng.float(-1.0, 1.0) + direction * 1e-14,
                // nearly on a plane along two axes
                _ => DVec3::new(direction.x, direction.y, 0.7 + direction.z * 1e-13),
            }
        })
    }

    #[test]
    fn double_double_arithmetic_rounds_normals_as_big_integers_do() {
        let mut certain = [0; 5];
        for k in 0..20_000 {
            let seed = first_seed() + k as u64;
            let corners = some_corners(&mut Rng::new(seed), k % 5);
            if let Some(normal) = certain_normal(corners) {
                let [a, b, c] = corners;
                let exact = exact_coefficients(a, b, c);
                assert_eq!(normal, rounded_normal(&exact), "seed {seed}, corners {corners:?}");
                certain[k % 5] += 1;
            }
        }
        assert!(certain[0] > 3900 && certain.iter().all(|n| *n > 1000), "{certain:?} of 4000 each");
    }

    #[test]
    fn simple_ratios_are_found() {
        let mut rng = Rng::new(first_seed());
        for _ in 0..20_000 {
            let q = 1 + rng.below((1 << WHOLE_BITS) - 1);
            let ratio = rng.below(q + 1) as f64 / q as f64;
            assert!(is_simple_ratio(ratio) && is_simple_ratio(ratio.next_down().max(0.0)), "{ratio:?}");
        }
        let others = (0..1000).filter(|_| !is_simple_ratio(rng.float(0.0, 1.0))).count();
        assert!(others > 800, "{others} of 1000 random numbers are no simple ratios");
    }
}
