//! Seen faces.

use std::collections::HashMap;

use super::super::infinity::is_infinity;
use super::super::store::{BEFORE, NEXT};
use super::super::{IncrementalPolytope, PlaneIdx, external};
use super::cluster::{Clusters, Naming};

/// A face as seen from outside. Faces are listed by plane, in the order of the handles.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FacetEdge {
    /// The plane of the facet on the other side of the edge; `None` for an infinity plane.
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
    /// outside. Each edge is named by the facet on its other side: planes that merely touch are nowhere named. Edges of
    /// exactly zero length are left out; the tolerance takes no part. Corner `i` is where the plane and
    /// the edge planes `i` and `i + 1` meet, right-handed in this order. Infinity planes are `None`.
    #[must_use]
    pub fn facets(&self) -> Vec<(PlaneIdx, Vec<Option<PlaneIdx>>)> {
        let mut facets = Vec::new();
        self.for_each_facet(|plane, edges| facets.push((plane, edges.iter().map(|edge| edge.plane).collect())));
        facets
    }

    /// Calls `visit` for each of the [`facets`](Self::facets), without making a list of each.
    pub fn for_each_facet(&self, mut visit: impl FnMut(PlaneIdx, &[FacetEdge])) {
        // which faces are slivers is known once all were looked at
        let half_edges = 3 * self.vertices.slot_count();
        let (mut edges, mut ends, mut slivers) = (Vec::with_capacity(half_edges), Vec::new(), Slivers::default());
        let mut known = vec![None; half_edges];
        for plane in self.planes.faces().filter(|plane| !self.is_empty() && !is_infinity(*plane)) {
            let start = edges.len();
            self.exact_edges(plane, &mut edges, &mut known);
            match edges[start..] {
                [] | [_] => edges.truncate(start),
                [one, other] => {
                    slivers.add(plane, [one.plane, other.plane]);
                    edges.truncate(start);
                }
                _ => ends.push((plane, edges.len())),
            }
        }
        let (mut start, mut facet) = (0, Vec::new());
        for (plane, end) in ends {
            let edges = &edges[start..end];
            start = end;
            facet.clear();
            facet.extend((0..edges.len()).map(|k| {
                let (edge, next) = (&edges[k], &edges[(k + 1) % edges.len()]);
                let across = slivers.beyond(plane, edge.plane);
                FacetEdge {
                    plane: (!is_infinity(across)).then(|| external(across)),
                    corner: (edge.end == next.start).then_some(edge.end as usize),
                }
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
        self.exact_edges(plane, &mut edges, &mut []);
        edges.into_iter().map(|edge| edge.plane).collect()
    }

    /// Adds a face's edges in order, without those of exactly no length. `has_length` is told of the half-edges that were met from the face on
    /// the other side, by vertex and place there; where it is empty, nothing is kept.
    fn exact_edges(&self, plane: u32, edges: &mut Vec<FaceEdge>, has_length: &mut [Option<bool>]) {
        for (vertex, k) in self.vertices.face_corners(plane, self.planes.face_vertex(plane)) {
            // the edge from this vertex (plane, p, q) to the next lies on q
            let planes = self.vertices.planes(vertex);
            let next = self.vertices.link(vertex, NEXT[k]);
            let known = has_length.get(3 * vertex as usize + k).copied().flatten();
            let is_long = known.unwrap_or_else(|| {
                let across = self.vertices.planes(next.vertex())[next.index()];
                let is_long = !self.is_exactly_on(planes, across);
                // seen from q it begins there, before the plane that is across
                if let Some(opposite) = has_length.get_mut(3 * next.vertex() as usize + BEFORE[next.index()]) {
                    *opposite = Some(is_long);
                }
                is_long
            });
            if is_long {
                edges.push(FaceEdge { plane: planes[BEFORE[k]], start: vertex, end: next.vertex() });
            }
        }
    }
}

/// An edge of a stored face, its ends as slots.
#[derive(Clone, Copy)]
struct FaceEdge {
    plane: u32,
    start: u32,
    end: u32,
}

/// The faces without area that have two edges of the same length: their planes touch in an edge, between two facets or with
/// more of their kind. What is seen from a facet across its edge lies beyond them.
#[derive(Default)]
struct Slivers {
    /// By plane, ascending, the planes across both edges.
    sides: Vec<(u32, [u32; 2])>,
}

impl Slivers {
    /// Adds the next one; planes are given in ascending order.
    fn add(&mut self, plane: u32, sides: [u32; 2]) {
        self.sides.push((plane, sides));
    }

    /// The plane that is seen beyond an edge from one of two neighbouring planes to the other.
    fn beyond(&self, mut from: u32, mut plane: u32) -> u32 {
        // a chain of slivers, each passed from edge to edge, ends at a facet; none comes twice
        for _ in 0..self.sides.len() {
            let Ok(found) = self.sides.binary_search_by_key(&plane, |sliver| sliver.0) else { break };
            let [one, other] = self.sides[found].1;
            (from, plane) = (plane, if one == from { other } else { one });
        }
        plane
    }
}
