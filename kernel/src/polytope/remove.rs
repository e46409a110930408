//! Taking a plane back: the edges that ended on its face grow until they meet the next plane (paper §3), made local.
//!
//! Only planes adjacent to the removed face, and planes whose certificate it carried, can bound the new region. The ring
//! of the face is collapsed by *ears*: a ring edge between neighbours `a, b, c` with `det(a, b, c) > 0` whose meeting
//! point violates no other ring plane becomes a new vertex, and `b` leaves the ring. Ears need `orient3` and `orient4`
//! only; ordering the collapses by the offset at which they happen would need degree 7.
//!
//! Where the ring does not close, the region is open and reaches the infinity planes: like a large ring it is then built
//! as a cap of its own ([`super::remove_large`]).

use super::store::{NONE, PlaneState};
use super::{IncrementalPolytope, PlaneIdx, RemovePlaneResult};
use crate::sign::{Homogeneous, Sign, orient3};

/// A ring longer than this is built as a cap in random order, O(k log k) instead of O(k²).
const LARGE_RING: usize = 24;

/// The end of an edge that has to be linked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EdgeEnd {
    /// Index `1` of the neighbours of the kept vertex `0`.
    Kept(u32, u8),
    /// Index `1` of the neighbours of the new vertex number `0` of the cap.
    New(u32, u8),
}

/// A plane of the ring and the edge between it and the next plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct RingEdge {
    pub(super) plane: u32,
    pub(super) end: EdgeEnd,
}

/// A vertex of the cap that replaces the face.
#[derive(Debug, Clone, Copy)]
pub(super) struct CapVertex {
    pub(super) planes: [u32; 3],
    pub(super) point: Homogeneous,
    pub(super) ends: [Option<EdgeEnd>; 3],
}

impl IncrementalPolytope {
    /// Takes a half-space back: the set becomes what it would be had the plane never been added (paper §3.3).
    ///
    /// `None` where there is no such plane. Cost: proportional to the face's ring and to the planes it hid, not to the
    /// polytope.
    pub fn remove_plane(&mut self, idx: PlaneIdx) -> Option<RemovePlaneResult> {
        let plane = self.live(idx)?;
        let half_space = self.planes.half_space[plane as usize];
        let was_empty = self.is_empty();
        let had_face = match self.planes.state[plane as usize] {
            PlaneState::Free => return None,
            PlaneState::Pending => {
                self.remove_pending(plane);
                return Some(RemovePlaneResult { half_space, had_face: false });
            }
            PlaneState::Face => true,
            PlaneState::Certified | PlaneState::Uncertified => false,
        };
        self.remove_from_structure(plane, had_face);
        if was_empty && self.witness.contains(&plane) {
            self.wake_pending();
        }
        Some(RemovePlaneResult { half_space, had_face: had_face && !was_empty })
    }

    fn remove_from_structure(&mut self, plane: u32, had_face: bool) {
        self.certify_orphans();
        let mut examine = std::mem::take(&mut self.scratch.to_examine);
        self.take_certified(plane, &mut examine);
        if had_face {
            self.open_face(plane);
        } else {
            self.forget_certificate(plane);
        }
        self.planes.remove(plane);
        for &hidden in &examine {
            // The cap may have shown it already: an infinity plane beyond an open ring.
            if self.planes.state[hidden as usize] == PlaneState::Uncertified {
                self.insert_into_structure(hidden);
            }
        }
        examine.clear();
        self.scratch.to_examine = examine;
    }

    /// Removes a face and closes the hole with the planes of its ring.
    fn open_face(&mut self, plane: u32) {
        let mut ring = std::mem::take(&mut self.scratch.ring);
        let mut cut = std::mem::take(&mut self.scratch.cut);
        let mut cap = std::mem::take(&mut self.scratch.cap);
        ring.clear();
        cut.clear();
        cap.clear();
        self.walk_ring(plane, &mut ring, &mut cut);
        let closed = ring.len() <= LARGE_RING && self.collapse_ears(ring.clone(), &mut cap);
        if !closed {
            cap.clear();
            self.build_cap(plane, &ring, &mut cap);
        }
        for &vertex in &cut {
            self.vertices.remove(vertex);
        }
        self.glue(&cap);
        self.scratch.ring = ring;
        self.scratch.cut = cut;
        self.scratch.cap = cap;
    }

