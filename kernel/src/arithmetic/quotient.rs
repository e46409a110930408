//! Quotients, square roots and unit vectors of big integers, rounded once.

use dashu_int::{IBig, UBig, ops::BitTest, ops::SquareRoot};
use glam::DVec3;

use super::float::ldexp;

/// `numerator / denominator`, rounded to nearest, ties to even.
///
/// The quotient is taken to be in the range of normal numbers; below it the last bits may be lost.
#[must_use]
pub fn round_quotient(numerator: IBig, denominator: &IBig) -> f64 {
    use dashu_int::Sign as BigSign;
    let (numerator_sign, numerator) = numerator.into_parts();
    let (denominator_sign, denominator) = denominator.clone().into_parts();
    if numerator.is_zero() {
        return 0.0;
    }
    // A quotient of 65 or 66 bits, its last bit made sticky: more than 53 + 2, so one more rounding is the right one.
    let shift = 65 + denominator.bit_len() as i64 - numerator.bit_len() as i64;
    let (scaled, divisor) = if shift >= 0 {
        (numerator << shift as usize, denominator)
    } else {
        (numerator, denominator << (-shift) as usize)
    };
    let (mut quotient, remainder) = (&scaled / &divisor, &scaled % &divisor);
    if !remainder.is_zero() {
        quotient |= UBig::ONE;
    }
    let mantissa = u128::try_from(quotient).unwrap_or(u128::MAX) as f64;
    let magnitude = ldexp(mantissa, -shift);
    if numerator_sign == BigSign::Negative && denominator_sign == BigSign::Positive
        || numerator_sign == BigSign::Positive && denominator_sign == BigSign::Negative
    {
        -magnitude
    } else {
        magnitude
    }
}

/// The unit vector along a vector of integers, each component accurate to a few roundings; zero for the zero vector.
pub(crate) fn unit_vector(vector: &[IBig; 3]) -> DVec3 {
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
