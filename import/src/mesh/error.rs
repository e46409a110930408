//! Errors of the mesh readers.

use std::fmt;

use thiserror::Error;

/// Where in a file something was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A line, counted from 1.
    Line(usize),
    /// A byte offset, counted from 0.
    Byte(usize),
    /// A place in a JSON document, such as `meshes/0/primitives/1`.
    Json(String),
    /// The end, or the file as a whole.
    End,
}

/// A mesh file could not be read. Displays as one line, `NAME:LINE: found …, expected …`; binary formats give a byte offset.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{name}:{place} found {found}, expected {expected}")]
pub struct MeshError {
    /// The file's name as given to the reader.
    pub name: String,
    /// Where in the file.
    pub place: Place,
    /// What stands there.
    pub found: String,
    /// What should.
    pub expected: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "{line}:"),
            Self::Byte(offset) => write!(f, " byte {offset}:"),
            Self::Json(path) => write!(f, " {path}:"),
            Self::End => Ok(()),
        }
    }
}

/// A [`MeshError`] that does not know its file yet.
#[derive(Debug)]
pub(super) struct Fault {
    place: Place,
    found: String,
    expected: String,
}

impl Fault {
    pub(super) fn new(place: Place, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { place, found: found.into(), expected: expected.into() }
    }

    /// A fault of the file as a whole.
    pub(super) fn whole(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::new(Place::End, found, expected)
    }

    pub(super) fn in_file(self, name: &str) -> MeshError {
        let Self { place, found, expected } = self;
        MeshError { name: name.to_owned(), place, found, expected }
    }
}

/// Bytes as they can be shown in an error: on one line, shortened, with what cannot be printed escaped.
pub(super) fn quoted(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(LONGEST)]).escape_debug().to_string();
    if bytes.is_empty() {
        "nothing".to_owned()
    } else if bytes.len() > LONGEST {
        format!("`{shown}…`")
    } else {
        format!("`{shown}`")
    }
}
