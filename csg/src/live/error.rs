//! Why an edit is refused.

use planecut_kernel::PlaneIdx;
use thiserror::Error;

use super::{BrushId, NodeId, TreeOperand};
use crate::evaluate::EvaluateError;
use crate::model::TransformError;

/// Why an edit was refused; the model is as it was, but after [`EvaluateError::Weld`], a bug in this crate.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum EditError {
    /// There is no such brush, or no longer.
    #[error("found brush {}, expected one that is part of the model", .0.0)]
    UnknownBrush(BrushId),
    /// The brush has no such plane, or no longer.
    #[error("found plane {} of brush {}, expected a plane that the brush has", .plane.0, .brush.0)]
    UnknownPlane {
        /// The brush.
        brush: BrushId,
        /// The plane.
        plane: PlaneIdx,
    },
    /// The brush is a closed mesh, which has no planes.
    #[error("found brush {}, which is a closed mesh, expected one of planes", .0.0)]
    Mesh(BrushId),
    /// The brush or operation is an operand of an operation, and no part of the model itself.
    #[error("found {0} within nested operations, expected one that is added, subtracted or intersected by itself")]
    Nested(TreeOperand),
    /// There is no such operation, or no longer.
    #[error("found node {}, expected an operation that is part of the model", .0.0)]
    UnknownNode(NodeId),
    /// Something is to be put before what is elsewhere.
    #[error("found {operand}, expected an operand of {}", within(.of))]
    NotAnOperand {
        /// What is elsewhere.
        operand: TreeOperand,
        /// Where it should be; `None` is the model itself.
        of: Option<NodeId>,
    },
    /// An operation is to be put below itself.
    #[error("found node {} to be put below itself, expected an operation elsewhere", .0.0)]
    WithinItself(NodeId),
    /// Nothing is named where something must be.
    #[error("found none, expected at least one brush or operation")]
    NoOperands,
    /// Something is named twice.
    #[error("found {0} twice, expected each once")]
    Twice(TreeOperand),
    /// Operands of different operations are to become those of one.
    #[error("found {} and {}, expected operands of one operation", .0[0], .0[1])]
    Apart([TreeOperand; 2]),
    /// There would be too many copies.
    #[error("found {found} copies, expected at most {limit}")]
    Copies {
        /// How many there would be.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The offset of a plane is out of range.
    #[error("found a plane at offset {0:?}, expected a finite one that is not too large for its normal")]
    Offset(f64),
    /// A plane leaves the accepted range as it is transformed.
    #[error(transparent)]
    Transform(#[from] TransformError),
    /// There is an open step, which is to be committed or cancelled first.
    #[error("found a step that is open, expected it to be committed or cancelled before")]
    StepOpen,
    /// There is no open step.
    #[error("found no step that is open, expected one that was begun")]
    NoStep,
    /// There is no edit to take back.
    #[error("found nothing to take back, expected an edit before")]
    NothingToUndo,
    /// There is no edit to do again.
    #[error("found nothing to do again, expected an edit that was undone just before")]
    NothingToRedo,
    /// As for a model that is evaluated: the solid is unbounded, a face names an unknown material, or the boundary does not
    /// close.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}

fn within(of: &Option<NodeId>) -> String {
    of.map_or_else(|| "the model itself".to_owned(), |node| format!("node {}", node.0))
}
