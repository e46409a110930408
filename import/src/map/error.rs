//! Why a map could not be read.

use thiserror::Error;

use planecut_kernel::HalfSpaceError;

use super::token::is_delimiter;
use crate::lines::LineTable;
use crate::source::shown_token;

/// Why a map could not be read; displays as one line that names file and line.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MapError {
    /// The text is not a map.
    #[error("{name}:{line}: found {found}, expected {expected}")]
    Syntax {
        /// The file.
        name: String,
        /// The line, counted from 1.
        line: u32,
        /// What stands there.
        found: String,
        /// What may stand there.
        expected: String,
    },
    /// A face's plane has coefficients that no computation could be exact on.
    #[error("{name}:{line}: found a face whose plane is outside the accepted range, expected less extreme coordinates")]
    PlaneOutOfRange {
        /// The file.
        name: String,
        /// The line of the face, counted from 1.
        line: u32,
        /// What was wrong with the coefficients.
        source: HalfSpaceError,
    },
    /// The file has no content at all.
    #[error("{name}: holds no brushes: found nothing but white space and comments, expected an entity in braces")]
    Empty {
        /// The file.
        name: String,
    },
}

impl MapError {
    /// The line of the error, counted from 1, where there is one.
    #[must_use]
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::Syntax { line, .. } | Self::PlaneOutOfRange { line, .. } => Some(*line),
            Self::Empty { .. } => None,
        }
    }
}

/// Where the grammar does not hold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SyntaxError {
    /// Byte offset into the input.
    pub(super) offset: usize,
    pub(super) found: Found,
    pub(super) expected: &'static str,
    /// Offset of the delimiter whose partner is missing.
    pub(super) opened: Option<usize>,
}

/// What stands where an error is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Found {
    /// The token at the offset.
    Token,
    /// A quote that is not closed.
    OpenQuote,
    /// A number of values.
    Values(usize),
}

impl SyntaxError {
    /// The error for the user; `text` is what offsets count in.
    pub(super) fn locate(&self, name: &str, text: &[u8], lines: &LineTable) -> MapError {
        let found = match self.found {
            Found::Token => describe_token(&text[self.offset..]),
            Found::OpenQuote => "a text in quotes without an end".to_owned(),
            Found::Values(count) => format!("{count} values after the texture"),
        };
        let expected = match self.opened {
            Some(opened) => format!("{} for the `{{` of line {}", self.expected, lines.line_of(opened)),
            None => self.expected.to_owned(),
        };
        // The end of the file is on the last line that holds something.
        let offset = self.offset.min(text.trim_ascii_end().len());
        MapError::Syntax { name: name.to_owned(), line: lines.line_of(offset), found, expected }
    }
}

/// The token at the start of `text`, on one line and not too long.
fn describe_token(text: &[u8]) -> String {
    let Some(first) = text.first() else { return "the end of the file".to_owned() };
    let length = match first {
        b'"' => text[1..].iter().position(|b| matches!(b, b'"' | b'\n' | b'\r')).map_or(text.len(), |i| i + 2),
        b if is_delimiter(*b) => 1,
        _ => text.iter().position(|b| is_delimiter(*b)).unwrap_or(text.len()),
    };
    shown_token(text, length)
}
