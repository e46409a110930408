//! Typed numbers: a number of one kind of thing cannot be taken for that of another, nor for a count or a place in a list.
//!
//! Each is the place of a thing in the list of its kind, kept in 32 bits. They sort and hash as these bare numbers do.

use std::fmt::Debug;
use std::hash::Hash;

/// The number of a thing of one kind.
pub(crate) trait Id: Copy + Ord + Hash + Debug + Send + Sync {
    /// The number of no thing. It is greater than all others.
    const NONE: Self;

    /// The number of what has a place in the list of its kind.
    ///
    /// # Panics
    /// Where the place does not fit into 32 bits, or is [`NONE`](Self::NONE).
    fn from_index(index: usize) -> Self;

    /// The place in the list of its kind.
    fn index(self) -> usize;

    /// The bare number, for messages and public results.
    fn number(self) -> u32;

    /// The number this many further on.
    fn plus(self, count: usize) -> Self {
        Self::from_index(self.index() + count)
    }

    /// The numbers of all things of a list, in order.
    fn all(count: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
        (0..count).map(Self::from_index)
    }
}

/// Whether a typed number is in a list, for lists that are searched over and over. They are searched eight numbers at a time without a
/// branch between them: `contains` of the standard library does so for bare numbers alone, and compares others one by one.
#[inline]
pub(crate) fn holds<T: Copy + Eq>(list: &[T], number: T) -> bool {
    list.chunks(8).any(|chunk| chunk.iter().fold(false, |is_found, other| is_found | (*other == number)))
}

/// The first place of a typed number in a list, for lists that are searched over and over: as [`holds`].
#[inline]
pub(crate) fn place_of<T: Copy + Eq>(list: &[T], number: T) -> Option<usize> {
    list.chunks(8).enumerate().find_map(|(chunk, some)| {
        let first = |first, (place, other): (usize, &T)| if *other == number { place } else { first };
        let place = some.iter().enumerate().rev().fold(some.len(), first);
        (place < some.len()).then_some(8 * chunk + place)
    })
}

/// A count, or the place of a thing in a list, in 32 bits.
///
/// # Panics
/// Where it does not fit.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "asserted")]
pub(crate) fn number32(count: usize) -> u32 {
    assert!(count <= u32::MAX as usize, "too many things of one kind for numbers of 32 bits");
    count as u32
}

