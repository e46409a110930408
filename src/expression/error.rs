//! Why a solid is not what is asked for.

use planecut_csg::{EvaluateError, TransformError};
use planecut_shapes::polyhedron::ConvexTreeError;
use thiserror::Error;

use super::MAX_PIECES;

/// Why a question about a solid has no answer.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExpressionError {
    /// Too many convex bodies.
    #[error(
        "found a solid of {found} convex bodies, each counted as often as it is used, expected at most {MAX_PIECES}"
    )]
    TooMany {
        /// How many there are.
        found: u64,
    },
    /// A plane or a vertex leaves the accepted range as it is moved.
    #[error(transparent)]
    Transform(#[from] TransformError),
    /// As for a model that is evaluated.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// A mesh of the solid falls into too many convex cells where these are needed.
    #[error(transparent)]
    Convex(#[from] ConvexTreeError),
    /// The solid is unbounded where its cells are asked for.
    #[error("found a solid that reaches infinity, expected one that is bounded")]
    Unbounded,
    /// A face names a material that is not in the list: a bug.
    #[error("found material number {found} of {count}")]
    Material {
        /// The number.
        found: u32,
        /// How many there are.
        count: usize,
    },
    /// One body is needed, and the solid is not one.
    #[error("solid: found one of {found} bodies, expected one convex body or closed mesh")]
    NotOneBody {
        /// How many there are.
        found: usize,
    },
}

impl ExpressionError {
    /// Whether it shows a bug of ours, whatever the input.
    #[must_use]
    pub fn is_bug(&self) -> bool {
        let of_evaluation = |error: &EvaluateError| matches!(error, EvaluateError::Weld(_) | EvaluateError::Combine(_));
        match self {
            Self::Material { .. } => true,
            Self::Evaluate(error) => of_evaluation(error),
            _ => false,
        }
    }

    /// Whether it is that a solid reaches infinity.
    #[must_use]
    pub fn is_unbounded(&self) -> bool {
        matches!(self, Self::Unbounded | Self::Evaluate(EvaluateError::Unbounded))
    }
}
