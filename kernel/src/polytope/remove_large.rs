//! The cap of a large or open ring: a polytope of the ring planes and the four infinity planes, built in random order, and
//! the part of it that lies beyond the removed faces.
//!
//! The polytope lies inside all infinity planes, so a cap that is cut by all four fits what is around it; an infinity plane
//! that was hidden can get a face there.

use super::remove::RingEdge;
use super::store::{BEFORE, Link, NEXT, NONE, VertexStore};
use super::{IncrementalPolytope, VertexIdx, infinity};

impl IncrementalPolytope {
    /// Closes a hole with a part of the polytope of the ring planes: what lies beyond `opened`, a plane whose face was there,
    /// up to the edges that cross the border of the hole.
    ///
    /// The vertex of that polytope that is farthest beyond `opened` is a new one, for the planes of the ring alone meet at
    /// the farthest vertex of the new region; the others are reached from it along edges that stay in the hole.
    pub(super) fn fill_with_cap(&mut self, ring: &[RingEdge], opened: u32) {
        let (body, original) = self.body_of_ring(ring);
        for (position, edge) in ring.iter().enumerate() {
            self.planes.set_mark(edge.plane, position as u32);
        }
        let crossing = |vertex: u32, k: usize| {
            let planes = body.vertices.planes(vertex).map(|p| original[p as usize]);
            self.crossing_edge(ring, planes[NEXT[k]], planes[BEFORE[k]])
        };
        let top = body.climb(self.row(opened), body.start(self.row(opened)));
        let beyond = connected(&body.vertices, top, |vertex, k| crossing(vertex, k).is_none());
        let mut number = vec![NONE; body.vertices.slot_count()];
        for &vertex in &beyond {
            let planes = body.vertices.planes(vertex).map(|p| original[p as usize]);
            let slot = self.vertices.insert(planes, *body.vertices.point(vertex));
            self.change.created.push(VertexIdx(slot));
            number[vertex as usize] = slot;
            for p in planes {
                self.show(p, slot);
            }
        }
        for &vertex in &beyond {
            let slot = number[vertex as usize];
            let planes = self.vertices.planes(slot);
            for (k, link) in body.vertices.links(vertex).into_iter().enumerate() {
                let end = match self.crossing_edge(ring, planes[NEXT[k]], planes[BEFORE[k]]) {
                    Some(edge) => ring[edge].end,
                    None => Link::new(number[link.vertex() as usize], link.index()),
                };
                self.vertices.join(Link::new(slot, k), end);
            }
        }
    }

    /// The polytope of the ring planes, with their stamps, and for each of its planes the slot in `self`.
    fn body_of_ring(&self, ring: &[RingEdge]) -> (Self, Vec<u32>) {
        let mut body = Self::with_epsilon(self.epsilon);
        let mut original: Vec<u32> = (0..infinity::COUNT).collect();
        let mut order: Vec<u32> = ring.iter().map(|edge| edge.plane).filter(|p| !infinity::is_infinity(*p)).collect();
        shuffle(&mut order);
        for plane in order {
            let stamp = self.planes.stamp(plane);
            let slot = body.planes.insert_with_stamp(*self.planes.half_space(plane), *self.row(plane), stamp);
            debug_assert_eq!(slot as usize, original.len());
            original.push(plane);
            body.insert_into_structure(slot);
        }
        (body, original)
    }

    /// Which ring edge is the one between two planes, seen from the hole; the marks give the places in the ring.
    fn crossing_edge(&self, ring: &[RingEdge], p: u32, q: u32) -> Option<usize> {
        let at = self.planes.mark(p) as usize;
        // the mark of a plane that is not in the ring is left from an earlier operation, or is none at all
        if ring.get(at)?.plane != p {
            return None;
        }
        let next = if at + 1 == ring.len() { 0 } else { at + 1 };
        (ring[next].plane == q).then_some(at)
    }

    /// A plane that takes part in the cap has a face there; an infinity plane may have been hidden until now.
    fn show(&mut self, plane: u32, vertex: u32) {
        if !self.planes.has_face(plane) {
            self.forget_certificate(plane);
        }
        self.planes.set_face(plane, vertex);
    }
}

/// The vertices that are reached from `start` over edges that `passes` lets through.
fn connected(vertices: &VertexStore, start: u32, passes: impl Fn(u32, usize) -> bool) -> Vec<u32> {
    let mut is_reached = vec![false; vertices.slot_count()];
    is_reached[start as usize] = true;
    let mut reached = vec![start];
    let mut next = 0;
    while let Some(&vertex) = reached.get(next) {
        next += 1;
        for (k, neighbour) in vertices.neighbours(vertex).into_iter().enumerate() {
            if !is_reached[neighbour as usize] && passes(vertex, k) {
                is_reached[neighbour as usize] = true;
                reached.push(neighbour);
            }
        }
    }
    reached
}

/// Fisher–Yates with a fixed generator: any order gives the same structure, a random one gives it fast.
fn shuffle(order: &mut [u32]) {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for k in (1..order.len()).rev() {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        order.swap(k, (state % (k as u64 + 1)) as usize);
    }
}
