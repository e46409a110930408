//! Sums that lose nothing: what is added and taken out again leaves no trace, and the order makes no difference.

/// Bits of a digit.
const DIGIT: usize = 32;

/// As many digits as hold all bits of all numbers, from 2⁻¹⁰⁷⁴ to 2¹⁰²⁴, and of sums of 2⁶³ of them.
const DIGITS: usize = (1074_usize + 1024 + 63).div_ceil(DIGIT) + 1;

/// A digit holds that many terms of either sign before it overflows: a term adds less than 2³² to it.
const TERMS: u32 = 1 << 30;

/// An exact sum of numbers, as a number in fixed point of more than 2,000 bits (Kulisch's long accumulator, with digits whose carries wait as in Neal 2015).
#[derive(Debug, Clone)]
pub(crate) struct ExactSum {
    /// Digits of weight `2^(32k − 1074)`. Once carries are done, all but the last one are in `0..2³²`.
    digits: [i64; DIGITS],
    /// Terms that were added since.
    waiting: u32,
    /// How many terms are not finite.
    not_finite: i64,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { digits: [0; DIGITS], waiting: 0, not_finite: 0 }
    }
}

impl ExactSum {
    /// Adds a term.
    pub(crate) fn add(&mut self, term: f64) {
        self.put(term, 1);
    }

    /// Takes a term out that was added.
    pub(crate) fn remove(&mut self, term: f64) {
        self.put(term, -1);
    }

    #[inline]
    fn put(&mut self, term: f64, sign: i64) {
        if !term.is_finite() {
            self.not_finite += sign;
            return;
        }
        let bits = term.to_bits();
        let exponent = usize::try_from(bits >> 52 & 0x7ff).expect("eleven bits");
        let fraction = bits & ((1 << 52) - 1);
        // those without an exponent have the same place as those of exponent 1
        let (mantissa, place) = if exponent == 0 { (fraction, 0) } else { (fraction | 1 << 52, exponent - 1) };
        let sign = if term < 0.0 { -sign } else { sign };
        let (first, shift) = (place / DIGIT, place % DIGIT);
        let shifted = u128::from(mantissa) << shift;
        for k in 0..3 {
            let digit = (shifted >> (DIGIT * k) & 0xffff_ffff) as i64;
            self.digits[first + k] += sign * digit;
        }
        self.waiting += 1;
        if self.waiting == TERMS {
            self.carry();
        }
    }

    /// Adds another sum.
    pub(crate) fn add_sum(&mut self, other: &Self) {
        self.carry();
        let mut other = other.clone();
        other.carry();
        for (digit, more) in self.digits.iter_mut().zip(other.digits) {
            *digit += more;
        }
        self.waiting = 1;
        self.not_finite += other.not_finite;
    }

    fn carry(&mut self) {
        let mut carried = 0;
        for digit in &mut self.digits[..DIGITS - 1] {
            let sum = *digit + carried;
            carried = sum >> DIGIT;
            *digit = sum & 0xffff_ffff;
        }
        self.digits[DIGITS - 1] += carried;
        self.waiting = 0;
    }

    /// The sum, correctly rounded; NaN where a term is not finite.
    pub(crate) fn value(&self) -> f64 {
        if self.not_finite != 0 {
            return f64::NAN;
        }
        let mut sum = self.clone();
        sum.carry();
        let is_negative = sum.digits[DIGITS - 1] < 0;
        if is_negative {
            sum.digits.iter_mut().for_each(|digit| *digit = -*digit);
            sum.carry();
        }
        let magnitude = sum.magnitude();
        if is_negative { -magnitude } else { magnitude }
    }

    /// The value of a sum that is not negative, and of which all carries are done.
    fn magnitude(&self) -> f64 {
        let top = self.digits.iter().rposition(|digit| *digit != 0).unwrap_or(0).max(2);
        let (low, high) = self.digits.split_at(top - 2);
        let bits = high[..3].iter().rev().fold(0_u128, |bits, digit| bits << DIGIT | u128::from(digit.unsigned_abs()));
        // of three digits at least 65 bits are in use where there are lower ones, so that these only break ties
        let is_exact = low.iter().all(|digit| *digit == 0);
        (bits | u128::from(!is_exact)) as f64 * power_of_two(DIGIT * (top - 2))
    }
}