    /// The planes around a face, each with the edge to the next one and where that edge continues; and its vertices.
    fn walk_ring(&self, plane: u32, ring: &mut Vec<RingEdge>, face: &mut Vec<u32>) {
        let start = self.planes.face_vertex[plane as usize];
        for vertex in self.vertices.face_ring(plane, start) {
            let k = self.vertices.index_of(vertex, plane);
            let outer = self.vertices.neighbours[vertex as usize][k];
            let back = self.vertices.link_to(outer, vertex) as u8;
            let p = self.vertices.planes[vertex as usize][(k + 1) % 3];
            ring.push(RingEdge { plane: p, end: EdgeEnd::Kept(outer, back) });
            face.push(vertex);
        }
    }

    /// Collapses ears until the ring is closed; false where it stays open.
    ///
    /// Testing against the planes still in the ring is enough: a new vertex is then locally convex towards every
    /// neighbour, and local convexity everywhere is convexity.
    fn collapse_ears(&self, mut ring: Vec<RingEdge>, cap: &mut Vec<CapVertex>) -> bool {
        let mut k = 0;
        let mut failures = 0;
        while ring.len() > 3 {
            if failures == ring.len() {
                return false;
            }
            let len = ring.len();
            let (before, after) = ((k + len - 1) % len, (k + 1) % len);
            let Some(mut ear) = self.ear(&ring, [before, k, after]) else {
                failures += 1;
                k = after;
                continue;
            };
            failures = 0;
            ear.ends = [Some(ring[k].end), None, Some(ring[before].end)];
            ring[before].end = EdgeEnd::New(cap.len() as u32, 1);
            cap.push(ear);
            ring.remove(k);
            k = if k == ring.len() { 0 } else { k };
        }
        let Some(mut last) = self.ear(&ring, [0, 1, 2]) else { return false };
        // index i of the vertex (p0, p1, p2) leads along the edge of the other two planes
        last.ends = [Some(ring[1].end), Some(ring[2].end), Some(ring[0].end)];
        cap.push(last);
        true
    }

    /// The meeting point of three neighbours in the ring, where it is a vertex of the cap.
    fn ear(&self, ring: &[RingEdge], at: [usize; 3]) -> Option<CapVertex> {
        let planes = at.map(|i| ring[i].plane);
        let [a, b, c] = planes;
        if orient3(self.row(a), self.row(b), self.row(c)) != Sign::Positive {
            return None;
        }
        let point = self.meeting_point(planes);
        let violated = ring
            .iter()
            .enumerate()
            .any(|(i, edge)| !at.contains(&i) && self.is_point_outside(planes, &point, edge.plane));
        (!violated).then_some(CapVertex { planes, point, ends: [None; 3] })
    }

    /// Stores the vertices of a cap and links them with each other and with the rest.
    fn glue(&mut self, cap: &[CapVertex]) {
        let mut created = std::mem::take(&mut self.scratch.created);
        created.clear();
        for vertex in cap {
            let slot = self.vertices.insert(vertex.planes, vertex.point);
            self.vertices.visited[slot as usize] = 0;
            created.push(slot);
            for plane in vertex.planes {
                self.planes.face_vertex[plane as usize] = slot;
                debug_assert_eq!(self.planes.state[plane as usize], PlaneState::Face);
            }
        }
        for (vertex, &slot) in cap.iter().zip(&created) {
            for (k, end) in vertex.ends.into_iter().enumerate() {
                let (other, index) = match end {
                    Some(EdgeEnd::Kept(other, index)) => (other, index),
                    Some(EdgeEnd::New(other, index)) => (created[other as usize], index),
                    // set from the vertex that came later
                    None => continue,
                };
                self.vertices.neighbours[slot as usize][k] = other;
                self.vertices.neighbours[other as usize][index as usize] = slot;
            }
        }
        debug_assert!(created.iter().all(|slot| !self.vertices.neighbours[*slot as usize].contains(&NONE)));
        self.hint = created[0];
        self.scratch.created = created;
    }
}
