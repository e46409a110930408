//! What a set would gain without one of its planes: the volume beyond a face.
//!
//! The plane is taken out, which makes the new corners, and put back with its old stamp, which gives the structure that was there. Between the two
//! the volume is summed over the edges at the new corners alone.
//!
//! Let `o` be a point of the face, and for each plane that bounds the region beyond it let `q` be a corner of its part of the boundary. That part is
//! a fan of triangles around `q`, one for each of its edges, and the region is the sum of their cones from `o`. An edge from `u` to `w` belongs to two planes,
//! and the two cones over it together are `det(q₁ − q₂, u − o, w − o) / 6`. Where `q` is a corner of the face, the edge on the face adds nothing.

use glam::DVec3;

use super::store::{BEFORE, Link, NEXT, Steps};
use super::{IncrementalPolytope, PlaneIdx};

/// The corners of the face that is taken out.
#[derive(Default)]
struct Border {
    /// The kept ends of the edges that leave the face, ascending, with where they leave it.
    crossings: Vec<(Link, DVec3)>,
    /// For each plane a corner of its part of the region's boundary.
    anchors: Vec<(u32, DVec3)>,
}

impl IncrementalPolytope {
    /// The volume that the set would gain if a plane were removed, in the cube of the units of the planes: zero where the plane has no face, `None` where there is no such plane, where the
    /// set is empty, and where the gain has no end. The set and all its handles of planes are the same afterwards; those of vertices are not.
    ///
    /// It is summed in floating point, and good to about `2⁻⁵⁰` of the area of the gained region times the largest coordinate: for choosing planes,
    /// not for measuring ([`measures`](Self::measures)). Planes that the plane hides take part exactly as if it were removed.
    ///
    /// Cost: that of removing and adding the plane.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut cube = IncrementalPolytope::new();
    /// for axis in DVec3::AXES {
    ///     cube.add_plane(HalfSpace::new(axis, 1.0)?);
    ///     cube.add_plane(HalfSpace::new(-axis, 1.0)?);
    /// }
    /// let corner = cube.add_plane(HalfSpace::new(DVec3::ONE, 2.0)?).plane();
    /// let gain = cube.volume_beyond(corner).expect("there is a corner beyond it");
    /// assert!((gain - 1.0 / 6.0).abs() < 1e-15);
    /// assert_eq!(cube.vertex_count(), 10);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn volume_beyond(&mut self, idx: PlaneIdx) -> Option<f64> {
        let plane = self.live(idx).filter(|_| !self.is_empty())?;
        if !self.planes.has_face(plane) {
            return Some(0.0);
        }
        let mut border = self.border_of(plane)?;
        self.begin_change(Steps::Several);
        self.detach(plane);
        self.examine_again();
        self.finish_change();
        let volume = self.new_volume(&mut border);
        self.begin_change(Steps::One);
        self.insert_into_structure(plane);
        volume
    }

    /// The corners of a face; `None` where it reaches infinity, and what is beyond it does so, too.
    fn border_of(&self, plane: u32) -> Option<Border> {
        let mut border = Border::default();
        for (vertex, k) in self.vertices.face_corners(plane, self.planes.face_vertex(plane)) {
            if self.vertices.is_ideal(vertex) {
                return None;
            }
            let place = self.place(vertex);
            border.crossings.push((self.vertices.link(vertex, k), place));
            border.anchors.push((self.vertices.planes(vertex)[NEXT[k]], place));
        }
        border.crossings.sort_unstable_by_key(|(end, _)| *end);
        Some(border)
    }

    /// The volume of what the last operation added beyond a face; `None` where there is no end to it.
    fn new_volume(&mut self, border: &mut Border) -> Option<f64> {
        for (number, (plane, _)) in (0..).zip(&border.anchors) {
            self.planes.set_mark(*plane, number);
        }
        if self.change.created.iter().any(|vertex| self.vertices.is_ideal(vertex.0)) {
            return None;
        }
        let (_, origin) = border.anchors[0];
        let mut volume = 0.0;
        for number in 0..self.change.created.len() {
            let vertex = self.change.created[number].0;
            let (planes, start) = (self.vertices.planes(vertex), self.place(vertex));
            for (k, link) in self.vertices.links(vertex).into_iter().enumerate() {
                let crossing = border.crossings.binary_search_by_key(&link, |(end, _)| *end);
                let end = match crossing {
                    Ok(found) => border.crossings[found].1,
                    // an edge between two new corners is met from both
                    Err(_) if link.vertex() < vertex => continue,
                    Err(_) => self.place(link.vertex()),
                };
                // counter-clockwise around the first of the two, clockwise around the second
                let [left, right] = [BEFORE[k], NEXT[k]].map(|at| self.anchor(planes[at], start, &mut border.anchors));
                volume += (left - right).dot((start - origin).cross(end - origin));
            }
        }
        Some((volume / 6.0).max(0.0))
    }

    /// The corner that stands for a plane; `place` where it has none yet.
    fn anchor(&mut self, plane: u32, place: DVec3, anchors: &mut Vec<(u32, DVec3)>) -> DVec3 {
        // the mark of another plane is left from an earlier operation, or is none at all
        match anchors.get(self.planes.mark(plane) as usize) {
            Some((known, anchor)) if *known == plane => *anchor,
            _ => {
                self.planes.set_mark(plane, anchors.len() as u32);
                anchors.push((plane, place));
                place
            }
        }
    }

    /// Where a finite vertex is.
    fn place(&self, vertex: u32) -> DVec3 {
        self.position(vertex).truncate()
    }
}
