//! Seen vertices.

use glam::{DVec3, DVec4};

use super::super::infinity::is_infinity;
use super::super::store::Link;
use super::super::{IncrementalPolytope, PlaneIdx, VertexIdx, external};
use super::cluster::{Clusters, Naming};
use super::edge::EdgeIdx;

/// A vertex as seen from outside (paper §6.1).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Vertex {
    /// Homogeneous position: `(x, y, z, 1)`, or for an ideal vertex (the end of a ray) its unit direction `(x, y, z, 0)`.
    pub position: DVec4,
    /// The planes with a seen face at the vertex, ascending: at least three, at least two for an ideal one.
    pub planes: Vec<PlaneIdx>,
    /// The edges that end at the vertex, ascending, by the names that [`IncrementalPolytope::edges`] gives them.
    pub edges: Vec<EdgeIdx>,
}

impl Vertex {
    /// Whether it is a point; else it is ideal, the end of a ray or line.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.position.w != 0.0
    }

    /// Its coordinates, correctly rounded; `None` for an ideal vertex.
    #[inline]
    #[must_use]
    pub fn to_euclidean(&self) -> Option<DVec3> {
        self.is_finite().then(|| self.position.truncate())
    }

    /// The unit direction in which an ideal vertex lies; `None` for a finite one.
    #[inline]
    #[must_use]
    pub fn direction(&self) -> Option<DVec3> {
        (!self.is_finite()).then(|| self.position.truncate())
    }
}

impl IncrementalPolytope {
    /// How many vertices are seen: finite ones and the ideal ends of rays and lines.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_names().count()
    }

    /// The vertices seen from outside: each once, under its smallest handle; finite ones first, then by handle.
    ///
    /// Cost: about linear in the polytope.
    pub fn vertices(&self) -> impl Iterator<Item = (VertexIdx, Vertex)> {
        let mut clusters = Clusters::whole(self);
        self.finite_first().filter_map(move |slot| {
            let is_name = clusters.cluster(slot) == slot && !clusters.is_hidden(slot);
            is_name.then(|| (VertexIdx(slot), clusters.vertex(slot)))
        })
    }

    /// The seen vertex that a vertex of the simple structure belongs to; any handle that an operation gave will do.
    ///
    /// `None` where there is no such vertex, and for one hidden at infinity, on two infinity planes or more
    /// (all are hidden while the set is empty). Cost: proportional to the coincident vertices and their faces' next corners, not to the
    /// polytope.
    #[must_use]
    pub fn vertex(&self, idx: VertexIdx) -> Option<Vertex> {
        if self.is_empty() || !self.vertices.is_live(idx.0) || self.infinity_planes(idx.0) > 1 {
            return None;
        }
        let mut clusters = Clusters::local(self);
        let name = clusters.cluster(idx.0);
        Some(clusters.vertex(name))
    }

    /// The slots that name seen vertices, finite ones first.
    pub(super) fn vertex_names(&self) -> impl Iterator<Item = u32> {
        let mut clusters = Clusters::whole(self);
        self.finite_first().filter(move |slot| clusters.cluster(*slot) == *slot && !clusters.is_hidden(*slot))
    }

    /// All live slots, the ideal vertices last; none where the set is empty.
    fn finite_first(&self) -> impl Iterator<Item = u32> {
        let shown = if self.is_empty() { 0 } else { usize::MAX };
        let ideal = |wanted: bool| self.vertices.slots().filter(move |slot| self.vertices.is_ideal(*slot) == wanted);
        ideal(false).chain(ideal(true)).take(shown)
    }
}

impl Clusters<'_> {
    /// The seen vertex of a cluster, by name.
    pub(super) fn vertex(&mut self, name: u32) -> Vertex {
        let polytope = self.polytope;
        let (mut planes, mut edges) = (Vec::new(), Vec::new());
        for member in self.members(name, Naming::Settled) {
            for (k, plane) in polytope.vertices.planes(member).into_iter().enumerate() {
                if !is_infinity(plane) && self.is_seen(plane, member, Naming::Settled) {
                    planes.push(external(plane));
                }
                edges.extend(self.bundle(Link::new(member, k)).map(|bundle| bundle.name));
            }
        }
        planes.sort_unstable();
        planes.dedup();
        edges.sort_unstable();
        edges.dedup();
        Vertex { position: polytope.position(name), planes, edges }
    }
}
