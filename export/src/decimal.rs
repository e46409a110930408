//! Numbers as text.

use std::io::{self, Write};

use glam::DVec3;

/// Writes the shortest decimal that reads back as `value`.
pub(crate) fn write_decimal(value: f64, out: &mut dyn Write) -> io::Result<()> {
    // Grid coordinates are the common case, and an integer is several times faster to print.
    if value.fract() == 0.0 && value.abs() < 1e15 {
        if value < 0.0 {
            out.write_all(b"-")?;
        }
        write_digits(value.abs() as u64, out)
    } else if (1e-5..1e17).contains(&value.abs()) {
        write!(out, "{value}")
    } else {
        write!(out, "{value:e}")
    }
}

/// Writes the coordinates of a point, each after a space.
pub(crate) fn write_point(point: DVec3, out: &mut dyn Write) -> io::Result<()> {
    point.to_array().into_iter().try_for_each(|value| {
        out.write_all(b" ")?;
        write_decimal(value, out)
    })
}

/// Writes an integer.
pub(crate) fn write_digits(mut value: u64, out: &mut dyn Write) -> io::Result<()> {
    let mut digits = [b'0'; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    out.write_all(&digits[start..])
}

/// Why appending to bytes cannot fail.
const APPENDS: &str = "a byte vector takes every write";

/// [`write_decimal`] to bytes in memory.
pub(crate) fn push_decimal(text: &mut Vec<u8>, value: f64) {
    write_decimal(value, text).expect(APPENDS);
}

/// [`write_digits`] to bytes in memory.
pub(crate) fn push_digits(text: &mut Vec<u8>, value: u64) {
    write_digits(value, text).expect(APPENDS);
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn decimals_read_back_as_the_same_number() {
        let mut rng = Rng::new(1);
        let random = std::iter::repeat_with(|| f64::from_bits(rng.bits()));
        let chosen = [0.0, 1.0, -1.0, 0.1, -2.5, 1e15, -1e15, 999_999_999_999_999.0, 1e17, 1e-5, 5e-324, f64::MAX];
        for value in chosen.into_iter().chain(random.take(10_000)).filter(|v| v.is_finite()) {
            let mut text = Vec::new();
            write_decimal(value, &mut text).expect("written");
            let text = String::from_utf8(text).expect("ASCII");
            assert_eq!(text.parse::<f64>().expect("a number").to_bits(), value.to_bits(), "{text}");
        }
    }
}
