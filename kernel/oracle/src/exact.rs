//! Plane coefficients as big integers, and determinants straight from their definition.

use std::array::from_fn;

use dashu_int::{IBig, Sign as BigSign};

/// `[nx, ny, nz, d]` of the half-space `n·x ≤ d`.
pub type Coefficients = [f64; 4];

/// The row times one power of two that makes all four coefficients integers. A positive factor
/// changes no sign, no point and (being positive for each `εᵢ` alone) no perturbed order.
///
/// # Panics
/// Where a coefficient is not finite.
#[must_use]
pub fn integer_row(c: Coefficients) -> [IBig; 4] {
    let parts = c.map(mantissa_and_exponent);
    let lowest = parts.iter().filter(|(m, _)| *m != 0).map(|&(_, e)| e).min().unwrap_or(0);
    parts.map(|(m, e)| if m == 0 { IBig::ZERO } else { IBig::from(m) << (e - lowest) as usize })
}

/// `value = m · 2^e` with odd `m`, or `(0, 0)`; read from the bits of the float.
fn mantissa_and_exponent(value: f64) -> (i64, i32) {
    assert!(value.is_finite());
    let bits = value.to_bits();
    let field = ((bits >> 52) & 0x7FF) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (magnitude, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    if magnitude == 0 {
        return (0, 0);
    }
    let shift = magnitude.trailing_zeros();
    let odd = magnitude >> shift;
    (if bits >> 63 == 1 { -odd } else { odd }, exponent + shift as i32)
}

/// -1, 0 or 1.
#[must_use]
pub fn sign(value: &IBig) -> i32 {
    match (value.is_zero(), value.sign()) {
        (true, _) => 0,
        (_, BigSign::Negative) => -1,
        (_, BigSign::Positive) => 1,
    }
}

/// The first three entries of a row.
#[must_use]
pub fn normal(row: &[IBig; 4]) -> [IBig; 3] {
    from_fn(|i| row[i].clone())
}

/// `a · b`.
#[must_use]
pub fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// `a × b`.
#[must_use]
pub fn cross(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// Determinant with rows `a, b, c`.
#[must_use]
pub fn det3(a: &[IBig; 3], b: &[IBig; 3], c: &[IBig; 3]) -> IBig {
    dot(a, &cross(b, c))
}

/// Determinant of four rows, expanded along the last column.
#[must_use]
pub fn det4(rows: [&[IBig; 4]; 4]) -> IBig {
    let n = rows.map(normal);
    (0..4).fold(IBig::ZERO, |sum, i| {
        let rest: Vec<usize> = (0..4).filter(|&j| j != i).collect();
        let term = &rows[i][3] * det3(&n[rest[0]], &n[rest[1]], &n[rest[2]]);
        if (i + 3) % 2 == 0 { sum + term } else { sum - term }
    })
}

#[test]
fn rows_keep_their_ratios() {
    let row = integer_row([0.75, -3.0, 0.0, 1.0]);
    assert_eq!(row, [3, -12, 0, 4].map(IBig::from));
    let tiny = integer_row([f64::MIN_POSITIVE, -f64::from_bits(1), -0.0, 0.0]);
    assert_eq!(tiny, [1i64 << 52, -1, 0, 0].map(IBig::from));
}

#[test]
fn determinants_of_known_matrices() {
    let diagonal: [[IBig; 4]; 4] = from_fn(|i| from_fn(|j| IBig::from(if i == j { i + 2 } else { 0 })));
    assert_eq!(det4([&diagonal[0], &diagonal[1], &diagonal[2], &diagonal[3]]), IBig::from(2 * 3 * 4 * 5));
    assert_eq!(det4([&diagonal[1], &diagonal[0], &diagonal[2], &diagonal[3]]), IBig::from(-2 * 3 * 4 * 5));
    // Vandermonde: det[xᵢ^j] = Π (x_j - x_i) over i < j.
    let v: [[IBig; 4]; 4] = [2i64, 3, 5, 11].map(|x| from_fn(|j| IBig::from(x).pow(j)));
    let product: i64 = [3 - 2, 5 - 2, 11 - 2, 5 - 3, 11 - 3, 11 - 5].iter().product();
    assert_eq!(det4([&v[0], &v[1], &v[2], &v[3]]), IBig::from(product));
}