/// `2^(place − 1074)`.
fn power_of_two(place: usize) -> f64 {
    f64::from_bits(if place < 52 { 1 << place } else { (place as u64 - 51) << 52 })
}

#[cfg(test)]
mod tests {
    use dashu_ratio::RBig;

    use super::*;

    fn sum_of(terms: &[f64]) -> ExactSum {
        let mut sum = ExactSum::default();
        terms.iter().for_each(|term| sum.add(*term));
        sum
    }

    /// By rational numbers.
    fn expected(terms: &[f64]) -> f64 {
        let exact = |term: &f64| RBig::try_from(*term).expect("a finite number");
        let sum = terms.iter().map(exact).fold(RBig::ZERO, |sum, term| sum + term);
        sum.to_f64().value()
    }

    /// Random numbers of any size around some exponents.
    struct Numbers(u64);

    impl Numbers {
        fn bits(&mut self) -> u64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            self.0 ^ self.0 >> 29
        }

        fn next(&mut self, exponents: std::ops::Range<u64>) -> f64 {
            let exponent = exponents.start + (self.bits() >> 20) % (exponents.end - exponents.start);
            let fraction = self.bits() >> 12;
            f64::from_bits((self.bits() >> 63) << 63 | exponent << 52 | fraction)
        }
    }

    #[test]
    fn sums_are_those_of_rational_numbers() {
        let mut numbers = Numbers(1);
        for exponents in [0..2, 0..80, 1000..1040, 900..1100, 1..2000, 1990..2046] {
            for count in [1, 2, 3, 10, 100] {
                for _ in 0..20 {
                    let mut terms: Vec<f64> = (0..count).map(|_| numbers.next(exponents.clone())).collect();
                    // most of it cancels
                    let back: Vec<f64> = terms.iter().skip(1).map(|term| -term).collect();
                    assert_eq!(sum_of(&terms).value(), expected(&terms), "{terms:?}");
                    terms.extend(back);
                    assert_eq!(sum_of(&terms).value(), expected(&terms), "{terms:?}");
                }
            }
        }
    }

    #[test]
    fn ties_are_rounded_to_even_numbers() {
        let half = 2.0_f64.powi(-53);
        for terms in [[1.0, half, 0.0], [1.0, half, 1e-300], [1.0, half, -1e-300], [1.0 + 2.0 * half, half, 0.0]] {
            assert_eq!(sum_of(&terms).value(), expected(&terms), "{terms:?}");
        }
        let least = f64::from_bits(1);
        assert_eq!(sum_of(&[least, least, least]).value(), f64::from_bits(3));
        assert_eq!(sum_of(&[f64::MAX, f64::MAX]).value(), f64::INFINITY);
        assert_eq!(sum_of(&[f64::MAX, f64::MAX, -f64::MAX]).value(), f64::MAX);
        assert_eq!(sum_of(&[]).value(), 0.0);
    }

    #[test]
    fn what_is_taken_out_leaves_no_trace() {
        let mut numbers = Numbers(2);
        let kept: Vec<f64> = (0..50).map(|_| numbers.next(1000..1040)).collect();
        let mut sum = sum_of(&kept);
        let others: Vec<f64> = (0..500).map(|_| numbers.next(900..1200)).chain([f64::INFINITY, f64::NAN]).collect();
        others.iter().for_each(|term| sum.add(*term));
        assert!(sum.value().is_nan());
        others.iter().rev().for_each(|term| sum.remove(*term));
        assert_eq!(sum.value(), expected(&kept));
        let mut both = sum_of(&kept[..20]);
        both.add_sum(&sum_of(&kept[20..]));
        assert_eq!(both.value(), sum.value());
    }
}
