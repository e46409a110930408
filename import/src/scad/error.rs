//! Why a tree could not be read.

use std::borrow::Cow;

use thiserror::Error;

use super::token::describe;
use crate::lines::LineTable;

/// Why a tree could not be read; displays as one line that names file and line.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ScadError {
    /// The text is no evaluated tree, or says something that cannot be made.
    #[error("{name}:{line}: found {found}, expected {expected}")]
    At {
        /// The file.
        name: String,
        /// The line, counted from 1.
        line: u32,
        /// What stands there.
        found: String,
        /// What may stand there.
        expected: String,
    },
    /// More text than is accepted.
    #[error("{name}: found {bytes} bytes, expected at most {}", super::MAX_TEXT)]
    TooLong {
        /// The file.
        name: String,
        /// Its length.
        bytes: usize,
    },
}

impl ScadError {
    /// The line of the error, counted from 1, where there is one.
    #[must_use]
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::At { line, .. } => Some(*line),
            Self::TooLong { .. } => None,
        }
    }
}

/// Where the grammar does not hold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    /// Byte offset into the text.
    offset: usize,
    /// What stands there; the token itself where nothing is said.
    found: Option<Cow<'static, str>>,
    expected: Cow<'static, str>,
}

impl Fault {
    /// A token that does not belong there.
    pub(super) fn token(offset: usize, expected: impl Into<Cow<'static, str>>) -> Self {
        Self { offset, found: None, expected: expected.into() }
    }

    pub(super) fn found(
        offset: usize,
        found: impl Into<Cow<'static, str>>,
        expected: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self { offset, found: Some(found.into()), expected: expected.into() }
    }

    /// The error for the user; `text` is what offsets count in.
    pub(super) fn locate(self, name: &str, text: &[u8], lines: &LineTable) -> ScadError {
        let found = self.found.unwrap_or_else(|| describe(&text[self.offset.min(text.len())..]));
        // The end of the file is on the last line that holds something.
        let offset = self.offset.min(text.trim_ascii_end().len());
        let (found, expected) = (found.into_owned(), self.expected.into_owned());
        ScadError::At { name: name.to_owned(), line: lines.line_of(offset), found, expected }
    }
}
