//! Integers of a fixed number of words: what big integers do without allocating, where the coefficients of each row
//! lie within 2¹²⁵ of one another.
//!
//! Each function gives `None` where they do not.

use super::filter::{BEFORE, NEXT, OffsetColumn};
use super::{Row, Sign};
use crate::arithmetic::{decompose, exponent, lowest_bit};

/// A row's coefficients are below two to this power, so that two words hold them, and eight a 4×4 determinant: 24 products
/// of four.
const COEFFICIENT_BITS: i32 = 125;

/// An integer in two's complement, the lowest word first.
#[derive(Debug, Clone, Copy)]
struct Wide<const WORDS: usize>([u64; WORDS]);

impl<const WORDS: usize> Wide<WORDS> {
    fn is_negative(&self) -> bool {
        self.0[WORDS - 1] >> 63 == 1
    }

    fn sign(&self) -> Sign {
        if self.is_negative() {
            Sign::Negative
        } else if self.0.iter().all(|word| *word == 0) {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    fn plus(mut self, other: &Self) -> Self {
        let mut carry = false;
        for (word, other) in self.0.iter_mut().zip(other.0) {
            let (sum, first) = word.overflowing_add(other);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            (*word, carry) = (sum, first || second);
        }
        self
    }

    fn minus(mut self, other: &Self) -> Self {
        subtract(&mut self.0, &other.0);
        self
    }

    /// The product with an integer of two words; it has two words more than this one.
    #[inline(always)]
    fn times<const PRODUCT: usize>(&self, other: &Wide<2>) -> Wide<PRODUCT> {
        const { assert!(PRODUCT == WORDS + 2) };
        let mut product = [0; PRODUCT];
        for (j, b) in other.0.into_iter().enumerate() {
            let mut carry = 0;
            for (i, a) in self.0.into_iter().enumerate() {
                // the largest sum of these is the largest value of two words
                let sum = u128::from(a) * u128::from(b) + u128::from(product[i + j]) + u128::from(carry);
                (product[i + j], carry) = (sum as u64, (sum >> 64) as u64);
            }
            product[WORDS + j] = carry;
        }
        // so far, negative factors counted as larger by two to the power of their bits
        if self.is_negative() {
            subtract(&mut product[WORDS..], &other.0);
        }
        if other.is_negative() {
            subtract(&mut product[2..], &self.0);
        }
        Wide(product)
    }
}

fn subtract(from: &mut [u64], other: &[u64]) {
    let mut borrow = false;
    for (word, other) in from.iter_mut().zip(other) {
        let (difference, first) = word.overflowing_sub(*other);
        let (difference, second) = difference.overflowing_sub(u64::from(borrow));
        (*word, borrow) = (difference, first || second);
    }
}

/// A row up to a power of two.
type Coefficients = [Wide<2>; 4];

fn coefficients(row: &Row, column: OffsetColumn) -> Option<Coefficients> {
    let [x, y, z, _] = *row.coefficients();
    let values = [x, y, z, column.of(row)];
    let present = || values.into_iter().filter(|v| *v != 0.0);
    let lowest = present().map(lowest_bit).min()?;
    let highest = present().map(exponent).max()?;
    (highest - lowest < COEFFICIENT_BITS).then(|| {
        values.map(|v| {
            if v == 0.0 {
                return Wide([0; 2]);
            }
            let (mantissa, unit) = decompose(v);
            let (mantissa, shift) = (i128::from(mantissa), unit - lowest);
            // what is shifted out is zero: no bit of the value lies below `lowest`
            let integer = if shift < 0 { mantissa >> -shift } else { mantissa << shift } as u128;
            Wide([integer as u64, (integer >> 64) as u64])
        })
    })
}

fn cross(p: &Coefficients, q: &Coefficients) -> [Wide<4>; 3] {
    std::array::from_fn(|k| p[NEXT[k]].times(&q[BEFORE[k]]).minus(&p[BEFORE[k]].times(&q[NEXT[k]])))
}

/// The inner product of a row's normal with a vector.
fn dot<const WORDS: usize, const PRODUCT: usize>(row: &Coefficients, vector: &[Wide<WORDS>; 3]) -> Wide<PRODUCT> {
    let [x, y, z] = [0, 1, 2].map(|k| vector[k].times(&row[k]));
    x.plus(&y).plus(&z)
}

/// The sign of the 2×2 determinant of the columns `u`, `v` of two normals.
pub(super) fn det2(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Option<Sign> {
    let [i, j] = [coefficients(i, OffsetColumn::Infinite)?, coefficients(j, OffsetColumn::Infinite)?];
    Some(i[u].times::<4>(&j[v]).minus(&i[v].times(&j[u])).sign())
}

/// The sign of `det(nₐ, n_b, n_c)`.
pub(super) fn det3(a: &Row, b: &Row, c: &Row) -> Option<Sign> {
    let of = |row| coefficients(row, OffsetColumn::Infinite);
    let (a, b, c) = (of(a)?, of(b)?, of(c)?);
    Some(dot::<4, 6>(&a, &cross(&b, &c)).sign())
}

/// The sign of the 4×4 determinant of the rows with the offsets of `column`.
pub(super) fn det4([a, b, c, h]: [&Row; 4], column: OffsetColumn) -> Option<Sign> {
    let of = |row| coefficients(row, column);
    let (a, b, c, h) = (of(a)?, of(b)?, of(c)?, of(h)?);
    let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let point = |k: usize| bc[k].times(&a[3]).plus(&ca[k].times(&b[3])).plus(&ab[k].times(&c[3]));
    let weight: Wide<6> = dot(&a, &bc);
    let side: Wide<8> = dot::<6, 8>(&h, &[point(0), point(1), point(2)]);
    Some(weight.times::<8>(&h[3]).minus(&side).sign())
}
