//! The two signs that decide every topological question, exactly.
//!
//! A plane enters as four numbers `[nx, ny, nz, d]` that are taken as exact ([`Row`]). [`orient3`] is the sign of the
//! determinant of three normals, [`orient4`] that of four whole rows. Each is answered by the first tier that can:
//!
//! 1. floating point with a proven error bound (`filter`), sides of planes also in twice the precision (`extended`);
//! 2. `i128`, where the rows are small integers (`small_int`): on grids about a fifth of all signs are true zeros;
//! 3. longer integers, always: of three words where the sign is that of a small number (`near_zero`), of a fixed length (`wide`) or, where that does not suffice, of any (`big`).
//!
//! Rows are scaled by exact powers of two (or, for integers, by their greatest common divisor), never normalised to
//! unit length: dividing by a length would destroy exact coincidences.

mod big;
mod counts;
mod extended;
mod filter;
mod near_zero;
mod point;
mod probe;
mod row;
mod small_int;
#[cfg(test)]
mod tests;
mod wide;

use std::cmp::Ordering;

use dashu_int::IBig;

pub use counts::Counts;
pub use row::Row;

pub(crate) use big::homogeneous as homogeneous_exactly;
pub(crate) use extended::{DOUBLE_DOUBLE_BOUND, homogeneous as homogeneous_in_double_doubles, minor};
use filter::cross;
pub(crate) use filter::{Ascent, BEFORE, NEXT, OffsetColumn, Slope};
pub use filter::{Homogeneous, side_left_open};
pub(crate) use point::{ExactPoint, POINT_BOUND, UNDERFLOW, integer_row, residual_with_error, side_of_point};
pub(crate) use probe::{Corner, FaceCorners, Probe};

/// A three-way sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Exactly zero.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of a number; NaN counts as zero.
    #[inline]
    #[must_use]
    pub(crate) fn of<T: PartialOrd + Default + Copy>(value: T) -> Self {
        let zero = T::default();
        if value > zero {
            Self::Positive
        } else if value < zero {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of a big integer.
    pub(crate) fn of_big(value: &IBig) -> Self {
        match value.cmp(&IBig::ZERO) {
            Ordering::Less => Self::Negative,
            Ordering::Equal => Self::Zero,
            Ordering::Greater => Self::Positive,
        }
    }

    /// The sign of the negated quantity.
    #[inline]
    #[must_use]
    pub fn flip(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }

    /// The sign of the product of two quantities.
    #[inline]
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        match self {
            Self::Negative => other.flip(),
            Self::Zero => Self::Zero,
            Self::Positive => other,
        }
    }
}

/// Positive where the normals of `a`, `b`, `c` are a right-handed triple: the sign of `det(nₐ, n_b, n_c)`.
#[inline]
#[must_use]
pub fn orient3(a: &Row, b: &Row, c: &Row) -> Sign {
    counts::note_total();
    match filter::certain_det3(a, b, c) {
        Sign::Zero => orient3_carefully(a, b, c),
        sign => sign,
    }
}

#[cold]
#[inline(never)]
fn orient3_carefully(a: &Row, b: &Row, c: &Row) -> Sign {
    let (value, permanent) = filter::det3(a, b, c);
    if value.abs() > filter::DET3_BOUND * permanent {
        return Sign::of(value);
    }
    if permanent == 0.0 {
        return Sign::Zero;
    }
    if let Some(sign) = small_int::det3(a, b, c, value, permanent) {
        counts::note_small_int();
        return sign;
    }
    counts::note_big();
    big::det3(a, b, c)
}

/// The sign of the 4×4 determinant of the rows `[n | d]` of `a`, `b`, `c`, `h`.
///
/// Where `orient3(a, b, c)` is positive, a **negative** result says that the meeting point of `a`, `b`, `c` lies
/// strictly outside `h` (`n_h·p > d_h`), a positive one that it lies strictly inside, zero that it lies on `h`.
#[must_use]
pub fn orient4(a: &Row, b: &Row, c: &Row, h: &Row) -> Sign {
    Homogeneous::of(a, b, c, OffsetColumn::Finite).side([a, b, c], h, OffsetColumn::Finite).flip()
}

/// The sign of component `axis` (0, 1, 2) of the cross product of the normals, `(n_i × n_j)[axis]`.
#[must_use]
pub fn cross_component(i: &Row, j: &Row, axis: usize) -> Sign {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (p, q) = (i.coefficients()[u] * j.coefficients()[v], i.coefficients()[v] * j.coefficients()[u]);
    counts::note_total();
    // Rounding keeps the order of the two products: where they still differ, that is the sign, without a bound. Both are zero only where a factor of each is.
    if (p != q) | (p == 0.0) {
        return Sign::of(p - q);
    }
    if let Some(sign) = small_int::det2(i, j, [u, v]) {
        counts::note_small_int();
        return sign;
    }
    counts::note_big();
    big::det2(i, j, [u, v])
}
