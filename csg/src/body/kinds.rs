//! Bodies that are equal.

use std::hash::BuildHasher;

use rustc_hash::{FxBuildHasher, FxHashMap};

use super::BodyFace;
use crate::ids::{Id, LeafId};
use crate::model::MaterialId;
use crate::plane_table::PlaneId;

/// For the body of each leaf the first leaf with an equal one: equal for bodies with the same faces of the same materials, and for no others; `faces` gives those of a
/// body, and `mark` a [`mark_of`] them.
pub(crate) fn kinds<'a>(
    bodies: usize,
    faces: impl Fn(LeafId) -> &'a [BodyFace],
    mark: impl Fn(LeafId) -> u64,
) -> Vec<LeafId> {
    let sorted = |number: LeafId| {
        let mut faces: Vec<(PlaneId, MaterialId)> =
            faces(number).iter().map(|face| (face.plane, face.material)).collect();
        faces.sort_unstable();
        faces
    };
    let mut known: FxHashMap<u64, Vec<LeafId>> = FxHashMap::default();
    let kind = |number: LeafId| {
        if faces(number).is_empty() {
            return number;
        }
        let alike = known.entry(mark(number)).or_default();
        let equal = (!alike.is_empty()).then(|| sorted(number));
        let first = equal.and_then(|own| alike.iter().copied().find(|other| sorted(*other) == own));
        first.unwrap_or_else(|| {
            alike.push(number);
            number
        })
    };
    LeafId::all(bodies).map(kind).collect()
}

/// A number that faces of the same planes and materials share, whatever their order.
pub(crate) fn mark_of(faces: &[BodyFace]) -> u64 {
    let each = faces.iter().map(|face| FxBuildHasher.hash_one((face.plane, face.material)));
    each.fold(0, u64::wrapping_add)
}
