//! The four hidden planes that close every polyhedron at infinity.
//!
//! Their offset is the symbolic `M`, larger than every number; for the rest they are planes like others, hidden and
//! revealed by the same means, only never removed. A set is bounded where none of them has a face. A vertex on one of
//! them is the ideal end of a ray along its other two planes; vertices on two or three are not shown.

use super::IncrementalPolytope;
use super::store::Link;
use crate::half_space::HalfSpace;
use crate::sign::Row;
use glam::DVec3;

/// How many there are; they take the first slots and the oldest stamps.
pub(super) const COUNT: u32 = 4;

/// Generic normals near those of a tetrahedron; they span space positively (checked by a test).
const NORMALS: [[i64; 3]; COUNT as usize] = [[97, 101, 89], [103, -83, -107], [-109, 79, -91], [-85, -99, 113]];

/// The vertices of the tetrahedron: the planes of each, counter-clockwise seen from outside.
const VERTICES: [[u32; 3]; COUNT as usize] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Whether a slot holds an infinity plane.
pub(super) fn is_infinity(plane: u32) -> bool {
    plane < COUNT
}

impl IncrementalPolytope {
    /// Makes an empty store into all of space.
    pub(super) fn close_by_infinity_planes(&mut self) {
        for normal in NORMALS {
            let direction = DVec3::from_array(normal.map(|v| v as f64));
            let half_space = HalfSpace::new(direction, 0.0).expect("the normals are small integers");
            self.planes.insert(half_space, Row::infinity(normal));
        }
        self.close_at_infinity();
    }

    /// Makes the tetrahedron of the infinity planes, which must be there, the first vertices.
    pub(super) fn close_at_infinity(&mut self) {
        self.starts.reset(0);
        for planes in VERTICES {
            let point = self.meeting_point(planes);
            let vertex = self.vertices.insert(planes, point);
            self.vertices.take_fresh(vertex);
        }
        // Vertex `v` is the one that plane `v` misses, so across the edge off plane `p` lies vertex `p`.
        for (vertex, planes) in (0u32..).zip(VERTICES) {
            for (k, plane) in planes.into_iter().enumerate() {
                let back = self.vertices.index_of(plane, vertex);
                self.vertices.join(Link::new(vertex, k), Link::new(plane, back));
                self.planes.set_face(plane, vertex);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sign::{Sign, orient3};

    #[test]
    fn the_normals_span_space_positively_and_the_vertices_are_oriented() {
        let rows = NORMALS.map(Row::infinity);
        for planes in VERTICES {
            let [a, b, c] = planes.map(|p| &rows[p as usize]);
            assert_eq!(orient3(a, b, c), Sign::Positive, "{planes:?}");
        }
    }
}
