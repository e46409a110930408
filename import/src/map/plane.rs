//! The plane through three points, exactly.
//!
//! With points `p = P / s` for integer `P` and a common scale `s`, the integers `N = (P0 − P1) × (P2 − P1)` and
//! `D = N·P1` describe the plane `s·N·x = D`. The four integers are divided by their greatest common divisor, so that
//! any three points of one plane give the same four. Where each of them is an `f64`, the coefficients are exact;
//! otherwise each is rounded once, all at one power-of-two scale.
//!
//! Points with few decimals take 128-bit integers, all others big integers from the `f64` values.

use dashu_int::ops::{BitTest, Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};
use glam::DVec3;
use planecut_kernel::{HalfSpace, HalfSpaceError, decompose_odd};

use super::decimal::Decimal;

/// A point of a map.
pub(super) type Point = [Decimal; 3];

/// Why three points gave no half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PlaneError {
    /// The three points lie on one line.
    NoArea,
    /// The plane exists, its coefficients are not accepted.
    OutOfRange(HalfSpaceError),
}

/// The half-space `n·x ≤ n·p1` with the outward normal `n = (p0 − p1) × (p2 − p1)`, up to a positive scale.
pub(super) fn half_space(points: &[Point; 3]) -> Result<HalfSpace, PlaneError> {
    let [x, y, z, offset] = match small_integers(points) {
        Some((points, scale)) => small_coefficients(&points, scale)?,
        None => big_coefficients(points)?,
    };
    HalfSpace::new(DVec3::new(x, y, z), offset).map_err(PlaneError::OutOfRange)
}

/// The half-space `a x + b y + c z + d ≤ 0` of a plane that is given relative to `origin`.
///
/// Decimals with few places are taken exactly, as integers without a common factor; others as the `f64` values that they are.
pub(super) fn half_space_of(equation: &[Decimal; 4], origin: &Point) -> Result<HalfSpace, PlaneError> {
    if let Some([x, y, z, offset]) = small_equation(equation, origin) {
        if [x, y, z] == [0.0; 3] {
            return Err(PlaneError::NoArea);
        }
        return HalfSpace::new(DVec3::new(x, y, z), offset).map_err(PlaneError::OutOfRange);
    }
    let [a, b, c, d] = equation.map(Decimal::to_f64);
    let normal = DVec3::new(a, b, c);
    if normal == DVec3::ZERO {
        return Err(PlaneError::NoArea);
    }
    let offset = normal.dot(DVec3::from_array(origin.map(Decimal::to_f64))) - d;
    HalfSpace::new(normal, offset).map_err(PlaneError::OutOfRange)
}

/// Coefficients `[nx, ny, nz, offset]` without a common factor, where all are exact.
fn small_equation([a, b, c, d]: &[Decimal; 4], origin: &Point) -> Option<[f64; 4]> {
    let normal = [*a, *b, *c];
    let ([normal, origin, [d, ..]], scale) = small_integers(&[normal, *origin, [*d; 3]])?;
    // The normal, origin and offset are `scale` times the true ones: |n·o| < 3·2^80, the rest is smaller.
    let offset = normal[0] * origin[0] + normal[1] * origin[1] + normal[2] * origin[2] - d * scale;
    let integers = [normal[0] * scale, normal[1] * scale, normal[2] * scale, offset];
    let divisor = integers.into_iter().fold(0, |divisor, v| gcd(divisor, v.unsigned_abs())).max(1) as i128;
    let primitive = integers.map(|v| v / divisor);
    primitive.iter().all(|v| v.unsigned_abs() <= 1 << f64::MANTISSA_DIGITS).then(|| primitive.map(|v| v as f64))
}

/// Largest coordinate, times the scale, for 128-bit arithmetic.
///
/// With `|P| ≤ 2^40`: differences `≤ 2^41`, `|N| ≤ 2·2^82`, `10^6·|N| < 2^103`, `|D| ≤ 3·2^83·2^40 < 2^125`.
const MAX_SMALL: i64 = 1 << 40;

/// The points times the smallest power of ten that makes them integers, and this power.
fn small_integers(points: &[Point; 3]) -> Option<([[i128; 3]; 3], i128)> {
    let mut most_places = 0;
    for number in points.as_flattened() {
        let Decimal::Exact { places, .. } = *number else { return None };
        most_places = most_places.max(places);
    }
    let mut integers = [[0; 3]; 3];
    for (integer, number) in integers.as_flattened_mut().iter_mut().zip(points.as_flattened()) {
        let Decimal::Exact { mantissa, places } = *number else { return None };
        let value = mantissa.checked_mul(10_i64.pow(most_places - places))?;
        if value.abs() > MAX_SMALL {
            return None;
        }
        *integer = i128::from(value);
    }
    Some((integers, 10_i128.pow(most_places)))
}

