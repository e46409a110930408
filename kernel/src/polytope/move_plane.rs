//! Moving a plane: where no vertex changes its planes, only the positions of one face are computed again.
//!
//! That is so where the plane hides no other and, with the corners at their new places, every edge at the face is still
//! convex: a closed surface that is convex at each edge is convex. Else the plane is taken out and added again with its
//! old stamp, which gives the structure that it would have had there from the beginning.

use super::add::Insertion;
use super::store::{BEFORE, NEXT, NONE, PlaneState, Steps};
use super::{IncrementalPolytope, MovePlaneResult, PlaneIdx, VertexIdx};
use crate::half_space::HalfSpace;
use crate::sign::{Row, Sign, orient3};

impl IncrementalPolytope {
    /// Puts another half-space in the place of a plane, which keeps its handle and its age (its stamp): the set becomes
    /// what it would be had the plane been added so.
    ///
    /// `None` where there is no such plane. Cost: while the faces keep their corners, one position and three signs a corner
    /// of the face; else that of removing and adding.
    pub fn move_plane(&mut self, idx: PlaneIdx, half_space: HalfSpace) -> Option<MovePlaneResult<'_>> {
        let plane = self.live(idx)?;
        let previous = *self.planes.half_space(plane);
        self.begin_change(Steps::Several);
        let row = Row::new(&half_space);
        let was_empty = self.is_empty();
        let is_shifted = !was_empty && self.shift_face(plane, &row);
        if is_shifted {
            self.planes.replace(plane, half_space, row);
        } else if self.planes.state(plane) == PlaneState::Pending {
            self.planes.replace(plane, half_space, row);
            self.after_loss(&[plane]);
        } else {
            self.detach(plane);
            self.planes.replace(plane, half_space, row);
            // What it hid comes first: without this plane the set has an interior, with it perhaps not.
            self.examine_again();
            if self.insert_into_structure(plane) == Insertion::Empty {
                self.become_empty(plane);
                self.begin_change(Steps::Several);
            } else if was_empty {
                self.after_loss(&[plane]);
            }
        }
        let has_face = !self.is_empty() && self.planes.has_face(plane);
        let change = self.finish_change();
        Some(MovePlaneResult {
            previous,
            has_face,
            removed_vertices: &change.removed,
            new_vertices: &change.created,
            moved_vertices: &change.moved,
        })
    }

    /// Moves a face to a new row where all vertices keep their planes; false, and nothing is changed, where they do not.
    ///
    /// They do where every edge at the face stays convex, because a closed surface that is convex at each edge is convex.
    fn shift_face(&mut self, plane: u32, row: &Row) -> bool {
        self.certify_orphans();
        if !self.planes.has_face(plane) || self.planes.carried(plane) != NONE {
            return false;
        }
        let old = *self.row(plane);
        self.planes.set_row(plane, *row);
        let is_shifted = self.shift_corners(plane);
        if is_shifted {
            for (vertex, point) in self.change.moved.iter().zip(self.scratch.points.drain(..)) {
                self.vertices.set_point(vertex.0, point);
            }
        } else {
            self.planes.set_row(plane, old);
            self.change.moved.clear();
            self.scratch.points.clear();
        }
        is_shifted
    }

    /// Collects the corners of a face with their new positions; false where an edge would not stay convex.
    fn shift_corners(&mut self, plane: u32) -> bool {
        for (vertex, k) in self.vertices.face_corners(plane, self.planes.face_vertex(plane)) {
            let planes = self.vertices.planes(vertex);
            let [h, p, q] = [planes[k], planes[NEXT[k]], planes[BEFORE[k]]].map(|plane| self.row(plane));
            if orient3(h, p, q) != Sign::Positive {
                return false;
            }
            let point = self.meeting_point(planes);
            for link in [self.vertices.link(vertex, k), self.vertices.link(vertex, NEXT[k])] {
                let across = self.vertices.planes(link.vertex())[link.index()];
                if self.is_point_outside(planes, &point, across) {
                    return false;
                }
            }
            self.change.moved.push(VertexIdx(vertex));
            self.scratch.points.push(point);
        }
        true
    }
}
