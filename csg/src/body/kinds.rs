//! Bodies that are equal.

use std::hash::Hash;

use smallvec::SmallVec;

use crate::base::hash_of;
use crate::ids::{Id, LeafId};
use crate::model::MaterialId;
use crate::plane_table::PlaneId;

/// For the body of each leaf the first leaf with an equal one: equal for bodies with the same faces of the same materials, and for no others; `faces` gives the planes
/// and materials of those of a body, and `mark` a [`mark_of`] them.
pub(crate) fn kinds<I: Iterator<Item = (PlaneId, MaterialId)>>(
    bodies: usize,
    faces: impl Fn(LeafId) -> I,
    mark: impl Fn(LeafId) -> u64,
) -> Vec<LeafId> {
    let sorted = |number: LeafId| {
        let mut faces: SmallVec<[(PlaneId, MaterialId); 16]> = faces(number).collect();
        faces.sort_unstable();
        faces
    };
    // those of bodies that were made alike are in the same order
    let are_equal = |a: LeafId, b: LeafId| faces(a).eq(faces(b)) || sorted(a) == sorted(b);
    // without faces the mark is 0; to look at the faces of each would take longer
    let is_body = |&(mark, number): &(u64, LeafId)| mark != 0 || faces(number).next().is_some();
    let mut marked: SmallVec<[(u64, LeafId); 32]> =
        LeafId::all(bodies).map(|number| (mark(number), number)).filter(is_body).collect();
    marked.sort_unstable();
    let mut kinds: Vec<LeafId> = LeafId::all(bodies).collect();
    let mut different: SmallVec<[LeafId; 8]> = SmallVec::new();
    for alike in marked.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
        different.clear();
        for &(_, number) in alike {
            match different.iter().find(|first| are_equal(**first, number)) {
                Some(first) => kinds[number.index()] = *first,
                None => different.push(number),
            }
        }
    }
    kinds
}

/// A number that faces of the same planes and materials share, whatever their order.
pub(crate) fn mark_of(faces: impl Iterator<Item = (PlaneId, MaterialId)>) -> u64 {
    mark_of_faces(faces)
}

/// The same of faces that are told in another way.
pub(crate) fn mark_of_faces<F: Hash>(faces: impl Iterator<Item = F>) -> u64 {
    // the hash is linear in what it is of, so that sums of it would be the same wherever sums of plane numbers are
    let mixed = |face: F| {
        let hash = hash_of(&face);
        let folded = (hash ^ hash >> 32).wrapping_mul(0xD6E8_FEB8_6659_FD93);
        folded ^ folded >> 32
    };
    faces.map(mixed).fold(0, u64::wrapping_add)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_of_a_grid_have_different_marks() {
        let planes = |x: u32, y: u32| [2 * x, 2 * x + 1, 2000 + 2 * y, 2001 + 2 * y].map(PlaneId::of_index);
        let mark = |x, y| mark_of(planes(x, y).into_iter().map(|plane| (plane, MaterialId(0))));
        let mut marks: Vec<u64> = (0..200).flat_map(|x| (0..200).map(move |y| mark(x, y))).collect();
        marks.sort_unstable();
        marks.dedup();
        assert_eq!(marks.len(), 200 * 200);
    }
}
