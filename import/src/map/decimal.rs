//! Numbers as a map writes them.

/// Most digits after the point that are read as an exact decimal.
///
/// Editors write `%g` or `%.6f`, and then the decimal is what was meant. Longer fractions are doubles printed in full:
/// there the double is what was meant.
const MAX_PLACES: i64 = 6;

/// A number of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Decimal {
    /// `mantissa / 10^places` with `|mantissa| ≤ 2^53` and at most six places.
    Exact {
        /// The digits with their sign, trailing zeros of the fraction dropped.
        mantissa: i64,
        /// Digits after the point.
        places: u32,
    },
    /// A finite number with more digits than that.
    Float(f64),
}

impl Decimal {
    /// Reads `[+-] digits [. digits] [e [+-] digits]`, at least one digit before the exponent.
    ///
    /// `None` where `text` has another form (`nan`, `inf` and `0x10` have) or is too large for an `f64`.
    pub(super) fn parse(text: &[u8]) -> Option<Self> {
        let Parts { negative, whole, fraction, exponent } = Parts::split(text)?;
        let fraction = trim_end_zeros(fraction);
        if let Some(exact) = exact(negative, whole, fraction, exponent) {
            return Some(exact);
        }
        let value: f64 = std::str::from_utf8(text).ok()?.parse().ok()?;
        value.is_finite().then_some(Self::Float(value))
    }

    /// The nearest `f64`.
    pub(super) fn to_f64(self) -> f64 {
        match self {
            // Both are exact as `f64` (10^6 < 2^53), so the quotient is rounded once.
            Self::Exact { mantissa, places } => mantissa as f64 / 10_i64.pow(places) as f64,
            Self::Float(value) => value,
        }
    }
}

/// The pieces of a number, none of them evaluated but the exponent.
struct Parts<'a> {
    negative: bool,
    whole: &'a [u8],
    fraction: &'a [u8],
    exponent: i64,
}

impl<'a> Parts<'a> {
    fn split(text: &'a [u8]) -> Option<Self> {
        let (negative, text) = split_sign(text);
        let (whole, text) = split_digits(text);
        let (fraction, text) = match text.split_first() {
            Some((b'.', rest)) => split_digits(rest),
            _ => (&text[..0], text),
        };
        if whole.is_empty() && fraction.is_empty() {
            return None;
        }
        Some(Self { negative, whole, fraction, exponent: parse_exponent(text)? })
    }
}

fn split_sign(text: &[u8]) -> (bool, &[u8]) {
    match text.split_first() {
        Some((b'-', rest)) => (true, rest),
        Some((b'+', rest)) => (false, rest),
        _ => (false, text),
    }
}

fn split_digits(text: &[u8]) -> (&[u8], &[u8]) {
    text.split_at(text.iter().position(|b| !b.is_ascii_digit()).unwrap_or(text.len()))
}

/// `e [+-] digits` to the end of `text`, or nothing at all. Saturates.
fn parse_exponent(text: &[u8]) -> Option<i64> {
    let rest = match text.split_first() {
        None => return Some(0),
        Some((b'e' | b'E', rest)) => rest,
        Some(_) => return None,
    };
    let (negative, rest) = split_sign(rest);
    let (digits, rest) = split_digits(rest);
    if digits.is_empty() || !rest.is_empty() {
        return None;
    }
    let magnitude = digits.iter().fold(0_i64, |v, d| v.saturating_mul(10).saturating_add(i64::from(d - b'0')));
    Some(if negative { -magnitude } else { magnitude })
}

fn trim_end_zeros(digits: &[u8]) -> &[u8] {
    &digits[..digits.iter().rposition(|d| *d != b'0').map_or(0, |last| last + 1)]
}

/// [`Decimal::Exact`], where the number fits it.
fn exact(negative: bool, whole: &[u8], fraction: &[u8], exponent: i64) -> Option<Decimal> {
    const LARGEST: i64 = 1 << 53;
    let mut mantissa = 0_i64;
    for digit in whole.iter().chain(fraction) {
        // At most 10 · 2^53 + 9, no overflow.
        mantissa = mantissa * 10 + i64::from(digit - b'0');
        if mantissa > LARGEST {
            return None;
        }
    }
    let mut places = (fraction.len() as i64).checked_sub(exponent)?;
    if mantissa == 0 {
        places = 0;
    }
    if places < 0 {
        let power = 10_i64.checked_pow(u32::try_from(-places).ok()?)?;
        mantissa = mantissa.checked_mul(power).filter(|m| *m <= LARGEST)?;
        places = 0;
    }
    let places = u32::try_from(places).ok().filter(|p| i64::from(*p) <= MAX_PLACES)?;
    Some(Decimal::Exact { mantissa: if negative { -mantissa } else { mantissa }, places })
}

#[cfg(test)]
mod tests {
    use super::Decimal::{self, Exact, Float};

    fn parse(text: &str) -> Option<Decimal> {
        Decimal::parse(text.as_bytes())
    }

    #[test]
    fn exact_forms() {
        let exact = |mantissa, places| Some(Exact { mantissa, places });
        for (text, mantissa, places) in [
            ("0", 0, 0),
            ("-0", 0, 0),
            ("-0.000000", 0, 0),
            ("0e99999999999999999999", 0, 0),
            ("64", 64, 0),
            ("+64.", 64, 0),
            ("-64.000000", -64, 0),
            (".5", 5, 1),
            ("-12.250", -1225, 2),
            ("0.000001", 1, 6),
            ("1.5e3", 1500, 0),
            ("15E-1", 15, 1),
            ("007", 7, 0),
            ("9007199254740992", 1 << 53, 0),
        ] {
            assert_eq!(parse(text), exact(mantissa, places), "{text}");
        }
    }

    #[test]
    fn longer_numbers_are_floats() {
        for text in
            ["505.37931034482756", "0.0000001", "9007199254740993", "1e300", "-1e-300", "1e-999999999999999999999"]
        {
            let value: f64 = text.parse().expect("a number");
            assert_eq!(parse(text), Some(Float(value)), "{text}");
        }
    }

    #[test]
    fn other_forms_are_refused() {
        for text in [
            "", "-", ".", "-.", "e5", "1e", "1e+", "1.2.3", "1-2", "--1", "nan", "-inf", "infinity", "0x10", "1e400",
            "1,5", "1f", "1 ", "1_000", "\u{0661}",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn value_is_the_nearest_double() {
        for text in ["0.1", "-0.3", "4095.999999", "123456789.012345", "9007199254740991", "1e15", "-7.25"] {
            let value: f64 = text.parse().expect("a number");
            assert_eq!(parse(text).map(|d| d.to_f64().to_bits()), Some(value.to_bits()), "{text}");
        }
    }

    #[test]
    fn long_tokens_take_linear_time() {
        let digits = "1".repeat(4_000_000);
        assert_eq!(parse(&digits), None, "larger than any f64");
        assert!(matches!(parse(&format!("0.{digits}")), Some(Float(_))));
        assert_eq!(parse(&format!("1.{}", "0".repeat(4_000_000))), Some(Exact { mantissa: 1, places: 0 }));
    }
}
