//! What is seen from outside: vertices, edges and faces with coincident vertices merged and infinity planes hidden
//! (paper §3.6, §6.1).
//!
//! Vertices joined by an edge of exactly zero length are one, and edges shorter than the tolerance are contracted where
//! that leaves a polytope's topology ([`tolerance`]). A face is **seen** where its ring has three different corners or
//! more, the places where it meets infinity included: so an unbounded face counts whatever few finite corners it
//! has, and a plane that only touches an edge, a ray, a line or a corner has no face. [`Vertex::planes`], [`Edge::planes`],
//! [`IncrementalPolytope::faces`] and the faces of Euler's formula all mean seen faces.
//!
//! One code answers for a single vertex and for all of them: [`cluster::Clusters`] works out what it is asked and
//! remembers it.

mod cluster;
mod edge;
mod face;
mod mesh;
mod tolerance;
mod vertex;

pub use edge::{Edge, EdgeIdx, EdgeKind};
pub use face::{Face, FacetEdge};
pub use vertex::Vertex;

use glam::DVec4;

use super::IncrementalPolytope;
use super::infinity::is_infinity;
use super::{PlaneIdx, VertexIdx, external};
use crate::meet::{direction, meet};

impl IncrementalPolytope {
    /// The vertices of the simple (perturbed) structure: the three planes of each, counter-clockwise seen from outside;
    /// `None` stands for an infinity plane. Empty where the set is.
    pub fn simple_vertices(&self) -> impl Iterator<Item = [Option<PlaneIdx>; 3]> {
        let shown = if self.is_empty() { 0 } else { usize::MAX };
        self.vertices
            .slots()
            .take(shown)
            .map(|slot| self.vertices.planes(slot).map(|p| (!is_infinity(p)).then(|| external(p))))
    }

    /// The three planes of a vertex of the simple structure, counter-clockwise seen from outside, and the vertices across the edges that do not lie on
    /// the first, the second and the third of them; `None` stands for an infinity plane. `None` where there is no such vertex, and where the set is empty.
    ///
    /// Cost: constant. It may be asked of the new vertices of an operation.
    #[must_use]
    pub fn simple_vertex(&self, idx: VertexIdx) -> Option<([Option<PlaneIdx>; 3], [VertexIdx; 3])> {
        if self.is_empty() || !self.vertices.is_live(idx.0) {
            return None;
        }
        let planes = self.vertices.planes(idx.0).map(|p| (!is_infinity(p)).then(|| external(p)));
        Some((planes, self.vertices.neighbours(idx.0).map(VertexIdx)))
    }

    /// The homogeneous position of a vertex of the simple structure.
    pub(super) fn position(&self, slot: u32) -> DVec4 {
        let planes = self.vertices.planes(slot);
        if let Some(k) = planes.iter().position(|p| is_infinity(*p)) {
            // of the planes (M, b, c) the last two carry the ray, which runs along their cross product
            return direction(self.row(planes[(k + 1) % 3]), self.row(planes[(k + 2) % 3])).extend(0.0);
        }
        let [a, b, c] = planes.map(|p| self.row(p));
        meet(a, b, c).expect("the normals at a vertex are independent").extend(1.0)
    }

    fn infinity_planes(&self, slot: u32) -> usize {
        self.vertices.planes(slot).into_iter().filter(|p| is_infinity(*p)).count()
    }
}
