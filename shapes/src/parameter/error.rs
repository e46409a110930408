//! Why a shape cannot be made.

use planecut_csg::{EvaluateError, TransformError};
use planecut_kernel::{HalfSpaceError, HullError};
use thiserror::Error;

use crate::polyhedron::ConvexTreeError;

/// Why a shape cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A parameter that has no shape.
    #[error("{parameter}: found {found}, expected {expected}")]
    Parameter {
        /// Its name, as `docs/model-file.md` calls it.
        parameter: &'static str,
        /// What was given.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// A half-space that was not accepted.
    #[error("half-space {index}: {error}")]
    HalfSpace {
        /// Which one, counted from 0.
        index: usize,
        /// Why.
        error: HalfSpaceError,
    },
    /// Points without a hull.
    #[error(transparent)]
    Hull(#[from] HullError),
    /// Coordinates that leave the range that is accepted.
    #[error("coordinates leave the accepted range: {0}")]
    OutOfRange(#[from] HalfSpaceError),
    /// A map that was not accepted.
    #[error(transparent)]
    Transform(#[from] TransformError),
    /// An unbounded body where only bounded ones will do.
    #[error("found an unbounded body, expected a bounded one")]
    Unbounded,
    /// The sides of a twisted extrusion pass through each other between two layers.
    #[error(
        "the sides of the extrusion cross between layer {layer} and the next: found {slices} slices, expected more"
    )]
    CrossingSides {
        /// The slice, counted from 0 at the bottom.
        layer: u32,
        /// How many slices there are.
        slices: u32,
    },
    /// More pieces than are accepted.
    #[error("the shape has {found} pieces, expected at most {limit}")]
    TooLarge {
        /// How many it would have.
        found: u64,
        /// How many are accepted.
        limit: u64,
    },
    /// The sides of outlines cross too often.
    #[error("found sides of outlines that cross {found} times, expected at most {limit}")]
    Crossings {
        /// How often they cross.
        found: u64,
        /// How often they may.
        limit: u64,
    },
    /// A closed mesh that had to be cut into convex cells first could not be.
    #[error(transparent)]
    Cells(#[from] ConvexTreeError),
    /// An operand that had to be evaluated first could not be.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}

impl ShapeError {
    /// The parameter that is to blame, as `docs/model-file.md` calls it.
    #[must_use]
    pub fn parameter(&self) -> Option<&'static str> {
        match self {
            Self::Parameter { parameter, .. } => Some(parameter),
            Self::CrossingSides { .. } => Some("slices"),
            _ => None,
        }
    }
}
