//! Planes that are exactly the same, whatever their scale and side.

use crate::ids::number32;
use std::cmp::Ordering;

use planecut_kernel::sign::Row;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use crate::base::intern;

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

/// The order of rows by their coefficients.
pub(crate) fn compare_coefficients(p: &Row, q: &Row) -> Ordering {
    let pairs = p.coefficients().iter().zip(q.coefficients());
    pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Groups rows that describe the same plane: for each group its side with a positive first coefficient, and the group of
/// each row. Of rows of different scale the least stands for the group, so that the order of the input does not matter.
pub(super) fn group_exactly(rows: &[Row]) -> (Vec<Row>, Vec<u32>) {
    let rows: Vec<Row> = rows.par_iter().with_min_len(1024).map(|row| first_side(row).0).collect();
    let keys: Vec<Key> = rows.par_iter().with_min_len(1024).map(key).collect();
    // spread by the low bits of a ratio
    let spread = |key: &Key| ((key.1[0] ^ key.1[1] >> 7 ^ key.1[2] >> 13) & 0xFFFF) as usize;
    let (different, mut class) = intern(keys.len(), |place| keys[place], 1 << 16, spread, number32);
    let mut groups: Vec<Option<Row>> = vec![None; different.len()];
    // groups that share all numbers with one that was there before
    let mut further: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for (row, class) in rows.iter().zip(&mut class) {
        let same = |group: &u32| groups[*group as usize].is_none_or(|other| other.is_same_plane(row));
        if !same(class) {
            let others = further.entry(*class).or_default();
            *class = others.iter().copied().find(same).unwrap_or_else(|| {
                others.push(number32(groups.len()));
                groups.push(None);
                number32(groups.len()) - 1
            });
        }
        let least = groups[*class as usize].get_or_insert(*row);
        if compare_coefficients(row, least).is_lt() {
            *least = *row;
        }
    }
    (groups.into_iter().flatten().collect(), class)
}
