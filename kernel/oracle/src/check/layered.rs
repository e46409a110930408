//! All checks in layers, cheap ones first: what fuzzing runs after every operation.

use super::{compare_with_fresh_build, compare_with_outline, compare_with_truth};
use crate::replay::Replay;

/// Most planes that are compared with the exact outline.
const OUTLINE_PLANES: usize = 12;
/// Most planes that are compared with the whole definition, and one operation in how many.
const TRUTH: (usize, usize) = (8, 16);

/// The kernel's invariants and a fresh build always, the exact outline where there are few planes, the whole definition
/// now and then. The polytope must have the tolerance 0.
///
/// # Errors
/// The first layer that finds something, and what.
pub fn check_in_layers(replay: &Replay) -> Result<(), String> {
    compare_with_fresh_build(replay)?;
    let planes = replay.order().len();
    if planes <= OUTLINE_PLANES {
        compare_with_outline(replay)?;
    }
    if planes <= TRUTH.0 && replay.tally.operations.is_multiple_of(TRUTH.1) {
        compare_with_truth(replay)?;
    }
    Ok(())
}
