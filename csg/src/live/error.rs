//! Why an edit is refused.

use planecut_kernel::PlaneIdx;
use thiserror::Error;

use super::BrushId;
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
    /// The brush is an operand of a nested operation, which is not one after another.
    #[error("found brush {} within nested operations, expected one that is added, subtracted or intersected by itself", .0.0)]
    Nested(BrushId),
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
