//! The polygons of single faces, unbounded ones included.

use glam::DVec3;

use crate::meet::{direction, meet};
use crate::polytope::infinity::is_infinity;
use crate::polytope::{IncrementalPolytope, PlaneIdx};

/// A whole line that bounds a face.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundaryLine {
    /// Its point nearest to the origin, correctly rounded.
    pub point: DVec3,
    /// The unit direction in which it runs with the face on its left, seen from outside.
    pub direction: DVec3,
}

/// A face, counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FacePolygon {
    /// The plane it lies on.
    pub plane: PlaneIdx,
    /// Its corners, correctly rounded, none twice in exact terms.
    pub corners: Vec<DVec3>,
    /// Where an unbounded face has corners: the unit directions of its boundary from the first corner and from the last one
    /// to infinity.
    pub rays: Option<[DVec3; 2]>,
    /// Where a face has no corners: the lines that bound it, two for a strip, one for a half-plane, none for a plane.
    pub lines: Vec<BoundaryLine>,
}

impl IncrementalPolytope {
    /// The polygon of a plane's face; `None` where the plane has no face, or one without area.
    ///
    /// The tolerance of [`with_epsilon`](Self::with_epsilon) takes no part.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut octant = IncrementalPolytope::new();
    /// let [floor, ..] = DVec3::AXES.map(|axis| HalfSpace::new(-axis, 0.0).map(|h| octant.add_plane(h).plane()));
    /// let quadrant = octant.face_polygon(floor?).expect("it has a face");
    /// assert_eq!(quadrant.corners, [DVec3::ZERO]);
    /// assert_eq!(quadrant.rays, Some([DVec3::Y, DVec3::Z]));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn face_polygon(&self, plane: PlaneIdx) -> Option<FacePolygon> {
        let slot = self.live(plane).filter(|slot| !self.is_empty() && self.planes.has_face(*slot))?;
        let edges = self.edge_planes(slot);
        if edges.len() < 3 {
            return None;
        }
        let count = edges.len();
        let along = |edge: u32| direction(self.row(slot), self.row(edge));
        let first = edges.iter().position(|edge| is_infinity(*edge));
        // Begin behind an infinity plane, so that the finite edges of a face with corners follow each other.
        let begin = first.map_or(0, |first| {
            (first..first + count).find(|i| !is_infinity(edges[(i + 1) % count])).map_or(0, |i| i + 1)
        });
        let cycle: Vec<u32> = (0..count).map(|i| edges[(begin + i) % count]).collect();
        let pairs = (0..count).map(|i| (cycle[i], cycle[(i + 1) % count]));
        let corners: Vec<DVec3> = pairs
            .filter(|(p, q)| !is_infinity(*p) && !is_infinity(*q))
            .map(|(p, q)| meet(self.row(slot), self.row(p), self.row(q)).expect("the edges meet in a vertex"))
            .collect();
        let finite: Vec<u32> = cycle.into_iter().filter(|edge| !is_infinity(*edge)).collect();
        let mut polygon = FacePolygon { plane, corners, rays: None, lines: Vec::new() };
        if first.is_some() {
            if polygon.corners.is_empty() {
                let line = |edge: u32| BoundaryLine {
                    point: self.nearest_point_of_flat([slot, edge, 0]).rounded(),
                    direction: along(edge),
                };
                polygon.lines = finite.into_iter().map(line).collect();
            } else {
                polygon.rays = Some([0.0 - along(finite[0]), along(finite[finite.len() - 1])]);
            }
        }
        Some(polygon)
    }
}
