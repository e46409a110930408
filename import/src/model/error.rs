//! Why a model file could not be read.

use thiserror::Error;

use super::json::{Document, Entry};
use crate::lines::LineTable;

/// Why a model file could not be read; displays as one line that names file, line and place.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The text is not JSON, or not in UTF-8.
    #[error("{name}:{line}: {path}: found {found}, expected {expected}")]
    Syntax {
        /// The file.
        name: String,
        /// The line, counted from 1.
        line: u32,
        /// The place as a JSON path.
        path: String,
        /// What stands there.
        found: String,
        /// What may stand there.
        expected: String,
    },
    /// The JSON is not a model, or one that cannot be made.
    #[error("{name}:{line}: {path}: found {found}, expected {expected}")]
    Content {
        /// The file.
        name: String,
        /// The line, counted from 1.
        line: u32,
        /// The place as a JSON path.
        path: String,
        /// What stands there.
        found: String,
        /// What may stand there.
        expected: String,
    },
    /// A parameter that [`ModelOptions`](super::ModelOptions) sets is none of the file, or its value no number.
    #[error("{name}: found {found}, expected {expected}")]
    Parameter {
        /// The file.
        name: String,
        /// What was to be set.
        found: String,
        /// What can be set.
        expected: String,
    },
    /// The text is longer than [`MAX_TEXT`](super::MAX_TEXT).
    #[error("{name}: found {bytes} bytes, expected at most {}", super::MAX_TEXT)]
    TooLong {
        /// The file.
        name: String,
        /// Its length.
        bytes: usize,
    },
}

impl ModelError {
    /// The line of the error, counted from 1, where there is one.
    #[must_use]
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::Syntax { line, .. } | Self::Content { line, .. } => Some(*line),
            Self::Parameter { .. } | Self::TooLong { .. } => None,
        }
    }

    /// The place of the error as a JSON path, where there is one.
    #[must_use]
    pub fn path(&self) -> Option<&str> {
        match self {
            Self::Syntax { path, .. } | Self::Content { path, .. } => Some(path),
            Self::Parameter { .. } | Self::TooLong { .. } => None,
        }
    }
}

/// A value that is not what it should be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    pub(super) entry: Entry,
    pub(super) found: String,
    pub(super) expected: String,
}

/// Most stages of the reader end so.
pub(super) type Checked<T> = Result<T, Fault>;

/// Why evaluation stopped.
#[derive(Debug)]
pub(super) enum Stop<E> {
    /// A value that is not what it should be.
    Fault(Fault),
    /// What takes the pieces refused one.
    Sink(E),
}

impl<E> From<Fault> for Stop<E> {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

impl Fault {
    /// A fault of a value, in words.
    pub(super) fn new(entry: Entry, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { entry, found: found.into(), expected: expected.into() }
    }

    /// The error for the user.
    pub(super) fn locate(self, name: &str, document: &Document<'_>, lines: &LineTable) -> ModelError {
        ModelError::Content {
            name: name.to_owned(),
            line: lines.line_of(document.offset(self.entry)),
            path: document.path(self.entry),
            found: self.found,
            expected: self.expected,
        }
    }
}

impl Document<'_> {
    /// The fault of a value that is not `expected`.
    pub(super) fn refuse<T>(&self, entry: Entry, expected: impl Into<String>) -> Checked<T> {
        Err(Fault::new(entry, self.describe(entry), expected))
    }
}
