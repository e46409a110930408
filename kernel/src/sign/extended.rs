//! The tier of double-double numbers: the meeting point of three planes in twice the working precision.

use super::{Row, Sign};
use crate::arithmetic::DoubleDouble;

/// Relative error of the double-double evaluation, in units of the permanent. Each term passes at most 12 operations of
/// relative error `2⁻¹⁰²`, and a product of permanents leaves room.
pub(crate) const DOUBLE_DOUBLE_BOUND: f64 = f64::from_bits((1023 - 97) << 52);

/// `(X, Y, Z, W)` of a meeting point, each with an error of at most [`DOUBLE_DOUBLE_BOUND`] times its permanent.
pub(crate) fn homogeneous(planes: [&Row; 3]) -> [DoubleDouble; 4] {
    let [a, b, c] = planes.map(Row::coefficients);
    let mut w = DoubleDouble::default();
    let mut numerators = [DoubleDouble::default(); 3];
    for (axis, numerator) in numerators.iter_mut().enumerate() {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (bc, ca, ab) = (minor(b, c, u, v), minor(c, a, u, v), minor(a, b, u, v));
        *numerator = bc.times(a[3]).plus(ca.times(b[3])).plus(ab.times(c[3]));
        w = w.plus(bc.times(a[axis]));
    }
    let [x, y, z] = numerators;
    [x, y, z, w]
}

/// On which side of a plane the meeting point of three others lies, times the sign of `W`, where double-doubles decide it;
/// `permanent` is that of the whole determinant.
///
/// The coordinates are off by [`DOUBLE_DOUBLE_BOUND`] of their permanents, and seven operations follow.
pub(super) fn certain_side(planes: [&Row; 3], h: &Row, permanent: f64) -> Option<Sign> {
    const SIDE_BOUND: f64 = 1.5 * DOUBLE_DOUBLE_BOUND;
    // outside this range the low words could underflow
    if !(1e-150..=1e150).contains(&permanent) {
        return None;
    }
    let [x, y, z, w] = homogeneous(planes);
    let [a, b, c, d] = *h.coefficients();
    let value = x.times(a).plus(y.times(b)).plus(z.times(c)).plus(w.times(-d));
    (value.high.abs() > SIDE_BOUND * permanent).then(|| Sign::of(value.high))
}

/// The determinant of the columns `u`, `v` of two rows. Inlined, so that each number is split into halves once for all
/// products that it is in.
#[inline(always)]
pub(crate) fn minor(p: &[f64; 4], q: &[f64; 4], u: usize, v: usize) -> DoubleDouble {
    DoubleDouble::product(p[u], q[v]).plus(DoubleDouble::product(p[v], q[u]).negated())
}
