//! Points, planes and quotients in big integers, for what the filters leave open.

use dashu_int::{IBig, UBig, ops::BitTest, ops::SquareRoot};
use glam::DVec3;

use crate::meet::{ldexp, round_quotient};
use crate::sign::{Row, Sign, big_integers, big_sign};

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
    big_sign(&ExactPoint::of(point).residual(&integer_row(row)))
}

/// The unit vector along a vector of integers, each component accurate to a few roundings; zero for the zero vector.
pub(crate) fn unit(vector: &[IBig; 3]) -> DVec3 {
    // Below the leading 100 bits of the longest component everything lies far below its last place.
    let surplus = vector.iter().map(|v| v.bit_len()).max().unwrap_or(0).saturating_sub(100);
    let [x, y, z] = [0, 1, 2].map(|k| i128::try_from(&vector[k] >> surplus).unwrap_or_default() as f64);
    DVec3::new(x, y, z).normalize_or_zero()
}

/// `√(numerator / denominator)`, correctly rounded, of a quotient that is not negative.
pub(crate) fn square_root_of_quotient(numerator: &IBig, denominator: &IBig) -> f64 {
    if numerator.is_zero() {
        return 0.0;
    }
    let (numerator, denominator): (UBig, UBig) = (numerator.clone().into_parts().1, denominator.clone().into_parts().1);
    // A quotient of 132 bits or more has a root of at least 66, whose last bit is made sticky.
    let shift = 132 + denominator.bit_len() as i64 - numerator.bit_len() as i64;
    let shift = shift + (shift & 1);
    let (scaled, divisor) = if shift >= 0 {
        (numerator << shift as usize, denominator)
    } else {
        (numerator, denominator << (-shift) as usize)
    };
    let quotient = &scaled / &divisor;
    let mut root: UBig = quotient.sqrt();
    if &root * &root != quotient || &quotient * &divisor != scaled {
        root |= UBig::ONE;
    }
    ldexp(u128::try_from(root).unwrap_or(u128::MAX) as f64, -(shift / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_roots_of_squares_and_of_two() {
        assert_eq!(square_root_of_quotient(&IBig::from(49), &IBig::from(4)), 3.5);
        assert_eq!(square_root_of_quotient(&IBig::from(2), &IBig::from(1)), std::f64::consts::SQRT_2);
        assert_eq!(square_root_of_quotient(&IBig::from(1), &(IBig::from(1) << 400)), 2f64.powi(-200));
    }
}
