//! On which side of a plane a point of three numbers lies, and points in big integers.

use dashu_int::IBig;
use glam::DVec3;

use super::{Row, Sign};
use crate::arithmetic::{big_integers, round_quotient};

const U: f64 = f64::EPSILON / 2.0;
/// `n·p − d` for a given point: a product and three sums, 4 roundings a term, with room for those of the permanent.
pub(crate) const POINT_BOUND: f64 = 8.0 * U;
/// Products of a coordinate below the normal range can lose this much each, and rows are at most 2⁵³ in size.
pub(crate) const UNDERFLOW: f64 = 1e-300;

/// A point `(X, Y, Z) / W` with `W > 0`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ExactPoint(pub(crate) [IBig; 4]);

impl ExactPoint {
    /// A finite point as it is.
    pub(crate) fn of(point: DVec3) -> Self {
        Self(big_integers([point.x, point.y, point.z, 1.0]))
    }

    /// `n·(X, Y, Z) − d·W` for an exact row.
    pub(crate) fn residual(&self, row: &[IBig; 4]) -> IBig {
        let [x, y, z, w] = &self.0;
        &row[0] * x + &row[1] * y + &row[2] * z - &row[3] * w
    }

    /// The point with each coordinate correctly rounded.
    pub(crate) fn rounded(&self) -> DVec3 {
        let [x, y, z, w] = &self.0;
        DVec3::new(round_quotient(x.clone(), w), round_quotient(y.clone(), w), round_quotient(z.clone(), w))
    }
}

/// A row as integers, up to one positive scale.
pub(crate) fn integer_row(row: &Row) -> [IBig; 4] {
    big_integers(*row.coefficients())
}

/// `n·p − d` with the error that it can have.
pub(crate) fn residual_with_error(row: &Row, point: DVec3) -> (f64, f64) {
    let [x, y, z, d] = *row.coefficients();
    let terms = [x * point.x, y * point.y, z * point.z];
    let value = terms[0] + terms[1] + terms[2] - d;
    let permanent = terms[0].abs() + terms[1].abs() + terms[2].abs() + d.abs();
    (value, POINT_BOUND * permanent + UNDERFLOW)
}

/// On which side of a plane a finite point lies, exactly: positive is outside.
pub(crate) fn side_of_point(row: &Row, point: DVec3) -> Sign {
    const EXACT: f64 = (1u64 << 52) as f64 * POINT_BOUND;
    let (value, error) = residual_with_error(row, point);
    if value.abs() > error {
        return Sign::of(value);
    }
    // Integers below 2⁵² are added up without rounding.
    if error < EXACT && row.is_integer() && point == point.trunc() {
        return Sign::of(value);
    }
    Sign::of_big(&ExactPoint::of(point).residual(&integer_row(row)))
}
