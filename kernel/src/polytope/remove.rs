//! Removing a plane: the edges that ended on its face grow until they meet the next plane (paper §3), made local.
//!
//! Only planes adjacent to the removed face, and planes whose certificate it carried, can bound the new region
//! (the removal lemma, `docs/kernel.md`). [`super::fill`] closes the hole from the ring of the face. Where the ring does not close, the
//! region is open and reaches the infinity planes: like a large ring with uneven parts it is then built as a cap of its
//! own ([`super::remove_large`]).

use super::store::{BEFORE, Link, NEXT, PlaneState, Steps};
use super::{IncrementalPolytope, PlaneIdx, RemovePlaneResult, VertexIdx};
use std::hint::black_box;

/// With more vertices than this, the caches near the processor do not hold them.
const LARGE: usize = 50_000;

/// A plane of the ring, and the kept end of the edge between it and the next plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct RingEdge {
    pub(super) plane: u32,
    pub(super) end: Link,
}

impl IncrementalPolytope {
    /// Removes a half-space: the set becomes what it would be had the plane never been added (paper §3.3).
    ///
    /// `None` where there is no such plane. Cost: `k log k` for a face with `k` neighbours, and adding the planes it hid; not
    /// that of the polytope.
    pub fn remove_plane(&mut self, idx: PlaneIdx) -> Option<RemovePlaneResult<'_>> {
        let plane = self.live(idx)?;
        let half_space = *self.planes.half_space(plane);
        let had_face = !self.is_empty() && self.planes.has_face(plane);
        self.begin_change(Steps::Several);
        self.remove_slot(plane);
        let change = self.finish_change();
        let (removed_vertices, new_vertices) = (change.removed.as_slice(), change.created.as_slice());
        Some(RemovePlaneResult { half_space, had_face, removed_vertices, new_vertices })
    }

    /// Takes a plane out of the structure and frees its slot.
    pub(super) fn remove_slot(&mut self, plane: u32) {
        if self.planes.state(plane) == PlaneState::Pending {
            self.remove_pending(plane);
            return;
        }
        let was_empty = self.is_empty();
        self.release_hidden(plane);
        if self.scratch.to_examine.is_empty() {
            // nothing that is made now will be taken away again
            self.vertices.set_steps(Steps::One);
        }
        self.take_out(plane);
        self.planes.remove(plane);
        self.examine_again();
        if was_empty {
            self.after_loss(&[plane]);
        }
    }

    /// Takes a plane out of the structure and keeps its slot; the planes that it hid wait in the scratch for
    /// [`examine_again`](Self::examine_again).
    pub(super) fn detach(&mut self, plane: u32) {
        self.release_hidden(plane);
        self.take_out(plane);
    }

    /// Puts the planes that a plane hides into the scratch.
    fn release_hidden(&mut self, plane: u32) {
        self.certify_orphans();
        let mut examine = std::mem::take(&mut self.scratch.to_examine);
        self.take_certified(plane, &mut examine);
        self.scratch.to_examine = examine;
    }

    /// Takes a plane out of the structure that hides nothing.
    #[inline]
    fn take_out(&mut self, plane: u32) {
        if self.planes.has_face(plane) {
            self.open_face(plane);
            self.planes.set_without_face(plane, PlaneState::Uncertified);
        } else {
            self.forget_certificate(plane);
        }
    }

    /// Lets the planes take part again that lost their certificates.
    pub(super) fn examine_again(&mut self) {
        if self.scratch.to_examine.is_empty() {
            return;
        }
        let mut examine = std::mem::take(&mut self.scratch.to_examine);
        for &hidden in &examine {
            // The cap may have shown it already: an infinity plane beyond an open ring.
            if self.planes.state(hidden) == PlaneState::Uncertified {
                self.insert_into_structure(hidden);
            }
        }
        examine.clear();
        self.scratch.to_examine = examine;
    }

    /// Removes a face and closes the hole with the planes of its ring.
    pub(super) fn open_face(&mut self, plane: u32) {
        let mut ring = std::mem::take(&mut self.scratch.ring);
        let mut cut = std::mem::take(&mut self.scratch.cut);
        ring.clear();
        cut.clear();
        self.walk_ring(plane, &mut ring, &mut cut);
        self.discard_vertices(&cut);
        self.close_hole(&ring, plane);
        self.scratch.ring = ring;
        self.scratch.cut = cut;
    }

    /// Closes a hole with the planes of its ring; `opened` is a plane whose face was there.
    pub(super) fn close_hole(&mut self, ring: &[RingEdge], opened: u32) {
        let first = self.change.created.len();
        if !self.fill(ring) {
            for VertexIdx(vertex) in self.change.created.split_off(first) {
                self.vertices.remove(vertex);
            }
            self.fill_with_cap(ring, opened);
        }
        self.starts.set_latest(self.change.created[first].0, self.planes.row(opened));
    }

    /// The planes around a face, each with where the edge to the next one continues; and its vertices.
    pub(super) fn walk_ring(&self, plane: u32, ring: &mut Vec<RingEdge>, face: &mut Vec<u32>) {
        if self.vertices.len() > LARGE {
            self.fetch_face(plane);
        }
        for (vertex, k) in self.vertices.face_corners(plane, self.planes.face_vertex(plane)) {
            let p = self.vertices.planes(vertex)[NEXT[k]];
            ring.push(RingEdge { plane: p, end: self.vertices.link(vertex, k) });
            face.push(vertex);
        }
    }

    /// Touches what the removal of a face will need, both ways around it at once from two of its vertices: far fewer waits for
    /// memory follow one another then.
    #[inline(never)]
    fn fetch_face(&self, plane: u32) {
        let start = self.planes.face_vertex(plane);
        let other = self.planes.other_face_vertex(plane);
        let from = |vertex| (vertex, self.vertices.index_of(vertex, plane));
        let is_apart = other != start && self.vertices.is_on(other, plane);
        let mut ends = [from(start); 2];
        self.fetch_corner(ends[0]);
        if is_apart {
            let mut ends = [from(other); 2];
            self.fetch_corner(ends[0]);
            self.fetch_ahead(&mut ends);
        }
        for _ in 0..if is_apart { 2 } else { 3 } {
            self.fetch_ahead(&mut ends);
        }
    }

    /// Goes one step along a face, at one end ahead and at the other back.
    #[inline(always)]
    fn fetch_ahead(&self, ends: &mut [(u32, usize); 2]) {
        let [(ahead, i), (behind, j)] = *ends;
        let (next, before) = (self.vertices.link(ahead, NEXT[i]), self.vertices.link(behind, BEFORE[j]));
        *ends = [(next.vertex(), NEXT[next.index()]), (before.vertex(), BEFORE[before.index()])];
        for corner in *ends {
            self.fetch_corner(corner);
        }
    }

    /// Touches what lies beside a corner.
    #[inline(always)]
    fn fetch_corner(&self, (vertex, k): (u32, usize)) {
        black_box(self.planes.row(self.vertices.planes(vertex)[NEXT[k]]).coefficients()[0]);
        black_box(self.vertices.planes(self.vertices.link(vertex, k).vertex())[0]);
    }
}
