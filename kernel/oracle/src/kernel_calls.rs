//! The kernel's calls that scripts need, in one place.

use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, PlaneIdx};

use crate::exact::Coefficients;
use crate::handles::Changes;

/// The kernel's half-space.
///
/// # Panics
/// Where the coefficients are outside the accepted range; the generators stay inside.
#[must_use]
pub fn half_space(c: Coefficients) -> HalfSpace {
    HalfSpace::new(DVec3::new(c[0], c[1], c[2]), c[3]).unwrap_or_else(|e| panic!("generated plane {c:?}: {e}"))
}

/// Whether the kernel accepts these coefficients.
#[must_use]
pub fn is_accepted(c: Coefficients) -> bool {
    HalfSpace::new(DVec3::new(c[0], c[1], c[2]), c[3]).is_ok()
}

/// Removes several planes; gives the number of them that were there.
pub(crate) fn remove_planes(polytope: &mut IncrementalPolytope, planes: &[PlaneIdx]) -> (usize, Changes) {
    let result = polytope.remove_planes(planes);
    let (removed, new) = (result.removed_vertices.to_vec(), result.new_vertices.to_vec());
    (result.count, Changes { removed, new, moved: Vec::new() })
}

/// Gives a plane a new half-space at its age.
///
/// # Errors
/// An answer that cannot be right.
pub(crate) fn move_plane(
    polytope: &mut IncrementalPolytope,
    plane: PlaneIdx,
    to: HalfSpace,
) -> Result<Changes, String> {
    let before = (polytope.plane(plane).copied(), polytope.stamp(plane));
    let moved = polytope.move_plane(plane, to).ok_or_else(|| format!("{plane:?} cannot be moved"))?;
    let (previous, has_face) = (moved.previous, moved.has_face);
    let (removed, new) = (moved.removed_vertices.to_vec(), moved.new_vertices.to_vec());
    let changes = Changes { removed, new, moved: moved.moved_vertices.to_vec() };
    if before != (Some(previous), polytope.stamp(plane)) {
        return Err(format!("{plane:?} was {before:?}, was moved from {previous:?} to {:?}", polytope.stamp(plane)));
    }
    if has_face == polytope.is_redundant(plane) {
        return Err(format!("{plane:?} was moved: has a face {has_face}, redundant {has_face}"));
    }
    Ok(changes)
}
