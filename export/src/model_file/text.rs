//! JSON, piece by piece.

use std::io::Write;

use super::limits::{MAX_TEXT, refuse};
use crate::ExportError;
use crate::decimal::{push_decimal, push_digits};

/// Bytes that are handed on at once, about.
const AT_ONCE: usize = 1 << 16;
/// Spaces by which each level is indented, from those of the model's own node on.
const INDENTATION: usize = 2;
/// Levels that are told by indentation: what is deeper has that of the last, or a chain of thousands of nodes would be spaces for the most part.
const MAX_INDENTED: usize = 32;

/// Text that goes out before it becomes long.
pub(super) struct Text<'o> {
    out: &'o mut dyn Write,
    /// What has not gone out yet.
    waiting: Vec<u8>,
    /// Bytes that are gone.
    written: u64,
}

impl<'o> Text<'o> {
    /// No text yet.
    pub(super) fn new(out: &'o mut dyn Write) -> Self {
        Self { out, waiting: Vec::with_capacity(2 * AT_ONCE), written: 0 }
    }

    /// Text as it stands.
    pub(super) fn push(&mut self, text: &str) {
        self.waiting.extend_from_slice(text.as_bytes());
    }

    /// A new line for a node within this number of others.
    pub(super) fn line(&mut self, depth: usize) {
        self.waiting.push(b'\n');
        let spaces = INDENTATION * (2 + depth.min(MAX_INDENTED));
        self.waiting.resize(self.waiting.len() + spaces, b' ');
    }

    /// The shortest number that reads back as the same bits.
    pub(super) fn number(&mut self, value: f64) {
        if value == 0.0 && value.is_sign_negative() {
            // with a fraction, so that no reader takes it for the integer zero, which has no sign
            return self.push("-0.0");
        }
        push_decimal(&mut self.waiting, value);
    }

    /// A list of numbers.
    pub(super) fn numbers(&mut self, values: &[f64]) {
        self.list(values, |text, value| text.number(*value));
    }

    /// A list of whole numbers.
    pub(super) fn whole_numbers(&mut self, values: &[u32]) {
        self.list(values, |text, value| push_digits(&mut text.waiting, u64::from(*value)));
    }

    /// A list on one line.
    pub(super) fn list<T>(&mut self, items: impl IntoIterator<Item = T>, mut item: impl FnMut(&mut Self, T)) {
        self.push("[");
        for (place, value) in items.into_iter().enumerate() {
            if place > 0 {
                self.push(", ");
            }
            item(self, value);
        }
        self.push("]");
    }

    /// A list on one line that may be long.
    ///
    /// # Errors
    /// As [`Self::spill`].
    pub(super) fn long_list<T>(
        &mut self,
        items: impl IntoIterator<Item = T>,
        mut item: impl FnMut(&mut Self, T),
    ) -> Result<(), ExportError> {
        self.push("[");
        for (place, value) in items.into_iter().enumerate() {
            if place > 0 {
                self.push(", ");
            }
            item(self, value);
            self.spill()?;
        }
        self.push("]");
        Ok(())
    }

    /// Hands on what waits, if that is much.
    ///
    /// # Errors
    /// [`ExportError::Io`] where the output refuses, [`ExportError::ModelLimit`] for a text that is too long to be read.
    pub(super) fn spill(&mut self) -> Result<(), ExportError> {
        if self.waiting.len() < AT_ONCE {
            return Ok(());
        }
        self.hand_on()
    }

    /// Hands on the rest.
    ///
    /// # Errors
    /// As [`Self::spill`].
    pub(super) fn end(mut self) -> Result<(), ExportError> {
        self.hand_on()
    }

    fn hand_on(&mut self) -> Result<(), ExportError> {
        self.written += self.waiting.len() as u64;
        if self.written > MAX_TEXT {
            return refuse(format!("a text of {} bytes or more", self.written), format!("at most {MAX_TEXT}"));
        }
        self.out.write_all(&self.waiting)?;
        self.waiting.clear();
        Ok(())
    }
}

/// A text in quotes, with what JSON has to escape.
pub(super) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn every_bit_of_a_number_is_kept() {
        let mut rng = Rng::new(1);
        let random = std::iter::repeat_with(|| f64::from_bits(rng.bits()));
        for value in
            [0.0, -0.0, -1.0, 5e-324, f64::MAX].into_iter().chain(random.take(10_000)).filter(|v| v.is_finite())
        {
            let mut bytes = Vec::new();
            let mut text = Text::new(&mut bytes);
            text.number(value);
            text.end().expect("written");
            let read: f64 = serde_json::from_slice(&bytes).expect("a number as JSON has them");
            assert_eq!(read.to_bits(), value.to_bits(), "{value:e}");
        }
    }

    #[test]
    fn a_text_that_no_reader_takes_is_refused() {
        let mut sink = std::io::sink();
        let mut text = Text::new(&mut sink);
        text.written = MAX_TEXT - 3;
        text.push("123");
        text.hand_on().expect("the longest that is read");
        text.push("4");
        let error = text.end().expect_err("one byte too many").to_string();
        assert!(error.contains("found a text of 1073741825 bytes or more, expected at most 1073741824"), "{error}");
    }
}
