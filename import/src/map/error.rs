//! Why a map could not be read.

use std::io::ErrorKind;

use thiserror::Error;

use planecut_kernel::HalfSpaceError;

use super::token::{NUMBER, is_delimiter};
use crate::source::{SHOWN_BYTES, shown_token};

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
    /// A key of an entity would change brushes before it that were already handed on. Only where a map is read as a stream.
    #[error("{name}:{line}: found {found}, expected {expected}")]
    LateKey {
        /// The file.
        name: String,
        /// The line of the key, counted from 1.
        line: u32,
        /// The key and its value.
        found: String,
        /// What brushes before it were taken for.
        expected: String,
    },
    /// One brush, key or other piece is so long that it is not held. Only where a map is read as a stream.
    #[error("{name}:{line}: found a brush or another piece of more than {bytes} bytes, expected a shorter one")]
    TooLong {
        /// The file.
        name: String,
        /// The line on which it begins, counted from 1.
        line: u32,
        /// How much of it was read.
        bytes: usize,
    },
    /// The text could not be read to its end. Only where a map is read as a stream.
    #[error("{name}: found an error after {bytes} bytes ({reason}), expected a text that can be read to its end")]
    Unreadable {
        /// The file.
        name: String,
        /// How many bytes were read.
        bytes: u64,
        /// What kind of error it was.
        kind: ErrorKind,
        /// What the system says.
        reason: String,
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
            Self::Syntax { line, .. }
            | Self::PlaneOutOfRange { line, .. }
            | Self::LateKey { line, .. }
            | Self::TooLong { line, .. } => Some(*line),
            Self::Unreadable { .. } | Self::Empty { .. } => None,
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
    /// The brace whose partner is missing.
    pub(super) opened: Option<Opening>,
}

/// An opening brace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Opening {
    /// By its byte offset into the input.
    At(usize),
    /// That of the entity which has begun: it may stand before the input.
    Entity,
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

/// Bytes after a piece of a map that decide how it is read, and no more: the mark of a comment, a bracket after a quote, the word `Version`.
pub(super) const LOOKED_AHEAD: usize = 8;

/// Where the input of an error stands in its file.
pub(super) struct Surroundings<'a, L> {
    /// What the file is called.
    pub(super) name: &'a str,
    /// The input.
    pub(super) text: &'a [u8],
    /// The line of an offset.
    pub(super) line_of: L,
    /// The last line before the input that holds something, or 1.
    pub(super) line_before: u32,
    /// The line on which the entity that has begun opens.
    pub(super) entity_line: u32,
}

impl SyntaxError {
    /// Whether it stays as it is, whatever follows the input; `position` is where the grammar stopped.
    pub(super) fn is_certain(&self, text: &[u8], position: usize) -> bool {
        let end = match self.found {
            Found::OpenQuote => return false,
            Found::Values(_) => position,
            Found::Token => {
                let length = token_length(&text[self.offset..]);
                // a number is judged as a whole, anything else by how it begins
                self.offset + if self.expected == NUMBER { length } else { length.min(SHOWN_BYTES) }
            }
        };
        end + LOOKED_AHEAD <= text.len()
    }

    /// The error for the user.
    pub(super) fn locate<L: Fn(usize) -> u32>(&self, around: &Surroundings<'_, L>) -> MapError {
        let found = match self.found {
            Found::Token => describe_token(&around.text[self.offset..]),
            Found::OpenQuote => "a text in quotes without an end".to_owned(),
            Found::Values(count) => format!("{count} values after the texture"),
        };
        let opened = self.opened.map(|opened| match opened {
            Opening::At(offset) => (around.line_of)(offset),
            Opening::Entity => around.entity_line,
        });
        let expected = match opened {
            Some(line) => format!("{} for the `{{` of line {line}", self.expected),
            None => self.expected.to_owned(),
        };
        // The end of the file is on the last line that holds something.
        let end = around.text.trim_ascii_end().len();
        let line = if end == 0 { around.line_before } else { (around.line_of)(self.offset.min(end)) };
        MapError::Syntax { name: around.name.to_owned(), line, found, expected }
    }
}

/// The token at the start of `text`, on one line and not too long.
fn describe_token(text: &[u8]) -> String {
    if text.is_empty() { "the end of the file".to_owned() } else { shown_token(text, token_length(text)) }
}

/// How long the token at the start of `text` is; a quoted one that is not closed is longer than the text.
fn token_length(text: &[u8]) -> usize {
    match text.first() {
        None => 0,
        Some(b'"') => {
            let end = text[1..].iter().position(|b| matches!(b, b'"' | b'\n' | b'\r'));
            end.map_or(text.len() + 1, |i| i + 2)
        }
        Some(b) if is_delimiter(*b) => 1,
        Some(_) => text.iter().position(|b| is_delimiter(*b)).unwrap_or(text.len()),
    }
}
