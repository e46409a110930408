//! Big integers: exact vectors and what is made of them.

use dashu_int::IBig;

use super::float::decompose;

/// Numbers, such as a row's coefficients, as big integers, up to one positive scale.
pub(crate) fn big_integers<const N: usize>(row: [f64; N]) -> [IBig; N] {
    let lowest = row.into_iter().filter(|v| *v != 0.0).map(|v| decompose(v).1).min().unwrap_or(0);
    row.map(|v| {
        if v == 0.0 {
            return IBig::ZERO;
        }
        let (mantissa, exponent) = decompose(v);
        IBig::from(mantissa) << (exponent - lowest) as usize
    })
}

/// The cross product of two normals, `n_b × n_c`.
pub(crate) fn big_cross(b: &[IBig; 4], c: &[IBig; 4]) -> [IBig; 3] {
    let minor = |u: usize, v: usize| &b[u] * &c[v] - &b[v] * &c[u];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The inner product of a row's normal with a vector.
pub(crate) fn big_dot(a: &[IBig; 4], v: &[IBig; 3]) -> IBig {
    &a[0] * &v[0] + &a[1] * &v[1] + &a[2] * &v[2]
}
