//! The last tier: integers of a fixed length where they suffice ([`wide`](super::wide)), else big integers, always right.

use dashu_int::IBig;

use super::filter::OffsetColumn;
use super::{Row, Sign, wide};
use crate::arithmetic::{big_cross, big_dot, big_integers};

fn of(row: &Row, column: OffsetColumn) -> [IBig; 4] {
    let [x, y, z, _] = *row.coefficients();
    big_integers([x, y, z, column.of(row)])
}

pub(super) fn det2(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Sign {
    wide::det2(i, j, [u, v]).unwrap_or_else(|| det2_of_any(i, j, [u, v]))
}

pub(super) fn det2_of_any(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Sign {
    let (p, q) = (big_integers(*i.coefficients()), big_integers(*j.coefficients()));
    Sign::of_big(&(&p[u] * &q[v] - &p[v] * &q[u]))
}

pub(super) fn det3(a: &Row, b: &Row, c: &Row) -> Sign {
    wide::det3(a, b, c).unwrap_or_else(|| det3_of_any(a, b, c))
}

pub(super) fn det3_of_any(a: &Row, b: &Row, c: &Row) -> Sign {
    let [a, b, c] = [a, b, c].map(|row| of(row, OffsetColumn::Infinite));
    Sign::of_big(&big_dot(&a, &big_cross(&b, &c)))
}

/// The sign of the 4×4 determinant of the rows with the offsets of `column`.
pub(super) fn det4(rows: [&Row; 4], column: OffsetColumn) -> Sign {
    wide::det4(rows, column).unwrap_or_else(|| det4_of_any(rows, column))
}

/// The same whatever the lengths of the coefficients.
pub(super) fn det4_of_any(rows: [&Row; 4], column: OffsetColumn) -> Sign {
    let [a, b, c, h] = rows.map(|row| of(row, column));
    let (bc, ca, ab) = (big_cross(&b, &c), big_cross(&c, &a), big_cross(&a, &b));
    let point: [IBig; 3] = std::array::from_fn(|k| &a[3] * &bc[k] + &b[3] * &ca[k] + &c[3] * &ab[k]);
    Sign::of_big(&(&h[3] * big_dot(&a, &bc) - big_dot(&h, &point)))
}

/// `(X, Y, Z, W)` of a meeting point, exactly, up to one positive scale.
pub(crate) fn homogeneous(planes: [&Row; 3]) -> [IBig; 4] {
    let [a, b, c] = planes.map(|row| big_integers(*row.coefficients()));
    let (bc, ca, ab) = (big_cross(&b, &c), big_cross(&c, &a), big_cross(&a, &b));
    let coordinate = |k: usize| &a[3] * &bc[k] + &b[3] * &ca[k] + &c[3] * &ab[k];
    [coordinate(0), coordinate(1), coordinate(2), big_dot(&a, &bc)]
}
