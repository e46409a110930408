//! Cutting a part of the structure off with a plane, which gets a face there.
//!
//! The vertices outside a plane are connected, and so are those inside, so that the edges between them are a ring. A
//! depth-first search that turns counter-clockwise at every vertex comes to these edges in the order of the ring.

use super::infinity::is_infinity;
use super::redundant::Orphan;
use super::store::{BEFORE, Link, NEXT, NONE, PlaneState, PlaneStore};
use super::{IncrementalPolytope, VertexIdx};
use crate::sign::{Homogeneous, OffsetColumn, Probe, cross};

impl IncrementalPolytope {
    /// Collects all vertices outside `plane` into the scratch, beginning with `top`, and the edges that leave them,
    /// counter-clockwise; false where no vertex is left. `probe` is that of the plane.
    pub(super) fn collect_cut(&mut self, plane: u32, top: u32, probe: &Probe) -> bool {
        self.vertices.begin_visit();
        let Self { planes, vertices, scratch, .. } = self;
        let mut vertices = vertices.slots_mut();
        let (cut, horizon, waiting) = (&mut scratch.cut, &mut scratch.horizon, &mut scratch.waiting);
        cut.clear();
        horizon.clear();
        waiting.clear();
        cut.push(top);
        vertices.set_visited(top);
        waiting.extend([Link::new(top, 2), Link::new(top, 1)]);
        let mut edge = Link::new(top, 0);
        loop {
            let end = vertices.other_end(edge);
            let vertex = end.vertex();
            if !vertices.is_visited(vertex) {
                let point = vertices.point(vertex);
                if planes.is_outside(probe, plane, vertices.is_ideal(vertex), vertices.planes(vertex), point) {
                    vertices.set_visited(vertex);
                    cut.push(vertex);
                    waiting.push(Link::new(vertex, BEFORE[end.index()]));
                    edge = Link::new(vertex, NEXT[end.index()]);
                    continue;
                }
                horizon.push(edge);
            }
            match waiting.pop() {
                Some(next) => edge = next,
                None => return !horizon.is_empty(),
            }
        }
    }

    /// Replaces the collected vertices by the face of `plane`; gives one of its vertices.
    pub(super) fn cut_away(&mut self, plane: u32) -> u32 {
        let first = self.change.created.len();
        self.vertices.claim(self.scratch.horizon.len(), &mut self.change.created);
        self.make_face(plane, first);
        let cut = std::mem::take(&mut self.scratch.cut);
        // A connected part of `cut` vertices without a face in it has `cut + 2` edges that leave it (Euler).
        if self.scratch.horizon.len() != cut.len() + 2 {
            self.hide_orphans(plane, &cut);
        }
        for &vertex in &cut {
            self.discard_vertex(vertex);
        }
        self.scratch.cut = cut;
        let face_vertex = self.change.created[first].0;
        self.planes.set_face(plane, face_vertex);
        face_vertex
    }

    /// Makes the vertices of the face of `plane`, one on each edge of the ring, in the slots claimed from `first` on.
    fn make_face(&mut self, plane: u32, first: usize) {
        let fresh = &self.change.created[first..];
        let horizon = &self.scratch.horizon;
        let planes = &mut self.planes;
        let mut vertices = self.vertices.slots_mut();
        // The cut vertex (a, p, q) moves to where its edge p, q meets the plane, and q is p for the next.
        let first_plane = vertices.planes(horizon[0].vertex())[NEXT[horizon[0].index()]];
        let n = *planes.row(plane);
        let mut row_p = *planes.row(first_plane);
        let mut n_p = cross(&n, &row_p);
        let mut previous = fresh[fresh.len() - 1].0;
        let following = fresh[1..].iter().chain(&fresh[..1]);
        for ((edge, &VertexIdx(slot)), &VertexIdx(following)) in horizon.iter().zip(fresh).zip(following) {
            let (around, k) = (vertices.planes(edge.vertex()), edge.index());
            let (p, q) = (around[NEXT[k]], around[BEFORE[k]]);
            let row_q = *planes.row(q);
            let n_q = cross(&n, &row_q);
            let is_ideal = is_infinity(p) || is_infinity(q) || is_infinity(plane);
            let point = if is_ideal {
                ideal_point(planes, [plane, p, q])
            } else {
                Homogeneous::corner(&n, [&row_p, &row_q], &n_p, &n_q)
            };
            let kept = vertices.other_end(*edge);
            let links = [kept, Link::new(following, 2), Link::new(previous, 1)];
            vertices.put(slot, [plane, p, q], links, is_ideal, point);
            vertices.set_other_end(kept, Link::new(slot, 0));
            planes.set_face(p, slot);
            (previous, row_p, n_p) = (slot, row_q, n_q);
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
}

#[cold]
#[inline(never)]
fn ideal_point(planes: &PlaneStore, meeting: [u32; 3]) -> Homogeneous {
    let [a, b, c] = meeting.map(|plane| planes.row(plane));
    Homogeneous::quick(a, b, c, OffsetColumn::Infinite)
}
