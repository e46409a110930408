//! Why a stream ends early.

use std::convert::Infallible;

use thiserror::Error;

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
