//! Cutting a part of the structure off with a plane, which gets a face there.
//!
//! The vertices outside a plane are connected, and so are those inside, so that the edges between them are a ring. A
//! depth-first search that turns counter-clockwise at every vertex comes to these edges in the order of the ring.

use super::infinity::is_infinity;
use super::redundant::Orphan;
use super::remove::RingEdge;
use super::store::{BEFORE, Link, NEXT, NONE, PlaneState};
use super::{IncrementalPolytope, VertexIdx};
use crate::sign::{Corner, FaceCorners, Homogeneous, OffsetColumn, Probe, Row};

impl IncrementalPolytope {
    /// Collects all vertices outside `plane` into the scratch, beginning with `top`, and the ring around them, counter-clockwise;
    /// false where no vertex is left. `probe` is that of the plane.
    pub(super) fn collect_cut(&mut self, plane: u32, top: u32, probe: &Probe) -> bool {
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
                let (meeting, point) = vertices.planes_and_point(vertex);
                if planes.is_outside(probe, plane, meeting, point) {
                    vertices.set_visited(vertex);
                    cut.push(vertex);
                    waiting.push(Link::new(vertex, BEFORE[end.index()]));
                    edge = Link::new(vertex, NEXT[end.index()]);
                    continue;
                }
                horizon.push(RingEdge { plane: vertices.plane_after(edge), end });
            }
            match waiting.pop() {
                Some(next) => edge = next,
                None => break,
            }
        }
        if horizon.is_empty() {
            self.vertices.end_visit(&self.scratch.cut);
            return false;
        }
        true
    }

    /// Replaces the collected vertices by the face of `plane`; gives one of its vertices.
    pub(super) fn cut_away(&mut self, plane: u32) -> u32 {
        let first = self.change.created.len();
        self.vertices.claim(self.scratch.horizon.len(), &mut self.change.created);
        self.make_face(plane, first);
        let cut = std::mem::take(&mut self.scratch.cut);
        // A connected part of `cut` vertices has `cut + 2` edges that leave it, two fewer for each face in it (Euler).
        let orphans = (cut.len() + 2 - self.scratch.horizon.len()) / 2;
        if orphans > 0 {
            self.hide_orphans(plane, &cut, orphans);
        }
        self.discard_vertices(&cut);
        self.scratch.cut = cut;
        let corners = &self.change.created[first..];
        let [face_vertex, opposite] = [0, corners.len() / 2].map(|k| corners[k].0);
        self.planes.set_new_face(plane, [face_vertex, opposite]);
        face_vertex
    }

    /// Makes the vertices of the face of `plane`, one on each edge of the ring, in the slots claimed from `first` on.
    fn make_face(&mut self, plane: u32, first: usize) {
        let fresh = &self.change.created[first..];
        let horizon = self.scratch.horizon.as_slice();
        let mut planes = self.planes.slots_mut();
        let mut vertices = self.vertices.slots_mut();
        let (&[.., RingEdge { plane: mut p, end: mut kept }], &[.., VertexIdx(mut previous), VertexIdx(mut slot)]) =
            (horizon, fresh)
        else {
            unreachable!("a ring has three edges and more");
        };
        let mut corners = FaceCorners::begin(planes.row(plane), planes.row(p));
        // on the edge of each plane of the ring with the one before
        for (&RingEdge { plane: q, end }, &VertexIdx(following)) in horizon.iter().zip(fresh) {
            let point = corners.next(planes.row(q));
            let links = [kept, Link::new(following, 2), Link::new(previous, 1)];
            if is_infinity(p.min(q).min(plane)) {
                vertices.put(slot, [plane, p, q], links, ideal_point([plane, p, q].map(|plane| planes.row(plane))));
            } else {
                vertices.put(slot, [plane, p, q], links, point);
            }
            vertices.set_other_end(kept, Link::new(slot, 0));
            planes.set_face(q, following);
            (p, kept) = (q, end);
            (previous, slot) = (slot, following);
        }
    }

    /// The `count` planes that lost all their vertices ("orphaned faces", paper Appendix C) are redundant from now on.
    fn hide_orphans(&mut self, plane: u32, cut: &[u32], count: usize) {
        let mut left = count;
        for &vertex in cut {
            for p in self.vertices.planes(vertex) {
                // a plane on the horizon got a new vertex, which lies on `plane`
                let kept = self.planes.face_vertex(p);
                if kept != NONE && self.vertices.planes(kept)[0] != plane {
                    self.planes.set_without_face(p, PlaneState::Uncertified);
                    self.certificates.push_uncertified(Orphan { plane: p, hidden_by: plane });
                    left -= 1;
                    if left == 0 {
                        return;
                    }
                }
            }
        }
    }
}

#[cold]
#[inline(never)]
fn ideal_point([a, b, c]: [&Row; 3]) -> Corner {
    Corner::new(&Homogeneous::quick(a, b, c, OffsetColumn::Infinite), OffsetColumn::Infinite)
}