/// Coefficients `[nx, ny, nz, d]` of the plane through integer points that are `scale` times the true ones.
fn small_coefficients([p0, p1, p2]: &[[i128; 3]; 3], scale: i128) -> Result<[f64; 4], PlaneError> {
    let [a, b] = [p0, p2].map(|p| [p[0] - p1[0], p[1] - p1[1], p[2] - p1[2]]);
    let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    if normal == [0; 3] {
        return Err(PlaneError::NoArea);
    }
    let offset = normal[0] * p1[0] + normal[1] * p1[1] + normal[2] * p1[2];
    let integers = [normal[0] * scale, normal[1] * scale, normal[2] * scale, offset];
    let divisor = integers.into_iter().fold(0, |divisor, v| gcd(divisor, v.unsigned_abs())) as i128;
    let primitive = integers.map(|v| v / divisor);
    let exact = primitive.iter().all(|v| v.unsigned_abs() <= 1 << f64::MANTISSA_DIGITS);
    Ok(if exact { primitive.map(|v| v as f64) } else { to_f64(&primitive.map(IBig::from)) })
}

/// The greatest common divisor; that of 0 and `v` is `v`.
fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        // Division of 64 bits is several times faster, and nearly all maps stay inside it.
        if let (Ok(mut short_a), Ok(mut short_b)) = (u64::try_from(a), u64::try_from(b)) {
            while short_b != 0 {
                (short_a, short_b) = (short_b, short_a % short_b);
            }
            return u128::from(short_a);
        }
        (a, b) = (b, a % b);
    }
    a
}

/// Coefficients `[nx, ny, nz, d]` of the plane through the points' `f64` values.
fn big_coefficients(points: &[Point; 3]) -> Result<[f64; 4], PlaneError> {
    let (points, shift) = big_integers(points);
    let [p0, p1, p2] = &points;
    let [a, b] = [p0, p2].map(|p| [&p[0] - &p1[0], &p[1] - &p1[1], &p[2] - &p1[2]]);
    let minor = |u: usize, v: usize| &a[u] * &b[v] - &a[v] * &b[u];
    let [x, y, z] = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let offset = &x * &p1[0] + &y * &p1[1] + &z * &p1[2];
    let integers = [x << shift, y << shift, z << shift, offset];
    if integers[..3].iter().all(IBig::is_zero) {
        return Err(PlaneError::NoArea);
    }
    let divisor = integers.iter().filter(|v| !v.is_zero()).fold(UBig::ZERO, |divisor, v| {
        let v = v.unsigned_abs();
        if divisor.is_zero() { v } else { divisor.gcd(v) }
    });
    Ok(to_f64(&integers.map(|v| v / &divisor)))
}

/// The points' `f64` values times `2^shift`, with the smallest shift that makes them integers.
fn big_integers(points: &[Point; 3]) -> ([[IBig; 3]; 3], usize) {
    let parts = points.map(|p| p.map(|number| decompose_odd(number.to_f64())));
    // Exponents are between −1,074 and 971, so integers have at most 2,100 bits.
    let exponents = parts.as_flattened().iter().filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| *exponent);
    let lowest = exponents.min().unwrap_or(0).min(0);
    let integer = |(mantissa, exponent): (i64, i32)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << (exponent - lowest) as usize,
    };
    (parts.map(|p| p.map(integer)), -lowest as usize)
}

/// Longest integer that is handed over unscaled.
const MAX_EXACT_BITS: usize = 1000;

/// The coefficients as `f64`: themselves where all are exact, otherwise rounded to nearest at the one power-of-two scale
/// that puts the largest normal component into `[1, 2)`.
///
/// What would leave the range of `f64` is put so far out that [`HalfSpace`] refuses it.
fn to_f64(coefficients: &[IBig; 4]) -> [f64; 4] {
    let rounded = coefficients.each_ref().map(Rounded::new);
    if rounded.iter().all(|r| r.exact && r.exponent < MAX_EXACT_BITS as i64) {
        return rounded.map(|r| r.scaled(0));
    }
    let largest = rounded[..3].iter().filter(|r| r.mantissa != 0.0).map(|r| r.exponent).max().unwrap_or(0);
    rounded.map(|r| r.scaled(-largest))
}

/// An integer rounded to nearest (ties to even): `mantissa · 2^exponent` with `1 ≤ |mantissa| < 2`, or zero.
struct Rounded {
    mantissa: f64,
    exponent: i64,
    /// Whether nothing was lost.
    exact: bool,
}

impl Rounded {
    fn new(value: &IBig) -> Self {
        let magnitude = value.unsigned_abs();
        let bits = magnitude.bit_len();
        let dropped = bits.saturating_sub(u64::BITS as usize);
        let zeros = magnitude.trailing_zeros().unwrap_or(0);
        // 64 bits, of which the last also stands for all that are cut off behind it, round like the whole number.
        let leading = u64::try_from(&magnitude >> dropped).expect("cut to 64 bits") | u64::from(zeros < dropped);
        let nearest = leading as f64;
        let size = if leading == 0 { 0 } else { exponent_of(nearest) };
        let mantissa = nearest * power_of_two(-size);
        Self {
            mantissa: if *value < IBig::ZERO { -mantissa } else { mantissa },
            exponent: size + dropped as i64,
            exact: bits - zeros <= f64::MANTISSA_DIGITS as usize,
        }
    }

    /// The number times `2^shift`, its size held within `2^±1000`.
    fn scaled(&self, shift: i64) -> f64 {
        self.mantissa * power_of_two((self.exponent + shift).clamp(-1000, 1000))
    }
}

/// The exponent of a normal number.
fn exponent_of(value: f64) -> i64 {
    (value.to_bits() >> 52 & 0x7ff) as i64 - 1023
}

/// `2^exponent` for `|exponent| < 1023`.
fn power_of_two(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

#[cfg(test)]
mod tests;
