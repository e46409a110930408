//! How exactly decimals were written.

use super::Precision;

/// What the decimals of a file look like.
#[derive(Debug, Default)]
pub(super) struct Decimals {
    numbers: usize,
    /// Digits after the point, where all numbers have equally many.
    places: Option<u32>,
    is_mixed: bool,
    /// The most significant digits, zeros at the end left out, and how many numbers have them.
    digits: u32,
    with_digits: usize,
}

/// A shape of numbers counts as deliberate where at least one number in this many has it.
const SHARE: usize = 4;
/// Numbers with as many places, zeros at the end written out, are those of a fixed format.
const LEAST_PLACES: u32 = 4;

impl Decimals {
    /// Takes a number into account.
    pub(super) fn add(&mut self, word: &[u8]) {
        let mantissa = word.split(|b| matches!(b, b'e' | b'E')).next().unwrap_or_default();
        let has_exponent = mantissa.len() < word.len();
        let point = mantissa.iter().position(|b| *b == b'.');
        let places = point.map_or(0, |point| (mantissa.len() - point - 1) as u32);
        self.is_mixed |= has_exponent || self.places.is_some_and(|known| known != places);
        self.places = Some(places);
        self.numbers += 1;
        let digits = significant_digits(mantissa);
        if digits > self.digits {
            (self.digits, self.with_digits) = (digits, 0);
        }
        self.with_digits += usize::from(digits == self.digits);
    }

    /// How exactly the numbers are known. Few digits are taken for exact numbers.
    pub(super) fn precision(&self) -> Precision {
        let places = self.places.filter(|places| !self.is_mixed && *places >= LEAST_PLACES);
        let is_shared = SHARE * self.with_digits >= self.numbers;
        match (places, self.digits) {
            (Some(places), _) if places <= 12 => Precision::Places(places),
            (_, digits @ 5..=6) if is_shared => Precision::Digits(digits),
            (_, 7..=9) if is_shared => Precision::Single,
            _ => Precision::Double,
        }
    }
}

/// The digits from the first to the last that is not zero.
fn significant_digits(mantissa: &[u8]) -> u32 {
    let digits = || mantissa.iter().filter(|b| b.is_ascii_digit());
    let leading = digits().take_while(|b| **b == b'0').count();
    let trailing = digits().rev().take_while(|b| **b == b'0').count();
    (digits().count().saturating_sub(leading + trailing)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(words: &[&str]) -> Precision {
        let mut decimals = Decimals::default();
        words.iter().for_each(|word| decimals.add(word.as_bytes()));
        decimals.precision()
    }

    #[test]
    fn fixed_formats_have_equally_many_places() {
        assert_eq!(of(&["0.500000", "-12.345678", "0.000000"]), Precision::Places(6));
    }

    #[test]
    fn formats_of_significant_digits_are_told_by_the_longest() {
        assert_eq!(of(&["0.5", "-12.3457", "1.23457e-07", "0"]), Precision::Digits(6));
        assert_eq!(of(&["0.5", "-12.345678", "1.2345671e-07", "24.7437099"]), Precision::Single);
    }

    #[test]
    fn short_and_long_numbers_are_exact() {
        assert_eq!(of(&["0", "1", "-1", "0.5"]), Precision::Double);
        assert_eq!(of(&["0.1", "0.30000000000000004", "7"]), Precision::Double);
    }
}
