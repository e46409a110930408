//! The cap of a large or open ring: a polytope of the ring planes alone, built in random order, and the part of it that
//! lies beyond the removed face.
//!
//! The caps of ring planes and infinity planes together are what the polytope shows there, because a hidden infinity plane
//! that is needed beyond an open ring is one that nothing else bounds.

use super::remove::{CapVertex, EdgeEnd, RingEdge};
use super::store::{NONE, PlaneState};
use super::{IncrementalPolytope, infinity};

impl IncrementalPolytope {
    /// Fills `cap` with the vertices that replace the face of `plane`, whose ring is `ring`.
    pub(super) fn build_cap(&mut self, plane: u32, ring: &[RingEdge], cap: &mut Vec<CapVertex>) {
        let (mut body, original) = self.body_of_ring(ring);
        let face = body.planes.insert_with_stamp(
            self.planes.half_space[plane as usize],
            *self.row(plane),
            self.planes.stamp[plane as usize],
        );
        let top = body.climb(self.row(plane), body.hint);
        debug_assert!(body.is_outside(top, face), "the cap lies beyond the removed face");
        body.collect_cut(face, top);
        let beyond = std::mem::take(&mut body.scratch.cut);

        for (position, edge) in ring.iter().enumerate() {
            self.planes.mark[edge.plane as usize] = position as u32;
        }
        let mut number = vec![NONE; body.vertices.planes.len()];
        for (k, &vertex) in beyond.iter().enumerate() {
            number[vertex as usize] = k as u32;
        }
        for &vertex in &beyond {
            let planes = body.vertices.planes[vertex as usize].map(|p| original[p as usize]);
            let ends = std::array::from_fn(|k| {
                let neighbour = body.vertices.neighbours[vertex as usize][k];
                match number[neighbour as usize] {
                    // this edge crosses the removed face: it continues where that ring edge does
                    NONE => Some(ring[self.planes.mark[planes[(k + 1) % 3] as usize] as usize].end),
                    other => Some(EdgeEnd::New(other, body.vertices.link_to(neighbour, vertex) as u8)),
                }
            });
            cap.push(CapVertex { planes, point: body.vertices.point[vertex as usize], ends });
            for p in planes {
                self.show_infinity_plane(p);
            }
        }
        for edge in ring {
            self.planes.mark[edge.plane as usize] = NONE;
        }
    }

    /// The polytope of the ring planes, with their stamps, and for each of its planes the slot in `self`.
    fn body_of_ring(&self, ring: &[RingEdge]) -> (Self, Vec<u32>) {
        let mut body = Self::with_epsilon(self.epsilon);
        let mut original: Vec<u32> = (0..infinity::COUNT).collect();
        let mut order: Vec<u32> = ring.iter().map(|edge| edge.plane).filter(|p| !infinity::is_infinity(*p)).collect();
        shuffle(&mut order);
        for plane in order {
            let i = plane as usize;
            let slot =
                body.planes.insert_with_stamp(self.planes.half_space[i], self.planes.row[i], self.planes.stamp[i]);
            debug_assert_eq!(slot as usize, original.len());
            body.certificates.grow_to(body.planes.row.len());
            original.push(plane);
            body.insert_into_structure(slot);
        }
        (body, original)
    }

    /// An infinity plane that shows itself in the cap has a face again.
    fn show_infinity_plane(&mut self, plane: u32) {
        if infinity::is_infinity(plane) && self.planes.state[plane as usize] != PlaneState::Face {
            self.forget_certificate(plane);
            self.planes.state[plane as usize] = PlaneState::Face;
        }
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
