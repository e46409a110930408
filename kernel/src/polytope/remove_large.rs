//! The cap of a large or open ring: a polytope of the ring planes alone, built in random order, and the part of it that
//! lies beyond the removed faces.
//!
//! The caps of ring planes and infinity planes together are what the polytope shows there, because a hidden infinity plane
//! that is needed beyond an open ring is one that nothing else bounds.

use super::remove::RingEdge;
use super::store::{Link, NEXT, NONE};
use super::{IncrementalPolytope, VertexIdx, infinity};

impl IncrementalPolytope {
    /// Closes a hole with the part beyond the planes `opened` of the polytope of the ring planes.
    pub(super) fn fill_with_cap(&mut self, ring: &[RingEdge], opened: &[u32]) {
        let (mut body, original) = self.body_of_ring(ring);
        let beyond = self.vertices_beyond(&mut body, opened);
        for (position, edge) in ring.iter().enumerate() {
            self.planes.set_mark(edge.plane, position as u32);
        }
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
            for (k, link) in body.vertices.links(vertex).into_iter().enumerate() {
                let slot = number[vertex as usize];
                let end = match number[link.vertex() as usize] {
                    // this edge crosses the removed face: it continues where that ring edge does
                    NONE => ring[self.planes.mark(self.vertices.planes(slot)[NEXT[k]]) as usize].end,
                    other => Link::new(other, link.index()),
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
            let slot = self.lend(plane, &mut body);
            debug_assert_eq!(slot as usize, original.len());
            original.push(plane);
            body.insert_into_structure(slot);
        }
        (body, original)
    }

    /// Stores one of the own planes in another polytope.
    fn lend(&self, plane: u32, body: &mut Self) -> u32 {
        body.planes.insert_with_stamp(*self.planes.half_space(plane), *self.row(plane), self.planes.stamp(plane))
    }

    /// The vertices of `body` that violate one of the planes `opened`.
    fn vertices_beyond(&self, body: &mut Self, opened: &[u32]) -> Vec<u32> {
        let mut beyond: Vec<u32> = Vec::new();
        for &plane in opened {
            let face = self.lend(plane, body);
            let top = body.climb(self.row(plane), body.hint);
            debug_assert!(body.is_outside(top, face), "the cap lies beyond each removed face");
            body.collect_cut(face, top);
            beyond.extend(&body.scratch.cut);
        }
        if opened.len() > 1 {
            beyond.sort_unstable();
            beyond.dedup();
        }
        beyond
    }

    /// A plane that takes part in the cap has a face there; an infinity plane may have been hidden until now.
    fn show(&mut self, plane: u32, vertex: u32) {
        if !self.planes.has_face(plane) {
            self.forget_certificate(plane);
        }
        self.planes.set_face(plane, vertex);
    }
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
