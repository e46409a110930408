//! Words and numbers of the text formats.

use super::error::{Fault, Place, quoted};

/// The words of a text, with the line on which each stands.
pub(super) struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    /// The words of `bytes`, whose first line has the given number.
    pub(super) fn new(bytes: &'a [u8], line: usize) -> Self {
        Self { rest: bytes, line }
    }

    /// Line of the last word.
    pub(super) fn place(&self) -> Place {
        Place::Line(self.line)
    }

    /// Number of bytes that are left.
    pub(super) fn remaining(&self) -> usize {
        self.rest.len()
    }

    /// The next word, or `None` at the end.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += count_newlines(&self.rest[..start]);
        self.rest = &self.rest[start..];
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    /// What is left of the current line, without blanks around it.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest;
        line.trim_ascii()
    }

    /// The next word as a finite number.
    pub(super) fn number(&mut self) -> Result<f64, Fault> {
        let word = self.next();
        finite(word.unwrap_or_default(), self.place())
    }
}

/// A finite decimal number.
pub(super) fn finite(word: &[u8], place: Place) -> Result<f64, Fault> {
    let value = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f64>().ok()).filter(|v| v.is_finite());
    value.ok_or_else(|| Fault::new(place, quoted(word), "a finite number"))
}

pub(super) fn count_newlines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| b == b'\n').count()
}
