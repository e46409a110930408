//! Determinants that are known to be small, as integers of three words: what their terms have beyond these cancels.
//!
//! Rows are scaled to integers by powers of two, and so is the column of offsets. The determinant is then summed modulo `2¹⁹²`, which tells its
//! sign where it is known to be below half of that, however long its terms are.

use super::filter::{BEFORE, NEXT};
use super::{Row, Sign};
use crate::arithmetic::{decompose, exponent};

/// Normal components are below two to this power, so that a product of two fits `i128`, and a sum of two such.
const NORMAL_BITS: i32 = 62;

/// Offsets are below two to this power.
const OFFSET_BITS: i32 = 126;

/// Determinants are below two to this power.
const DETERMINANT_BITS: i32 = 190;

/// An integer modulo `2¹⁹²`.
#[derive(Debug, Clone, Copy)]
struct Residue {
    low: u128,
    high: u64,
}

impl Residue {
    const ZERO: Self = Self { low: 0, high: 0 };

    fn of(value: i128) -> Self {
        Self { low: value as u128, high: (value >> 127) as u64 }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { low, high: self.high.wrapping_add(other.high).wrapping_add(u64::from(carry)) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        let (low, borrow) = self.low.overflowing_sub(other.low);
        Self { low, high: self.high.wrapping_sub(other.high).wrapping_sub(u64::from(borrow)) }
    }

    /// Times `2⁶⁴`.
    #[inline(always)]
    fn shifted(self) -> Self {
        Self { low: self.low << 64, high: (self.low >> 64) as u64 }
    }

    #[inline(always)]
    fn times_word(self, factor: u64) -> Self {
        let factor = u128::from(factor);
        let first = u128::from(self.low as u64) * factor;
        let second = (self.low >> 64) * factor + (first >> 64);
        let high = self.high.wrapping_mul(factor as u64).wrapping_add((second >> 64) as u64);
        Self { low: second << 64 | u128::from(first as u64), high }
    }

    /// A negative factor counts as larger by two to the power of its bits, until that much is taken off.
    #[inline(always)]
    fn times_i64(self, factor: i64) -> Self {
        let excess = if factor < 0 { self.shifted() } else { Self::ZERO };
        self.times_word(factor as u64).minus(excess)
    }

    #[inline(always)]
    fn times_i128(self, factor: i128) -> Self {
        let shifted = self.shifted();
        let excess = if factor < 0 { shifted.shifted() } else { Self::ZERO };
        self.times_word(factor as u64).plus(shifted.times_word((factor >> 64) as u64)).minus(excess)
    }

    /// The sign of the number of the smallest magnitude.
    fn sign(self) -> Sign {
        if self.high >> 63 == 1 {
            Sign::Negative
        } else if self.high == 0 && self.low == 0 {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }
}

/// A row up to a power of two, and its offset up to another.
#[derive(Clone, Copy)]
struct Integers {
    normal: [i64; 3],
    offset: i128,
}

/// The rows as integers, and the exponent of the determinant's unit.
fn integers(rows: [&Row; 4]) -> Option<([Integers; 4], i32)> {
    let parts = rows.map(|row| row.coefficients().map(decompose));
    let mut units = [0; 4];
    for ([normal @ .., _], unit) in parts.iter().zip(&mut units) {
        *unit = normal.iter().filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| *exponent).min()?;
    }
    let offsets = parts.iter().zip(units).map(|([.., offset], unit)| (offset.0, offset.1 - unit));
    // where all are zero, the unit is any
    let unit_of_offsets =
        offsets.filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| exponent).min().unwrap_or(0);
    let mut found = [Integers { normal: [0; 3], offset: 0 }; 4];
    for ((found, [normal @ .., offset]), unit) in found.iter_mut().zip(&parts).zip(units) {
        for (component, part) in found.normal.iter_mut().zip(normal) {
            *component = part.0 << shift(part, unit, NORMAL_BITS)?;
        }
        found.offset = i128::from(offset.0) << shift(offset, unit + unit_of_offsets, OFFSET_BITS)?;
    }
    Some((found, units.into_iter().sum::<i32>() + unit_of_offsets))
}

/// By how many bits a mantissa is shifted to count units; nothing where it would have more bits than it may.
fn shift((mantissa, exponent): &(i64, i32), unit: i32, bits: i32) -> Option<i32> {
    let shift = if *mantissa == 0 { 0 } else { exponent - unit };
    (shift <= bits - f64::MANTISSA_DIGITS as i32).then_some(shift)
}

/// On which side of `h` the meeting point of three planes lies, times the sign of `W`, of which it is known that its magnitude is at most
/// `bound`; nothing where the numbers are too long.
pub(super) fn side([a, b, c]: [&Row; 3], h: &Row, bound: f64) -> Option<Sign> {
    let ([a, b, c, h], unit) = integers([a, b, c, h])?;
    if exponent(bound) + 1 - unit > DETERMINANT_BITS {
        return None;
    }
    // Laplace's expansion by the minors of two rows and those of the other two; of each pair of minors one has the offsets
    let normal = |p: &Integers, q: &Integers, axis: usize| {
        let product = |i: usize, j: usize| i128::from(p.normal[i]) * i128::from(q.normal[j]);
        product(BEFORE[axis], NEXT[axis]) - product(NEXT[axis], BEFORE[axis])
    };
    let offset = |p: &Integers, q: &Integers, axis: usize| {
        Residue::of(q.offset).times_i64(p.normal[axis]).minus(Residue::of(p.offset).times_i64(q.normal[axis]))
    };
    let term = |axis: usize| {
        let one = offset(&c, &h, axis).times_i128(normal(&a, &b, axis));
        one.plus(offset(&a, &b, axis).times_i128(normal(&c, &h, axis)))
    };
    Some(term(0).plus(term(1)).plus(term(2)).sign())
}
