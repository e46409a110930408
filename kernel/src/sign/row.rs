//! A plane's coefficients, prepared for signs.

use crate::arithmetic::{exact_product, exponent, lowest_bit};
use crate::half_space::HalfSpace;

/// Integer rows keep every coefficient below two to this power. Longer ones would not fit the integer tier anyway, and
/// decimal numbers, which nearly all use their 53 bits, are told from integers at the first coefficient.
const MAX_INTEGER_BITS: i32 = 48;

/// The exact coefficients `[nx, ny, nz, d]` of a plane, up to one positive scale.
///
/// # Guarantees
/// Where the coefficients are integers below 2⁴⁸ up to a power of two, they are stored as integers without a common
/// divisor; otherwise the largest normal component lies in `[1, 2)`. Either way the stored row is an exact positive
/// multiple of the plane it was made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    half_space: HalfSpace,
    /// Bit length of the largest normal component and of the offset where the row is integer, else [`NOT_INTEGER`].
    bits: [u8; 2],
    at_infinity: bool,
    /// The largest magnitude in the normal, rounded up.
    magnitude: f32,
}

const NOT_INTEGER: u8 = u8::MAX;

impl Row {
    /// Prepares the coefficients of a half-space.
    #[inline]
    #[must_use]
    pub fn new(half_space: &HalfSpace) -> Self {
        let n = half_space.normal();
        // `+ 0.0` turns a negative zero into zero, so that equal rows are equal bit for bit.
        let coefficients = [n.x + 0.0, n.y + 0.0, n.z + 0.0, half_space.offset() + 0.0];
        // Decimal numbers mostly use the last bits of the mantissa, which no integer below the limit does.
        let used = coefficients.into_iter().fold(0, |bits, v| bits | v.to_bits());
        if used & ((1 << (53 - MAX_INTEGER_BITS)) - 1) == 0 {
            Self::short(coefficients)
        } else {
            Self::scaled(coefficients)
        }
    }

    /// Prepares coefficients that may be integers.
    #[inline(never)]
    fn short(coefficients: [f64; 4]) -> Self {
        match integer_row(coefficients) {
            Some(integers) => Self::from_integers(integers),
            None => Self::scaled(coefficients),
        }
    }

    /// Scaled by a power of two so that the largest normal component lies in `[1, 2)`.
    #[inline(always)]
    fn scaled(coefficients: [f64; 4]) -> Self {
        let largest = largest_of_normal(&coefficients);
        let power = -exponent(largest);
        debug_assert!(power.abs() <= 1022);
        let factor = f64::from_bits(((1023 + power) as u64) << 52);
        let magnitude = above(largest * factor);
        let half_space = HalfSpace::of_valid(coefficients.map(|v| v * factor));
        Self { half_space, bits: [NOT_INTEGER; 2], at_infinity: false, magnitude }
    }

    /// A plane whose offset is the symbolic `M → ∞`; its finite offset is zero.
    pub(crate) fn infinity(normal: [i64; 3]) -> Self {
        Self { at_infinity: true, ..Self::from_integers([normal[0], normal[1], normal[2], 0]) }
    }

    fn from_integers(integers: [i64; 4]) -> Self {
        let length = |v: i64| (64 - v.unsigned_abs().leading_zeros()) as u8;
        let normal = length(integers[0]).max(length(integers[1])).max(length(integers[2]));
        let coefficients = integers.map(|v| v as f64);
        let magnitude = above(largest_of_normal(&coefficients));
        let half_space = HalfSpace::of_valid(coefficients);
        Self { half_space, bits: [normal, length(integers[3])], at_infinity: false, magnitude }
    }

    /// At least the largest magnitude in the normal, and hardly more.
    #[inline]
    pub(super) fn magnitude(&self) -> f64 {
        f64::from(self.magnitude)
    }

    /// The same in single precision.
    #[inline(always)]
    pub(crate) fn magnitude_f32(&self) -> f32 {
        self.magnitude
    }

    /// The scaled coefficients `[nx, ny, nz, d]`.
    #[inline]
    #[must_use]
    pub fn coefficients(&self) -> &[f64; 4] {
        self.half_space.coefficients()
    }

    /// The half-space of the scaled coefficients: that which the row was made from, up to a positive factor.
    #[inline]
    #[must_use]
    pub fn half_space(&self) -> &HalfSpace {
        &self.half_space
    }

