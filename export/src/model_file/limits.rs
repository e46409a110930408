//! What the reader of model files takes at most, so that nothing is written that it would refuse.

use glam::DVec3;
use planecut_csg::Brush;

use super::nesting::{NOTHING_DEPTH, Piece};
use crate::ExportError;

/// Most nodes around a node.
const MAX_DEPTH: usize = 10_000;
/// Most brushes.
const MAX_BRUSHES: usize = 1 << 22;
/// Most planes, triangles of meshes counted.
const MAX_PLANES: usize = 1 << 25;
/// Largest magnitude of a coordinate of a mesh.
const MAX_COORDINATE: f64 = f64::from_bits((1023 + 100) << 52);
/// Most bytes of a text.
pub(super) const MAX_TEXT: u64 = 1 << 30;

/// Sees, before the first byte is written, that a reader takes what the pieces say.
///
/// # Errors
/// [`ExportError::ModelLimit`].
pub(super) fn check(pieces: &[Piece], brushes: &[Brush]) -> Result<(), ExportError> {
    let depth = depth(pieces);
    if depth > MAX_DEPTH {
        return refuse(format!("operations within one another in {depth} levels"), format!("at most {MAX_DEPTH}"));
    }
    if brushes.len() > MAX_BRUSHES {
        return refuse(format!("{} brushes", brushes.len()), format!("at most {MAX_BRUSHES}"));
    }
    let triangles = |brush: &Brush| brush.mesh.as_ref().map_or(0, |mesh| mesh.mesh().triangles().len());
    let planes: usize = brushes.iter().map(|brush| brush.faces.len() + triangles(brush)).sum();
    if planes > MAX_PLANES {
        return refuse(format!("{planes} planes and triangles"), format!("at most {MAX_PLANES}"));
    }
    Ok(())
}

/// How many nodes are around the innermost one.
fn depth(pieces: &[Piece]) -> usize {
    let (mut open, mut deepest) = (0_usize, 0);
    for piece in pieces {
        let below = match *piece {
            Piece::Open(_) => {
                open += 1;
                continue;
            }
            Piece::Close => {
                open -= 1;
                continue;
            }
            Piece::Leaf(_) => 0,
            Piece::Nothing => NOTHING_DEPTH,
        };
        deepest = deepest.max(open + below);
    }
    deepest
}

/// Whether a vertex of a mesh may be there.
pub(super) fn is_accepted(position: DVec3) -> bool {
    let is_accepted = |value: f64| value == 0.0 || (f64::MIN_POSITIVE..=MAX_COORDINATE).contains(&value.abs());
    position.to_array().into_iter().all(is_accepted)
}

/// The error of a model that could not be read.
///
/// # Errors
/// Always.
pub(super) fn refuse<T>(found: String, expected: String) -> Result<T, ExportError> {
    Err(ExportError::ModelLimit { found, expected })
}
