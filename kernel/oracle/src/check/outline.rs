//! What is seen from outside, against the exact outline: cheaper than the whole definition.

use planecut_kernel::DVec3;

use crate::outline::Outline;
use crate::replay::Replay;
use crate::structure::agree;

/// Compares emptiness, boundedness, counts and, for a bounded set, the correctly rounded positions with [`Outline`]. The
/// polytope must have the tolerance 0.
///
/// # Errors
/// The first difference.
pub fn compare_with_outline(replay: &Replay) -> Result<(), String> {
    let (polytope, outline) = (&replay.polytope, Outline::of(&replay.planes()));
    agree("is_empty", &polytope.is_empty(), &outline.empty)?;
    agree("is_bounded", &polytope.is_bounded(), &outline.bounded)?;
    agree("edge_count", &polytope.edge_count(), &outline.edges)?;
    let (positions, faces) = polytope.to_mesh();
    agree("finite vertices", &positions.len(), &outline.vertices.len())?;
    if !outline.bounded || outline.empty {
        return Ok(());
    }
    agree("vertex_count", &polytope.vertex_count(), &outline.vertices.len())?;
    agree("faces", &faces.len(), &outline.faces)?;
    let sorted = |mut list: Vec<[f64; 3]>| {
        list.sort_by(|a, b| a.partial_cmp(b).expect("coordinates are numbers"));
        list
    };
    let expected = outline.vertices.iter().map(|corner| corner.position).collect();
    agree("positions", &sorted(positions.iter().map(DVec3::to_array).collect()), &sorted(expected))
}