    /// The row of the opposite half-space.
    #[inline]
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self { half_space: HalfSpace::of_valid(self.coefficients().map(|v| 0.0 - v)), ..*self }
    }

    /// Whether the rows describe one plane, up to any scale, positive or negative: all 2×2 minors are zero.
    #[must_use]
    pub fn is_same_plane(&self, other: &Self) -> bool {
        let (a, b) = (self.coefficients(), other.coefficients());
        (0..4).all(|i| (i + 1..4).all(|j| exact_product(a[i], b[j]) == exact_product(a[j], b[i])))
    }

    /// Numbers that equal planes share, whatever the scale and side of their rows: the index of the first coefficient that
    /// is not zero, and the others divided by it. Division rounds correctly, so equal ratios give equal numbers.
    #[must_use]
    pub fn ratios(&self) -> (usize, [f64; 3]) {
        let c = self.coefficients();
        let first = if c[0] != 0.0 {
            0
        } else if c[1] != 0.0 {
            1
        } else {
            2
        };
        let rest: [usize; 3] = std::array::from_fn(|k| if k < first { k } else { k + 1 });
        (first, rest.map(|k| c[k] / c[first] + 0.0))
    }

    /// Whether all coefficients are integers (below 2⁴⁸), coprime.
    #[inline]
    pub(crate) fn is_integer(&self) -> bool {
        self.bits[0] != NOT_INTEGER
    }

    /// The bit length of the largest normal component where all coefficients are (coprime) integers below 2⁴⁸.
    #[inline]
    #[must_use]
    pub fn integer_bits(&self) -> Option<u32> {
        self.is_integer().then(|| self.bits()[0])
    }

    /// Bit lengths of the largest normal component and of the offset; only for integer rows.
    #[inline]
    pub(super) fn bits(&self) -> [u32; 2] {
        [u32::from(self.bits[0]), u32::from(self.bits[1])]
    }

    /// The coefficients as integers; only for integer rows.
    #[inline]
    pub(super) fn integers(&self) -> [i128; 4] {
        self.coefficients().map(|v| v as i128)
    }

    #[inline]
    pub(crate) fn is_at_infinity(&self) -> bool {
        self.at_infinity
    }
}

/// The coefficients as coprime integers below 2⁴⁸, where they are such up to a power of two.
fn integer_row(coefficients: [f64; 4]) -> Option<[i64; 4]> {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for v in coefficients {
        // without a branch: any of them may be zero
        let is_zero = v == 0.0;
        lowest = lowest.min(if is_zero { i32::MAX } else { lowest_bit(v) });
        highest = highest.max(if is_zero { i32::MIN } else { exponent(v) });
    }
    if highest - lowest >= MAX_INTEGER_BITS {
        return None;
    }
    let integers = coefficients.map(|v| scale(v, -lowest));
    debug_assert!(integers.iter().all(|v| v.fract() == 0.0));
    let integers = integers.map(|v| v as i64);
    // one of them is odd, so that no power of two among them has a divisor with all others
    if integers.into_iter().fold(false, |is_power, v| is_power | v.unsigned_abs().is_power_of_two()) {
        return Some(integers);
    }
    let divisor = integers.into_iter().fold(0, |g, v| if g == 1 { 1 } else { gcd(g, v.unsigned_abs()) }) as i64;
    if divisor == 1 {
        return Some(integers);
    }
    Some(integers.map(|v| v / divisor))
}

#[inline(always)]
fn largest_of_normal(coefficients: &[f64; 4]) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    larger(larger(coefficients[0].abs(), coefficients[1].abs()), coefficients[2].abs())
}

/// A number in single precision that is not below a positive one: the nearest lies at most half a step below.
#[inline(always)]
fn above(v: f64) -> f32 {
    f32::from_bits((v as f32).to_bits() + 1)
}

/// `v · 2^power`, exact while neither side under- or overflows, which the accepted coefficient range ensures.
fn scale(v: f64, power: i32) -> f64 {
    debug_assert!(power.abs() <= 1022);
    v * f64::from_bits(((1023 + power) as u64) << 52)
}

fn gcd(mut a: u64, mut b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let shift = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    while b != 0 {
        b >>= b.trailing_zeros();
        if a > b {
            std::mem::swap(&mut a, &mut b);
        }
        b -= a;
    }
    a << shift
}
