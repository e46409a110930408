//! Seen faces.

use std::collections::HashMap;

use super::super::infinity::is_infinity;
use super::super::store::{BEFORE, NEXT};
use super::super::{IncrementalPolytope, PlaneIdx, external};
use super::cluster::{Clusters, Naming};

/// A face as seen from outside.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Face {
    /// The plane it lies on.
    pub plane: PlaneIdx,
    /// Its finite corners, counter-clockwise seen from outside, as indices into the vertices that
    /// [`IncrementalPolytope::to_mesh`] gives. Those of an unbounded face begin after its way through infinity; it may
    /// have none.
    pub vertices: Vec<usize>,
    /// Whether it is a polygon; else it reaches infinity.
    pub is_bounded: bool,
}

/// An edge of a facet and the corner at its end; see [`IncrementalPolytope::for_each_facet`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacetEdge {
    /// The plane on the other side of the edge; `None` for an infinity plane.
    pub plane: Option<PlaneIdx>,
    /// A number that the facets at a corner share where exactly three planes make it, below
    /// [`corner_bound`](IncrementalPolytope::corner_bound); `None` where an edge of no length was left out.
    pub corner: Option<usize>,
}

impl IncrementalPolytope {
    /// The seen faces, unbounded ones included, by plane; corners index the vertices of [`to_mesh`](Self::to_mesh).
    #[must_use]
    pub fn faces(&self) -> Vec<Face> {
        let names: Vec<u32> = self.vertex_names().filter(|slot| !self.vertices.is_ideal(*slot)).collect();
        self.faces_among(&names)
    }

    /// The seen faces, their corners as indices into `names`, the slots that name the finite vertices.
    pub(super) fn faces_among(&self, names: &[u32]) -> Vec<Face> {
        let number: HashMap<u32, usize> = names.iter().enumerate().map(|(number, slot)| (*slot, number)).collect();
        let mut clusters = Clusters::whole(self);
        let mut faces = Vec::new();
        for plane in self.planes.faces().filter(|plane| !self.is_empty() && !is_infinity(*plane)) {
            let start = self.planes.face_vertex(plane);
            if !clusters.is_seen(plane, start, Naming::Settled) {
                continue;
            }
            let mut corners: Vec<u32> =
                self.vertices.face_ring(plane, start).map(|slot| clusters.cluster(slot)).collect();
            let at_infinity = corners.iter().rposition(|slot| self.vertices.is_ideal(*slot));
            corners.rotate_left(at_infinity.map_or(0, |last| last + 1));
            let mut vertices: Vec<usize> = corners.iter().filter_map(|slot| number.get(slot).copied()).collect();
            vertices.dedup();
            if at_infinity.is_none() && vertices.len() > 1 && vertices.first() == vertices.last() {
                vertices.pop();
            }
            faces.push(Face { plane: external(plane), vertices, is_bounded: at_infinity.is_none() });
        }
        faces
    }

    /// The faces that have an area, exactly: for each its plane and the planes of its edges, counter-clockwise seen from
    /// outside. Edges of exactly zero length are left out; the tolerance takes no part. Corner `i` is where the plane and
    /// the edge planes `i` and `i + 1` meet, right-handed in this order. Infinity planes are `None`.
    #[must_use]
    pub fn facets(&self) -> Vec<(PlaneIdx, Vec<Option<PlaneIdx>>)> {
        let mut facets = Vec::new();
        self.for_each_facet(|plane, edges| facets.push((plane, edges.iter().map(|edge| edge.plane).collect())));
        facets
    }

    /// Calls `visit` for each of the [`facets`](Self::facets), without making a list of each.
    pub fn for_each_facet(&self, mut visit: impl FnMut(PlaneIdx, &[FacetEdge])) {
        let (mut edges, mut facet) = (Vec::new(), Vec::new());
        for plane in self.planes.faces().filter(|plane| !self.is_empty() && !is_infinity(*plane)) {
            self.exact_edges(plane, &mut edges);
            if edges.len() < 3 {
                continue;
            }
            facet.clear();
            facet.extend((0..edges.len()).map(|k| {
                let (edge, next) = (&edges[k], &edges[(k + 1) % edges.len()]);
                let plane = (!is_infinity(edge.plane)).then(|| external(edge.plane));
                FacetEdge { plane, corner: (edge.end == next.start).then_some(edge.end as usize) }
            }));
            visit(external(plane), &facet);
        }
    }

    /// All numbers of corners are below this.
    #[must_use]
    pub fn corner_bound(&self) -> usize {
        self.vertices.slot_count()
    }

    /// The planes of a face's edges in order, without those of exactly no length.
    pub(in crate::polytope) fn edge_planes(&self, plane: u32) -> Vec<u32> {
        let mut edges = Vec::new();
        self.exact_edges(plane, &mut edges);
        edges.into_iter().map(|edge| edge.plane).collect()
    }

    /// Replaces what is in a list by a face's edges in order, without those of exactly no length.
    fn exact_edges(&self, plane: u32, edges: &mut Vec<FaceEdge>) {
        edges.clear();
        for (vertex, k) in self.vertices.face_corners(plane, self.planes.face_vertex(plane)) {
            // the edge from this vertex (plane, p, q) to the next lies on q
            let planes = self.vertices.planes(vertex);
            let next = self.vertices.link(vertex, NEXT[k]);
            let across = self.vertices.planes(next.vertex())[next.index()];
            if !self.is_exactly_on(planes, across) {
                edges.push(FaceEdge { plane: planes[BEFORE[k]], start: vertex, end: next.vertex() });
            }
        }
    }
}

/// An edge of a stored face, its ends as slots.
struct FaceEdge {
    plane: u32,
    start: u32,
    end: u32,
}
