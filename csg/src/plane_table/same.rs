//! Planes that are exactly the same, whatever their scale and side.

use std::cmp::Ordering;

use planecut_kernel::sign::Row;

use crate::base::sortable;

/// Planes whose normal has coprime integer components of at most this many bits are exact and never snapped onto others:
/// what went through rotations or decimal text is hardly ever that short.
const EXACT_BITS: u32 = 36;

/// Numbers that equal planes share.
pub(crate) type Key = (usize, [u64; 3]);

pub(crate) fn key(row: &Row) -> Key {
    let (first, ratios) = row.ratios();
    (first, ratios.map(f64::to_bits))
}

/// Whether a plane is surely meant as it is.
#[inline]
pub(crate) fn is_exact(row: &Row) -> bool {
    row.integer_bits().is_some_and(|bits| bits <= EXACT_BITS)
}

/// Whether the first coefficient of the normal that is not zero is negative.
#[inline]
pub(crate) fn is_reversed(row: &Row) -> bool {
    row.coefficients().iter().find(|v| **v != 0.0).is_some_and(|v| *v < 0.0)
}

/// The side of a plane with a positive first coefficient, and whether that is the other one.
pub(crate) fn first_side(row: &Row) -> (Row, bool) {
    let reversed = is_reversed(row);
    (if reversed { row.flipped() } else { *row }, reversed)
}

/// By what planes are put in the order in which they are kept or taken for one before: exact ones first, then by their coefficients.
pub(crate) fn settling_order(row: &Row) -> (bool, [u64; 4]) {
    (!is_exact(row), row.coefficients().map(sortable))
}

/// The order of rows by their coefficients.
pub(crate) fn compare_coefficients(p: &Row, q: &Row) -> Ordering {
    let pairs = p.coefficients().iter().zip(q.coefficients());
    pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
