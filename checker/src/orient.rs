//! Exact signs of 3×3 determinants whose rows are differences of points.
//!
//! Three tiers: a floating-point filter, `i128` where the coordinates are small integers on a common power-of-two grid
//! (the rounded coordinates of `f32` meshes and of grid models are), and big integers.
//!
//! The crate `robust` does not do the rest as well: it has no determinant of three unrelated differences, which the axis across an
//! edge of each triangle needs, and its `orient3d` is exact only where no product over- or underflows. It calls the unit
//! tetrahedron flat when scaled by `2^-360`, and answers NaN when scaled by `2^400`.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;

/// One row of a determinant: the vector from the second point to the first, `first - second`.
pub(crate) type Difference = (DVec3, DVec3);

/// Relative error of the filter's determinant against its permanent.
///
/// With unit roundoff `u = 2^-53`: an entry carries one rounding, a product of two entries three, their difference four,
/// the product with the third entry six, the sum of the three terms at most eight factors `1 + u`. The computed permanent
/// may be too small by as many. `10 u` covers `8 u` with all terms of order `u²`, and leaves `u` for underflow (see [`MIN_DETERMINANT`]).
const DETERMINANT_ERROR: f64 = 10.0 * (f64::EPSILON / 2.0);
/// The filter decides only where no entry exceeds this (`2^300`), so that no product overflows.
const MAX_ENTRY: f64 = f64::from_bits((1023 + 300) << 52);
/// The filter decides only determinants above this (`2^-600`). Products that underflow err by at most `2^-1074`, times an
/// entry `2^300` and nine products still less than `2^-770`, far below `u` times this.
const MIN_DETERMINANT: f64 = f64::from_bits((1023 - 600) << 52);
/// Widest coordinate in bits for `i128`: differences have one bit more and a determinant is the sum of six triple products,
/// `3 (40 + 1) + 3 = 126` bits.
const MAX_SMALL_BITS: i32 = 40;

/// Sign of the determinant with the given rows, compared with zero: `Greater` where the rows are a right-handed triple.
///
/// Exact for all finite coordinates.
pub(crate) fn determinant_sign(rows: [Difference; 3]) -> Ordering {
    if rows.iter().any(|(p, q)| p == q) {
        return Ordering::Equal;
    }
    filtered_sign(rows).unwrap_or_else(|| exact_sign(rows))
}

/// On which side of the plane through `a, b, c` the point `d` lies: `Greater` on the side from which the triangle is seen
/// counter-clockwise, `Equal` on the plane (or where `a, b, c` are collinear).
pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
    if d == a || d == b || d == c {
        return Ordering::Equal;
    }
    determinant_sign([(b, a), (c, a), (d, a)])
}

/// The sign by floating point, where its error bound allows a decision.
fn filtered_sign(rows: [Difference; 3]) -> Option<Ordering> {
    let [u, v, w] = rows.map(|(p, q)| p - q);
    let largest = u.abs().max(v.abs()).max(w.abs()).max_element();
    let minor = |a: f64, b: f64, c: f64, d: f64| (a * d - b * c, (a * d).abs() + (b * c).abs());
    let (mx, px) = minor(v.y, v.z, w.y, w.z);
    let (my, py) = minor(v.z, v.x, w.z, w.x);
    let (mz, pz) = minor(v.x, v.y, w.x, w.y);
    let determinant = u.x * mx + u.y * my + u.z * mz;
    let permanent = u.x.abs() * px + u.y.abs() * py + u.z.abs() * pz;
    let decided = largest <= MAX_ENTRY
        && determinant.abs() > DETERMINANT_ERROR * permanent
        && determinant.abs() > MIN_DETERMINANT;
    decided.then(|| determinant.total_cmp(&0.0))
}

/// The sign by integers: all coordinates are scaled by one power of two that makes them whole.
fn exact_sign(rows: [Difference; 3]) -> Ordering {
    let parts = rows.map(|(p, q)| [p.to_array().map(decompose), q.to_array().map(decompose)]);
    let nonzero = || parts.iter().flatten().flatten().filter(|(mantissa, _)| *mantissa != 0);
    let Some(lowest) = nonzero().map(|&(_, exponent)| exponent).min() else { return Ordering::Equal };
    let highest = nonzero().map(|&(m, exponent)| exponent + bit_length(m)).max().unwrap_or(lowest);
    if highest - lowest <= MAX_SMALL_BITS {
        let whole = |(m, e): (i64, i32)| if m == 0 { 0 } else { i128::from(m) << (e - lowest) };
        let [u, v, w] = parts.map(|[p, q]| [0, 1, 2].map(|k| whole(p[k]) - whole(q[k])));
        let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
        (u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)).cmp(&0)
    } else {
        let whole = |(m, e): (i64, i32)| {
            if m == 0 { IBig::ZERO } else { IBig::from(m) << (e - lowest).unsigned_abs() as usize }
        };
        let [u, v, w] = parts.map(|[p, q]| [0, 1, 2].map(|k| whole(p[k]) - whole(q[k])));
        let minor = |i: usize, j: usize| &v[i] * &w[j] - &v[j] * &w[i];
        (&u[0] * minor(1, 2) + &u[1] * minor(2, 0) + &u[2] * minor(0, 1)).cmp(&IBig::ZERO)
    }
}

