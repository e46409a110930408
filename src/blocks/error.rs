//! Why a model is not evaluated in blocks.

use std::io;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use planecut_csg::{BlockPlace, EvaluateError, UnboundedBrush};
use planecut_export::ExportError;
use thiserror::Error;

/// Why a model is not evaluated in blocks.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BlocksError {
    /// The system refuses a file.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Something else is where a plan is to be.
    #[error("found {} which is no folder of blocks of planecut, expected one, or an empty folder: nothing is overwritten", path.display())]
    Occupied {
        /// The folder.
        path: PathBuf,
    },
    /// A brush is not bounded, or a closed mesh.
    #[error("{source}")]
    Brush {
        /// The line of the input on which it begins, where there is one.
        line: Option<NonZeroU32>,
        /// Which one.
        source: UnboundedBrush,
    },
    /// The solid holds what none of its brushes holds.
    #[error("the solid is not bounded: it holds what no brush holds")]
    Unbounded,
    /// The pieces of a tree do not make a tree.
    #[error("found an operation that has not ended, or more than one tree, expected one tree")]
    Tree,
    /// A block has no mesh.
    #[error("block {place:?}: {source}")]
    Evaluate {
        /// Its place.
        place: BlockPlace,
        /// As for a model that is evaluated at once.
        source: EvaluateError,
    },
    /// A file of a plan is not what was written.
    #[error("{}: found a damaged file, expected {expected}", path.display())]
    Damaged {
        /// The file; empty for bytes that are in none.
        path: PathBuf,
        /// What it should be.
        expected: &'static str,
    },
    /// Two blocks do not fit together: a bug in planecut.
    #[error("blocks {first:?} and {second:?} do not fit together: {edges} edges on the wall between them have no like")]
    Seam {
        /// The place of the block of smaller coordinates.
        first: BlockPlace,
        /// That of its neighbour.
        second: BlockPlace,
        /// How many edges.
        edges: usize,
    },
    /// Blocks do not fit together around a line in which two walls cross: a bug in planecut.
    #[error("blocks do not fit together where walls cross: {edges} edges there have no like")]
    Crossing {
        /// How many edges.
        edges: usize,
    },
    /// A mesh is not written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The system gives no threads.
    #[error("no threads: {0}")]
    Threads(String),
    /// The caller wants no more.
    #[error("stopped")]
    Stopped,
}

impl BlocksError {
    /// The line of the input that it is about, counted from 1; 0 for none.
    #[must_use]
    pub fn line(&self) -> u32 {
        match self {
            Self::Brush { line: Some(line), .. } => line.get(),
            _ => 0,
        }
    }

    /// An error of the system about a file.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| Self::Io { path: path.to_owned(), source }
    }
}
