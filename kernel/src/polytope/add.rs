//! Adding a plane: climb to the extreme vertex, cut what it violates, close the hole with the new face.

use super::redundant::Orphan;
use super::store::{BEFORE, Change, Link, NEXT, NONE, PlaneState, Steps};
use super::{AddPlaneResult, IncrementalPolytope, VertexIdx, external};
use crate::half_space::HalfSpace;
use crate::sign::Row;

/// What inserting one plane into the structure did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Insertion {
    /// It has a face now.
    Cut,
    /// It is redundant.
    Redundant,
    /// Every vertex violates it; nothing was changed.
    Empty,
}

impl IncrementalPolytope {
    /// Adds a half-space: the set becomes its intersection with it (paper §3 and Appendix C; orphaned faces need no
    /// repair here, because the structure is simple).
    ///
    /// Cost: a climb from the place of the last change, then proportional to the vertices cut away.
    pub fn add_plane(&mut self, half_space: HalfSpace) -> AddPlaneResult<'_> {
        let slot = self.planes.insert(half_space, Row::new(&half_space));
        let plane = external(slot);
        if self.is_empty() {
            self.planes.set_without_face(slot, PlaneState::Pending);
            self.pending.push(slot);
            return AddPlaneResult::Empty { plane };
        }
        self.begin_change(Steps::One);
        match self.insert_into_structure(slot) {
            Insertion::Cut => {
                let Change { removed, created, .. } = &self.change;
                AddPlaneResult::Added { plane, removed_vertices: removed, new_vertices: created }
            }
            Insertion::Redundant => AddPlaneResult::Redundant { plane },
            Insertion::Empty => {
                self.become_empty(slot);
                AddPlaneResult::Empty { plane }
            }
        }
    }

    /// Lets a stored plane take part; it must carry no certificate.
    pub(super) fn insert_into_structure(&mut self, plane: u32) -> Insertion {
        let top = self.climb(self.row(plane), self.hint);
        self.hint = top;
        if !self.is_outside(top, plane) {
            self.certify(plane, top);
            return Insertion::Redundant;
        }
        if !self.collect_cut(plane, top) {
            return Insertion::Empty;
        }
        self.cut_away(plane);
        Insertion::Cut
    }

    /// Collects all vertices outside `plane` into the scratch, beginning with `top`; false where no vertex is left.
    /// With them, the edges that leave them.
    pub(super) fn collect_cut(&mut self, plane: u32, top: u32) -> bool {
        self.vertices.begin_visit();
        let mut cut = std::mem::take(&mut self.scratch.cut);
        let mut horizon = std::mem::take(&mut self.scratch.horizon);
        cut.clear();
        horizon.clear();
        cut.push(top);
        self.vertices.set_visited(top);
        let mut next = 0;
        while let Some(&vertex) = cut.get(next) {
            next += 1;
            for (k, link) in self.vertices.links(vertex).into_iter().enumerate() {
                let neighbour = link.vertex();
                if self.vertices.is_visited(neighbour) {
                    continue;
                }
                if self.is_outside(neighbour, plane) {
                    self.vertices.set_visited(neighbour);
                    cut.push(neighbour);
                } else {
                    horizon.push(Link::new(vertex, k));
                }
            }
        }
        let some_stay = !horizon.is_empty();
        self.scratch.cut = cut;
        self.scratch.horizon = horizon;
        some_stay
    }

    /// Replaces the collected vertices by the face of `plane`.
    fn cut_away(&mut self, plane: u32) {
        let cut = std::mem::take(&mut self.scratch.cut);
        let horizon = std::mem::take(&mut self.scratch.horizon);
        let first = self.change.created.len();
        self.create_horizon(plane, &horizon);
        self.link_horizon(first);
        let face_vertex = self.change.created[first].0;
        self.planes.set_face(plane, face_vertex);
        self.hint = face_vertex;
        // A connected part of `cut` vertices without a face in it has `cut + 2` edges that leave it (Euler).
        if horizon.len() != cut.len() + 2 {
            self.hide_orphans(plane, &cut);
        }
        for &vertex in &cut {
            self.discard_vertex(vertex);
        }
        self.scratch.cut = cut;
        self.scratch.horizon = horizon;
    }

    /// One new vertex `(plane, p, q)` for each edge that leaves the cut vertices; `mark[p]` remembers it.
    fn create_horizon(&mut self, plane: u32, horizon: &[Link]) {
        for edge in horizon {
            // The cut vertex (a, p, q) moves to where its edge p, q meets the plane.
            let (vertex, k) = (edge.vertex(), edge.index());
            let planes = self.vertices.planes(vertex);
            let (p, q) = (planes[NEXT[k]], planes[BEFORE[k]]);
            let kept = self.vertices.link(vertex, k);
            let point = self.meeting_point([plane, p, q]);
            let fresh = self.vertices.insert([plane, p, q], point);
            self.vertices.join(Link::new(fresh, 0), kept);
            self.planes.set_mark(p, fresh);
            self.planes.set_face(p, fresh);
            self.change.created.push(VertexIdx(fresh));
        }
    }

    /// Links the new vertices around the new face: `(plane, p, q)` is followed by the one that has `q` in second place.
    fn link_horizon(&mut self, first: usize) {
        for &VertexIdx(vertex) in &self.change.created[first..] {
            let [_, _, q] = self.vertices.planes(vertex);
            let following = self.planes.mark(q);
            self.vertices.join(Link::new(vertex, 1), Link::new(following, 2));
        }
    }

    /// Planes that lost all their vertices ("orphaned faces", paper Appendix C) are redundant from now on.
    fn hide_orphans(&mut self, plane: u32, cut: &[u32]) {
        for &vertex in cut {
            for p in self.vertices.planes(vertex) {
                // a plane on the horizon got a new vertex, which lies on `plane`
                let kept = self.planes.face_vertex(p);
                if kept != NONE && self.vertices.planes(kept)[0] != plane {
                    self.planes.set_without_face(p, PlaneState::Uncertified);
                    self.certificates.push_uncertified(Orphan { plane: p, hidden_by: plane });
                }
            }
        }
    }

    /// Starts the record of what an operation changes.
    #[inline]
    pub(super) fn begin_change(&mut self, steps: Steps) {
        self.vertices.set_steps(steps);
        self.change.removed.clear();
        self.change.created.clear();
        self.change.moved.clear();
    }

    /// Takes a vertex away: it counts as removed unless the same operation made it.
    #[inline]
    pub(super) fn discard_vertex(&mut self, vertex: u32) {
        if !self.vertices.take_fresh(vertex) {
            self.change.removed.push(VertexIdx(vertex));
        }
        self.vertices.remove(vertex);
    }

    /// What an operation of several steps changed: vertices that it made and took away again are left out.
    #[inline]
    pub(super) fn finish_change(&mut self) -> &Change {
        let vertices = &mut self.vertices;
        self.change.created.retain(|vertex| vertices.take_fresh(vertex.0));
        &self.change
    }
}