/// Number of bits of `|m|`; at most 53 here.
fn bit_length(m: i64) -> i32 {
    (u64::BITS - m.unsigned_abs().leading_zeros()).cast_signed()
}

/// A finite number as `mantissa · 2^exponent` with an odd mantissa, or `(0, 0)`.
fn decompose(value: f64) -> (i64, i32) {
    if value == 0.0 {
        return (0, 0);
    }
    let bits = value.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    let zeros = mantissa.trailing_zeros().cast_signed();
    let odd = mantissa >> zeros;
    (if value < 0.0 { -odd } else { odd }, exponent + zeros)
}

#[cfg(test)]
mod tests {
    use dashu_ratio::RBig;
    use planecut_testkit::random::Rng;

    use super::*;

    fn rational_sign(rows: [Difference; 3]) -> Ordering {
        let exact = |v: f64| RBig::try_from(v).expect("coordinates are finite");
        let [u, v, w] = rows.map(|(p, q)| [exact(p.x) - exact(q.x), exact(p.y) - exact(q.y), exact(p.z) - exact(q.z)]);
        let minor = |i: usize, j: usize| &v[i] * &w[j] - &v[j] * &w[i];
        (&u[0] * minor(1, 2) + &u[1] * minor(2, 0) + &u[2] * minor(0, 1)).cmp(&RBig::ZERO)
    }

    /// Points drawn to be nearly or exactly coplanar: small integers, their neighbours in f64, extreme scales.
    fn coordinate(random: &mut Rng, style: u64) -> f64 {
        let small = random.below(9) as f64 - 4.0;
        match style {
            0 => small,
            1 => f64::from_bits((small / 3.0).to_bits() + random.below(3) as u64),
            2 => f64::from((random.below(1 << 24) as f32) / 3.0),
            3 => small * 2f64.powi(random.below(2000) as i32 - 1020),
            4 => f64::from_bits(random.below(8) as u64),
            _ => random.bits() as f64 / u64::MAX as f64,
        }
    }

    #[test]
    fn signs_agree_with_rationals() {
        let seed = 0x5eed_0001;
        let mut random = Rng::new(seed);
        let mut seen = [0usize; 3];
        for case in 0..60_000u64 {
            let style = case % 6;
            let mut point = || DVec3::from_array([0; 3].map(|_| coordinate(&mut random, style)));
            let rows = [0; 3].map(|_| (point(), point()));
            let sign = determinant_sign(rows);
            assert_eq!(sign, rational_sign(rows), "seed {seed:#x} case {case}: {rows:?}");
            seen[(sign as i8 + 1) as usize] += 1;
        }
        assert!(seen.iter().all(|&n| n > 100), "all three signs occur often: {seen:?}");
    }

    #[test]
    fn every_tier_agrees_with_rationals() {
        let seed = 0x5eed_0002;
        let mut random = Rng::new(seed);
        let mut filtered = 0;
        for case in 0..6_000u64 {
            let mut point = || DVec3::from_array([0; 3].map(|_| coordinate(&mut random, case % 6)));
            let rows = [0; 3].map(|_| (point(), point()));
            let expected = rational_sign(rows);
            assert_eq!(exact_sign(rows), expected, "seed {seed:#x} case {case}: {rows:?}");
            if let Some(sign) = filtered_sign(rows) {
                assert_eq!(sign, expected, "seed {seed:#x} case {case}: {rows:?}");
                filtered += 1;
            }
        }
        assert!(filtered > 1_000, "the filter decides ordinary cases, decided {filtered}");
    }

    #[test]
    fn orientation_follows_the_right_hand() {
        let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
        assert_eq!(orient3d(o, x, y, z), Ordering::Greater);
        assert_eq!(orient3d(o, x, y, -z), Ordering::Less);
        assert_eq!(orient3d(o, x, y, x + y), Ordering::Equal);
    }
}
