//! Attributes in XML: text and numbers.

use std::io::{self, Write};

use glam::DVec3;

use crate::decimal::write_decimal;

/// Text for an attribute in XML; characters that XML has no place for are replaced.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            c if c.is_control() => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// An attribute of numbers.
pub(crate) fn write_numbers(name: &str, numbers: &[f64], out: &mut dyn Write) -> io::Result<()> {
    write!(out, " {name}=\"")?;
    for (place, number) in numbers.iter().enumerate() {
        if place > 0 {
            out.write_all(b" ")?;
        }
        // adding zero turns `-0` into `0`
        write_decimal(*number + 0.0, out)?;
    }
    out.write_all(b"\"")
}

/// The same for a vector.
pub(crate) fn write_vector(name: &str, vector: DVec3, out: &mut dyn Write) -> io::Result<()> {
    write_numbers(name, &vector.to_array(), out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_legal_in_attributes() {
        assert_eq!(escaped("a<b>&\"c\"\n\0 Wände"), "a&lt;b&gt;&amp;&quot;c&quot;\u{fffd}\u{fffd} Wände");
    }
}
