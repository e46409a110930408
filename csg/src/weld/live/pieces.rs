//! The half-edges of a boundary that changes, by number.

use std::cmp::Ordering;

use super::names::place;
use super::numbers::Context;
use crate::ids::{HalfEdgeId, Id, LoopId};
use crate::weld::cancel::HalfEdge;

/// Half-edges by number, and what is known of each.
#[derive(Clone, Default)]
pub(super) struct Pieces {
    pub(super) half_edges: Vec<HalfEdge>,
    /// What follows each in its loop.
    pub(super) following: Vec<HalfEdgeId>,
    /// The loop that each is part of.
    pub(super) loop_of: Vec<LoopId>,
    /// The place of each among those of its region.
    pub(super) places: Vec<u32>,
    /// Taken out; what else is said of such a half-edge is no longer true.
    pub(super) is_gone: Vec<bool>,
    pub(super) free: Vec<HalfEdgeId>,
    /// Gone since the last update; their numbers are not used again before it ends.
    pub(super) gone: Vec<HalfEdgeId>,
    /// Those whose way around their first corner may have changed.
    pub(super) turned: Vec<HalfEdgeId>,
}

impl Pieces {
    /// Makes room for many half-edges: where nothing is cut, there is one for each edge.
    pub(super) fn reserve(&mut self, count: usize) {
        self.half_edges.reserve(count);
        self.following.reserve(count);
        self.loop_of.reserve(count);
        self.places.reserve(count);
        self.is_gone.reserve(count);
    }

    pub(super) fn add(&mut self, piece: HalfEdge) -> HalfEdgeId {
        let piece = HalfEdge { twin: HalfEdgeId::NONE, ..piece };
        let number: HalfEdgeId = place(&mut self.half_edges, &mut self.free, piece);
        let at = number.index();
        if at == self.is_gone.len() {
            self.following.push(HalfEdgeId::NONE);
            self.loop_of.push(LoopId::NONE);
            self.places.push(0);
            self.is_gone.push(false);
        }
        (self.following[at], self.loop_of[at], self.is_gone[at]) = (HalfEdgeId::NONE, LoopId::NONE, false);
        number
    }

    pub(super) fn remove(&mut self, number: HalfEdgeId) {
        self.is_gone[number.index()] = true;
        self.gone.push(number);
    }

    /// The order of half-edges by where they begin and end, whatever their numbers.
    pub(super) fn compare(&self, context: &Context<'_>, p: HalfEdgeId, q: HalfEdgeId) -> Ordering {
        let Context { table, numbers } = *context;
        let [p, q] = [p, q].map(|piece| &self.half_edges[piece.index()]);
        numbers.compare(table, p.from, q.from).then_with(|| numbers.compare(table, p.to, q.to))
    }
}
