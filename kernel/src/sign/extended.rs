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
        let (bc, ca, ab) = (loose_minor(b, c, u, v), loose_minor(c, a, u, v), loose_minor(a, b, u, v));
        *numerator = bc.times(a[3]).plus_loosely(ca.times(b[3])).plus_loosely(ab.times(c[3]));
        w = w.plus_loosely(bc.times(a[axis]));
    }
    let [x, y, z] = numerators;
    [x, y, z, w]
}

/// What double-doubles tell of a determinant.
pub(super) enum Found {
    /// Its sign.
    Sign(Sign),
    /// A bound for its magnitude.
    Below(f64),
    /// Nothing, as the low words could underflow.
    Nothing,
}

/// On which side of a plane the meeting point of three others lies, times the sign of `W`; `permanent` is that of the whole determinant.
///
/// It is expanded by the minors of two rows and those of the other two (Laplace). With `u = 2⁻⁵³`, a minor is off by `7u²` of its permanent, a product of two minors by `8u²` of theirs
/// beyond what these are off, and each of five sums by `7u²` of what is added: `57u²` of the permanent in all.
pub(super) fn side([a, b, c]: [&Row; 3], h: &Row, permanent: f64) -> Found {
    // 64 u²
    const SIDE_BOUND: f64 = f64::from_bits((1023 - 100) << 52);
    if !(1e-150..=1e150).contains(&permanent) {
        return Found::Nothing;
    }
    let [a, b, c, h] = [a, b, c, h].map(Row::coefficients);
    let term = |[i, j]: [usize; 2], [k, l]: [usize; 2]| loose_minor(a, b, i, j).times_sum(loose_minor(c, h, k, l));
    // the determinant with its sign turned
    let value = term([0, 2], [1, 3])
        .plus_loosely(term([1, 0], [2, 3]))
        .plus_loosely(term([3, 0], [1, 2]))
        .plus_loosely(term([2, 1], [0, 3]))
        .plus_loosely(term([1, 3], [0, 2]))
        .plus_loosely(term([3, 2], [0, 1]));
    let bound = SIDE_BOUND * permanent;
    if value.high.abs() > bound { Found::Sign(Sign::of(value.high)) } else { Found::Below(2.0 * bound) }
}

/// The same as [`minor`], off by at most `7u²` of the magnitudes of both products, with `u = 2⁻⁵³`.
#[inline(always)]
fn loose_minor(p: &[f64; 4], q: &[f64; 4], u: usize, v: usize) -> DoubleDouble {
    DoubleDouble::product(p[u], q[v]).plus_loosely(DoubleDouble::product(p[v], q[u]).negated())
}

/// The determinant of the columns `u`, `v` of two rows. Inlined, so that each number is split into halves once for all
/// products that it is in.
#[inline(always)]
pub(crate) fn minor(p: &[f64; 4], q: &[f64; 4], u: usize, v: usize) -> DoubleDouble {
    DoubleDouble::product(p[u], q[v]).plus(DoubleDouble::product(p[v], q[u]).negated())
}
