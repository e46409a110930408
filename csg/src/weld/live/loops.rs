//! Loops of half-edges, chained again where something changed.

use smallvec::SmallVec;

use super::names::place;
use super::numbers::Context;
use super::pieces::Pieces;
use super::regions::Region;
use crate::ids::{FaceId, HalfEdgeId, Id, LoopId, PointId};
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::WeldError;
use crate::weld::loops::first_clockwise;
use crate::weld::nest::{Extent, LoopOf, RegionPlane};

/// The loops, by number.
#[derive(Clone, Default)]
pub(super) struct Loops {
    loops: Vec<Loop>,
    free: Vec<LoopId>,
    /// Lists of half-edges of loops that are gone, empty, for new ones.
    spare: Vec<Vec<HalfEdgeId>>,
}

/// Number of lists that are kept for new loops, and of half-edges up to which one is.
const SPARE: [usize; 2] = [64, 64];

/// A loop around a face, or around a hole of it.
#[derive(Clone)]
pub(super) struct Loop {
    /// Its half-edges in their order, from the one that is first by where it begins and ends.
    pub(super) pieces: Vec<HalfEdgeId>,
    pub(super) extent: Extent,
    pub(super) is_outer: bool,
    pub(super) face: FaceId,
    /// Its place among the holes of its face.
    pub(super) place: u32,
}

impl Loops {
    pub(super) fn get(&self, number: LoopId) -> &Loop {
        &self.loops[number.index()]
    }

    pub(super) fn get_mut(&mut self, number: LoopId) -> &mut Loop {
        &mut self.loops[number.index()]
    }

    /// A loop for what is asked of outlines.
    pub(super) fn outline<'a>(&'a self, pieces: &'a Pieces, number: LoopId) -> LoopOf<'a> {
        LoopOf { pieces: &self.get(number).pieces, half_edges: &pieces.half_edges, base: 0 }
    }

    /// Finds again what follows the half-edges that end where something changed in a region; gives the loops that are no longer what
    /// they were, ascending.
    pub(super) fn chain(
        &self,
        table: &PlaneTable,
        plane: PlaneId,
        region: &Region,
        pieces: &mut Pieces,
    ) -> Result<SmallVec<[LoopId; 8]>, WeldError> {
        let ends = |number: &HalfEdgeId| {
            let piece = &pieces.half_edges[number.index()];
            [piece.from, piece.to]
        };
        let mut points: SmallVec<[PointId; 32]> = region.new.iter().chain(&region.gone).flat_map(ends).collect();
        points.sort_unstable();
        points.dedup();
        let mut broken: SmallVec<[LoopId; 8]> = region.gone.iter().map(|gone| pieces.loop_of[gone.index()]).collect();
        let ends_at = region.ends_at(pieces, &points);
        let (mut outgoing, mut incoming) = (SmallVec::new(), SmallVec::new());
        let mut followed: SmallVec<[(HalfEdgeId, HalfEdgeId); 16]> = SmallVec::new();
        for point in points {
            ends_at.find_beginning(point, &mut outgoing);
            ends_at.find_ending(point, &mut incoming);
            for incoming in &incoming {
                let piece = &pieces.half_edges[incoming.index()];
                let candidates = outgoing.iter().map(|next| (*next, &pieces.half_edges[next.index()]));
                let next = first_clockwise(table, plane, piece, candidates).ok_or_else(|| WeldError::open(piece))?;
                if pieces.following[incoming.index()] != next {
                    followed.push((*incoming, next));
                }
            }
        }
        for (piece, next) in followed {
            pieces.following[piece.index()] = next;
            pieces.turned.push(pieces.half_edges[piece.index()].twin);
            broken.push(pieces.loop_of[piece.index()]);
        }
        broken.sort_unstable();
        broken.dedup();
        if broken.last() == Some(&LoopId::NONE) {
            broken.pop();
        }
        Ok(broken)
    }

    /// Takes a loop apart; gives what it was.
    pub(super) fn take(&mut self, pieces: &mut Pieces, number: LoopId) -> Loop {
        let extent = self.get(number).extent;
        let nothing = Loop { pieces: Vec::new(), extent, is_outer: false, face: FaceId::NONE, place: 0 };
        let gone = std::mem::replace(self.get_mut(number), nothing);
        for piece in &gone.pieces {
            pieces.loop_of[piece.index()] = LoopId::NONE;
        }
        self.free.push(number);
        gone
    }

    /// Keeps the list of half-edges of a loop that is gone, for a new one.
    pub(super) fn keep(&mut self, mut pieces: Vec<HalfEdgeId>) {
        let [lists, pieces_of_list] = SPARE;
        if self.spare.len() < lists && pieces.capacity() <= pieces_of_list {
            pieces.clear();
            self.spare.push(pieces);
        }
    }

    /// Makes the loop of a half-edge that is in none.
    pub(super) fn walk(
        &mut self,
        context: &Context<'_>,
        plane: &RegionPlane<'_>,
        pieces: &mut Pieces,
        start: HalfEdgeId,
    ) -> LoopId {
        let mut members = self.spare.pop().unwrap_or_default();
        let mut piece = start;
        loop {
            members.push(piece);
            piece = pieces.following[piece.index()];
            if piece == start {
                break;
            }
        }
        begin_with_first(context, pieces, &mut members);
        let outline = LoopOf { pieces: &members, half_edges: &pieces.half_edges, base: 0 };
        let extent = plane.extent(outline);
        let is_outer = plane.is_outer(outline, &extent);
        let new = Loop { pieces: members, extent, is_outer, face: FaceId::NONE, place: 0 };
        let number: LoopId = place(&mut self.loops, &mut self.free, new);
        for piece in &self.loops[number.index()].pieces {
            pieces.loop_of[piece.index()] = number;
        }
        number
    }

    /// Measures a loop again whose corners have moved.
    pub(super) fn follow(&mut self, context: &Context<'_>, plane: &RegionPlane<'_>, pieces: &Pieces, number: LoopId) {
        let entry = self.get_mut(number);
        begin_with_first(context, pieces, &mut entry.pieces);
        entry.extent = plane.extent(LoopOf { pieces: &entry.pieces, half_edges: &pieces.half_edges, base: 0 });
    }
}

/// Turns a loop so that it begins with its first half-edge.
fn begin_with_first(context: &Context<'_>, pieces: &Pieces, members: &mut [HalfEdgeId]) {
    let order = |p: &usize, q: &usize| pieces.compare(context, members[*p], members[*q]);
    let first = (0..members.len()).min_by(order).unwrap_or_default();
    members.rotate_left(first);
}
