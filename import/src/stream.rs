//! Inputs that are read as a stream: brushes go to a [`TreeSink`](planecut_csg::TreeSink) one by one, and the whole is never in memory.
//!
//! [`stream_map`] reads a map of any length, [`stream_model`] a model file whose copies may be any number.

use std::convert::Infallible;

use thiserror::Error;

pub use crate::map::{MapSummary, stream_map};
pub use crate::model::{ModelSummary, stream_model};

/// Why a stream ended early.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StreamError<I, S> {
    /// The input could not be read.
    #[error(transparent)]
    Input(I),
    /// What takes the pieces refused one.
    #[error(transparent)]
    Sink(S),
}

impl<I> StreamError<I, Infallible> {
    /// The error of the input, where nothing is refused.
    #[must_use]
    pub fn into_input(self) -> I {
        match self {
            Self::Input(error) => error,
            Self::Sink(never) => match never {},
        }
    }
}
