//! Checks of what is stored: links first, then signs, then faces and certificates.

use thiserror::Error;

use super::super::IncrementalPolytope;
use super::super::store::{BEFORE, Link, NEXT, PlaneState};
use crate::sign::{Sign, orient3};

/// A broken invariant: never the user's mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum InvariantError {
    /// Two neighbouring vertices do not name each other, or do not share the two planes of their edge.
    #[error("vertex {vertex} and its neighbour {neighbour} do not fit together")]
    Link {
        /// Slot of the vertex.
        vertex: u32,
        /// Slot of the neighbour.
        neighbour: u32,
    },
    /// `V − E + F ≠ 2`, infinity planes included.
    #[error("Euler's formula fails for {vertices} vertices and {faces} faces")]
    Euler {
        /// Vertices of the simple structure.
        vertices: usize,
        /// Faces, those of infinity planes included.
        faces: usize,
    },
    /// The planes of a vertex are not right-handed.
    #[error("the planes of vertex {vertex} are not counter-clockwise")]
    Orientation {
        /// Slot of the vertex.
        vertex: u32,
    },
    /// An edge is not convex: the plane across it cuts the vertex off.
    #[error("vertex {vertex} violates plane {plane} of a neighbour")]
    Convexity {
        /// Slot of the vertex.
        vertex: u32,
        /// Slot of the plane.
        plane: u32,
    },
    /// A plane's face vertex does not lie on the plane, or a vertex lies on a plane that has no face.
    #[error("plane {plane} does not know its face")]
    FaceVertex {
        /// Slot of the plane.
        plane: u32,
    },
    /// A certificate does not prove that its plane is redundant, or a list does not hold it exactly once.
    #[error("the certificate of plane {plane} does not hold")]
    Certificate {
        /// Slot of the plane.
        plane: u32,
    },
}

impl IncrementalPolytope {
    /// Checks links, Euler's formula, orientation, local convexity (which implies convexity) and certificates.
    ///
    /// # Errors
    /// The first [`InvariantError`] found; a bug in this crate.
    pub fn check_invariants(&self) -> Result<(), InvariantError> {
        self.check_links()?;
        self.check_signs()?;
        self.check_planes()
    }

    fn check_links(&self) -> Result<(), InvariantError> {
        for vertex in self.vertices.slots() {
            let planes = self.vertices.planes(vertex);
            for (k, link) in self.vertices.links(vertex).into_iter().enumerate() {
                let (neighbour, j) = (link.vertex(), link.index());
                let broken = InvariantError::Link { vertex, neighbour };
                if !self.vertices.is_live(neighbour) || j > 2 {
                    return Err(broken);
                }
                let other = self.vertices.planes(neighbour);
                let fits = self.vertices.link(neighbour, j) == Link::new(vertex, k)
                    && other[NEXT[j]] == planes[BEFORE[k]]
                    && other[BEFORE[j]] == planes[NEXT[k]];
                if !fits {
                    return Err(broken);
                }
            }
        }
        let vertices = self.vertices.len();
        let faces = self.planes.faces().count();
        // every vertex has three edges: V − 3V/2 + F = 2
        if 2 * faces != vertices + 4 {
            return Err(InvariantError::Euler { vertices, faces });
        }
        Ok(())
    }

    fn check_signs(&self) -> Result<(), InvariantError> {
        for vertex in self.vertices.slots() {
            let planes = self.vertices.planes(vertex);
            let [a, b, c] = planes.map(|p| self.row(p));
            if orient3(a, b, c) != Sign::Positive {
                return Err(InvariantError::Orientation { vertex });
            }
            for neighbour in self.vertices.neighbours(vertex) {
                for plane in self.vertices.planes(neighbour) {
                    if !planes.contains(&plane) && self.is_outside(vertex, plane) {
                        return Err(InvariantError::Convexity { vertex, plane });
                    }
                }
            }
        }
        Ok(())
    }

    fn check_planes(&self) -> Result<(), InvariantError> {
        for vertex in self.vertices.slots() {
            if let Some(plane) = self.vertices.planes(vertex).into_iter().find(|plane| !self.planes.has_face(*plane)) {
                return Err(InvariantError::FaceVertex { plane });
            }
        }
        for plane in 0..self.planes.slot_count() {
            let state = self.planes.state(plane);
            if state == PlaneState::Face {
                let vertex = self.planes.face_vertex(plane);
                if !self.vertices.is_live(vertex) || !self.vertices.planes(vertex).contains(&plane) {
                    return Err(InvariantError::FaceVertex { plane });
                }
            }
            if state == PlaneState::Certified && !self.holds(plane) {
                return Err(InvariantError::Certificate { plane });
            }
            if state == PlaneState::Free {
                continue;
            }
            for listed in self.hidden_by(plane) {
                let held = self.planes.certificate(listed).is_some_and(|number| {
                    self.certificates.certifiers(number).contains(&plane)
                        && self.hidden_by(plane).filter(|p| *p == listed).count() == 1
                });
                if !held {
                    return Err(InvariantError::Certificate { plane: listed });
                }
            }
        }
        Ok(())
    }

    /// The planes that a plane helps to certify.
    fn hidden_by(&self, plane: u32) -> impl Iterator<Item = u32> + '_ {
        self.certificates.list(self.planes.carried(plane))
    }

    /// Whether the normal of `plane` is a non-negative combination of its certifiers' and their meeting point inside it.
    fn holds(&self, plane: u32) -> bool {
        let Some(number) = self.planes.certificate(plane) else { return false };
        let planes = self.certificates.certifiers(number);
        if planes.iter().any(|p| self.planes.state(*p) == PlaneState::Free) {
            return false;
        }
        let [a, b, c] = planes.map(|p| self.row(p));
        let n = self.row(plane);
        let combination = [orient3(n, b, c), orient3(a, n, c), orient3(a, b, n)];
        !combination.contains(&Sign::Negative)
            && !self.is_point_outside(planes, &self.meeting_point(planes), plane)
            && (!self.certificates.is_listed(number) || planes.iter().all(|p| self.hidden_by(*p).any(|q| q == plane)))
    }
}