macro_rules! ids {
    ($($(#[$attribute:meta])* $visibility:vis $name:ident;)*) => {
        $(
            $(#[$attribute])*
            #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
            #[repr(transparent)]
            $visibility struct $name(u32);

            impl Id for $name {
                const NONE: Self = Self(u32::MAX);

                #[inline]
                fn from_index(index: usize) -> Self {
                    // without arguments, so that nothing but a call of a cold function is inlined beside the comparison
                    assert!(index < u32::MAX as usize, "too many things of one kind for numbers of 32 bits");
                    Self(number32(index))
                }

                #[inline]
                fn index(self) -> usize {
                    self.0 as usize
                }

                #[inline]
                fn number(self) -> u32 {
                    self.0
                }
            }
        )*
    };
}

ids! {
    /// A leaf of a tree, in the order of its brushes.
    pub(crate) LeafId;

    /// A node of a tree, in postfix order.
    pub(crate) TreeNodeId;

    /// A node of a restricted expression.
    pub(crate) BranchId;

    /// A leaf that a restricted expression keeps, in the order of these.
    pub(crate) KeptLeafId;

    /// A body of those of which the boundary is taken.
    pub(crate) BodyId;

    /// A corner of a body, whichever of its faces it is seen in.
    pub(crate) CornerId;

    /// A face of a body, in the order of its faces.
    pub(crate) BodyFaceId;

    /// A brush of a live model by its place, which another brush may have once it is gone.
    pub(crate) OperandId;

    /// Rows of exactly one plane in a live model.
    pub(crate) RowGroupId;

    /// A body among those near another one.
    pub(crate) NearId;

    /// A part of a face that another body covers.
    pub(crate) SectionId;

    /// A point of a weld or an arrangement: equal points have one number, whichever planes meet there.
    pub(crate) PointId;

    /// A line of a weld: equal lines have one number, whichever planes meet there.
    pub(crate) LineId;

    /// A region of a weld: an oriented plane with a material.
    pub(crate) RegionId;

    /// A half-edge of the boundary: an elementary piece of a line along which a region ends on one side.
    pub(crate) HalfEdgeId;

    /// A loop of half-edges around a face, or around a hole of one, in a boundary that changes.
    pub(crate) LoopId;

    /// A corner in the boundary of a face that is triangulated, bridges included.
    pub(crate) NodeId;

    /// A site of a Delaunay triangulation: a corner of a face.
    pub(crate) SiteId;

    /// A triangle, of a face that is triangulated or among those of an arrangement.
    pub(crate) TriangleId;

    /// A vertex of an operand of an arrangement, by its place among those of all operands, one operand after another.
    pub(crate) InputVertexId;

    /// A triangle of an operand of an arrangement, likewise.
    pub(crate) InputTriangleId;

    /// A connected part of an operand that nothing touches.
    pub(crate) PatchId;

    /// A facet of an arrangement: a triangle, a cell of one, or a patch.
    pub(crate) FacetId;

    /// Winding numbers of all operands in a part of space.
    pub(crate) StateId;

    /// A vertex of the mesh.
    pub(crate) VertexId;

    /// A boundary edge, before opposite ones cancel.
    pub(crate) EdgeId;

    /// The number of a face, as long as it stays as it is.
    pub FaceId;

    /// A name of a point, three planes, or of a line, two planes: several names may stand for one thing.
    pub(crate) NameId;
}

impl From<FaceId> for u32 {
    /// The bare number, for other programs: [`FaceId::from`] takes it back.
    fn from(face: FaceId) -> Self {
        face.0
    }
}

impl From<u32> for FaceId {
    fn from(number: u32) -> Self {
        Self(number)
    }
}

/// A face of the body of a brush of a live model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct OperandFace {
    pub(crate) operand: OperandId,
    pub(crate) face: BodyFaceId,
}

/// A point on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct PointOnLine {
    pub(crate) line: LineId,
    pub(crate) point: PointId,
}

/// A line in one of its two directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct DirectedLine(u32);

impl DirectedLine {
    /// A line along its own direction, or back.
    #[inline]
    pub(crate) fn new(line: LineId, forward: bool) -> Self {
        assert!(line.0 <= u32::MAX >> 1, "too many lines for numbers of 31 bits");
        Self(line.0 << 1 | u32::from(forward))
    }

    /// The line in either direction.
    #[inline]
    pub(crate) fn line(self) -> LineId {
        LineId(self.0 >> 1)
    }

    /// Whether it has the line's own direction.
    #[inline]
    pub(crate) fn is_forward(self) -> bool {
        self.0 & 1 == 1
    }
}

/// A point at the border of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct PointOfRegion {
    pub(crate) region: RegionId,
    pub(crate) point: PointId,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_32_bits_and_sort_by_place() {
        assert_eq!(size_of::<PointId>(), size_of::<u32>());
        let sorted: Vec<PointId> = PointId::all(3).chain([PointId::NONE]).collect();
        assert!(sorted.is_sorted_by(|a, b| a < b));
        assert_eq!(sorted.iter().take(3).map(|id| id.index()).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn directed_lines_keep_line_and_direction() {
        assert_eq!(size_of::<DirectedLine>(), size_of::<u32>());
        for index in [0, 1, 12_345, (1 << 31) - 1] {
            for forward in [false, true] {
                let along = DirectedLine::new(LineId::from_index(index), forward);
                assert_eq!((along.line().index(), along.is_forward()), (index, forward));
            }
        }
    }

    #[test]
    #[should_panic(expected = "too many lines")]
    fn no_line_has_a_number_of_32_bits() {
        let _ = DirectedLine::new(LineId::from_index(1 << 31), true);
    }

    #[test]
    fn a_list_holds_what_is_in_it() {
        for count in 0..20 {
            let list: Vec<PointId> = PointId::all(count).collect();
            assert!(list.iter().all(|id| holds(&list, *id)));
            assert!(!holds(&list, PointId::from_index(count)) && !holds(&list, PointId::NONE));
            assert!(list.iter().enumerate().all(|(place, id)| place_of(&list, *id) == Some(place)));
            assert_eq!(place_of(&list, PointId::NONE), None);
            let twice = [list.clone(), list].concat();
            assert!(twice[..count].iter().enumerate().all(|(place, id)| place_of(&twice, *id) == Some(place)));
        }
    }

    #[test]
    #[should_panic(expected = "too many")]
    fn no_thing_has_the_number_of_none() {
        let _ = PointId::from_index(PointId::NONE.index());
    }
}
