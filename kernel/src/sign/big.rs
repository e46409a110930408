//! The last tier: integers of a fixed length where they suffice ([`wide`](super::wide)), else big integers, always right.

use dashu_int::IBig;

use super::filter::OffsetColumn;
use super::row::decompose;
use super::{Row, Sign, wide};

/// Numbers, such as a row's coefficients, as big integers, up to one positive scale.
pub(crate) fn integers<const N: usize>(row: [f64; N]) -> [IBig; N] {
    let lowest = row.into_iter().filter(|v| *v != 0.0).map(|v| decompose(v).1).min().unwrap_or(0);
    row.map(|v| {
        if v == 0.0 {
            return IBig::ZERO;
        }
        let (mantissa, exponent) = decompose(v);
        IBig::from(mantissa) << (exponent - lowest) as usize
    })
}

/// The sign of a big integer.
pub(crate) fn sign(v: &IBig) -> Sign {
    match v.cmp(&IBig::ZERO) {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

fn of(row: &Row, column: OffsetColumn) -> [IBig; 4] {
    let [x, y, z, _] = *row.coefficients();
    integers([x, y, z, column.of(row)])
}

fn det2_of(a: &[IBig; 4], b: &[IBig; 4], u: usize, v: usize) -> IBig {
    &a[u] * &b[v] - &a[v] * &b[u]
}

/// `n_b × n_c`.
pub(crate) fn cross(b: &[IBig; 4], c: &[IBig; 4]) -> [IBig; 3] {
    [det2_of(b, c, 1, 2), det2_of(b, c, 2, 0), det2_of(b, c, 0, 1)]
}

/// The inner product of a row's normal with a vector.
pub(crate) fn dot(a: &[IBig; 4], v: &[IBig; 3]) -> IBig {
    &a[0] * &v[0] + &a[1] * &v[1] + &a[2] * &v[2]
}

pub(super) fn det2(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Sign {
    wide::det2(i, j, [u, v]).unwrap_or_else(|| det2_of_any(i, j, [u, v]))
}

pub(super) fn det2_of_any(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Sign {
    sign(&det2_of(&integers(*i.coefficients()), &integers(*j.coefficients()), u, v))
}

pub(super) fn det3(a: &Row, b: &Row, c: &Row) -> Sign {
    wide::det3(a, b, c).unwrap_or_else(|| det3_of_any(a, b, c))
}

pub(super) fn det3_of_any(a: &Row, b: &Row, c: &Row) -> Sign {
    let [a, b, c] = [a, b, c].map(|row| of(row, OffsetColumn::Infinite));
    sign(&dot(&a, &cross(&b, &c)))
}

/// The sign of the 4×4 determinant of the rows with the offsets of `column`.
pub(super) fn det4(rows: [&Row; 4], column: OffsetColumn) -> Sign {
    wide::det4(rows, column).unwrap_or_else(|| det4_of_any(rows, column))
}

/// The same whatever the lengths of the coefficients.
pub(super) fn det4_of_any(rows: [&Row; 4], column: OffsetColumn) -> Sign {
    let [a, b, c, h] = rows.map(|row| of(row, column));
    let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let point: [IBig; 3] = std::array::from_fn(|k| &a[3] * &bc[k] + &b[3] * &ca[k] + &c[3] * &ab[k]);
    sign(&(&h[3] * dot(&a, &bc) - dot(&h, &point)))
}

pub(super) fn radial(i: &Row, j: &Row, a: &Row, b: &Row) -> Sign {
    let [i, j, a, b] = [i, j, a, b].map(|row| integers(*row.coefficients()));
    let (p, q) = (cross(&i, &j), cross(&a, &b));
    sign(&(&p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]))
}
