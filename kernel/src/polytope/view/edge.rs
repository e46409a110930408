//! Seen edges: segments, rays and lines, each a bundle of one or more edges of the simple structure.

use glam::DVec3;

use super::super::infinity::is_infinity;
use super::super::store::{BEFORE, Link, NEXT};
use super::super::{IncrementalPolytope, PlaneIdx, VertexIdx, external};
use super::cluster::{Clusters, Naming};
use crate::meet::direction;

/// Handle of an edge: four times the slot of a vertex of the simple structure at one end, plus which of its three edges.
///
/// A removed edge's handle is given to a later one. Several edges of the simple structure can be seen as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeIdx(pub u32);

/// What an edge is (paper §3.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EdgeKind {
    /// Both ends are finite.
    Segment,
    /// One end is ideal.
    Ray,
    /// Both ends are ideal.
    Line,
}

/// An edge as seen from outside (paper §3.6, §6.1).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Edge {
    /// The planes whose seen faces meet there, the smaller handle first.
    pub planes: (PlaneIdx, PlaneIdx),
    /// Its ends, under the names that [`IncrementalPolytope::vertices`] gives them: the smaller handle of a segment
    /// first, the finite end of a ray first, the end of a line in its direction last.
    pub vertices: (VertexIdx, VertexIdx),
    /// Segment, ray or line.
    pub kind: EdgeKind,
    /// Unit direction from the first vertex to the second, each component accurate to a few roundings; that of a line
    /// runs along the cross product of the normals of the two planes, in their order. It is that of the edge itself:
    /// ends that a coarse tolerance merged with others can lie off it.
    pub direction: DVec3,
}

impl Edge {
    /// The end that is not `vertex`; `None` where `vertex` is no end, under the name that `vertices` has.
    #[inline]
    #[must_use]
    pub fn other_vertex(&self, vertex: VertexIdx) -> Option<VertexIdx> {
        match self.vertices {
            (first, second) if first == vertex => Some(second),
            (first, second) if second == vertex => Some(first),
            _ => None,
        }
    }

    /// Whether it lies between the face of a plane and another.
    #[inline]
    #[must_use]
    pub fn is_on_plane(&self, plane: PlaneIdx) -> bool {
        self.planes.0 == plane || self.planes.1 == plane
    }

    /// Whether it is a segment.
    #[inline]
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.kind == EdgeKind::Segment
    }

    /// Whether it is a ray.
    #[inline]
    #[must_use]
    pub fn is_ray(&self) -> bool {
        self.kind == EdgeKind::Ray
    }

    /// Whether it is a whole line.
    #[inline]
    #[must_use]
    pub fn is_line(&self) -> bool {
        self.kind == EdgeKind::Line
    }
}

/// The edges of the simple structure that are seen as one: between them lie faces without other corners.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Bundle {
    /// The smallest handle of all their half-edges.
    pub(in super::super) name: EdgeIdx,
    /// The planes of the seen faces on both sides, ascending.
    planes: [u32; 2],
}

impl IncrementalPolytope {
    /// How many edges are seen: segments, rays and lines.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        let mut clusters = Clusters::whole(self);
        self.half_edges().filter(|edge| clusters.names_an_edge(*edge)).count()
    }

    /// The edges seen from outside: each once, under its smallest handle, by handle.
    ///
    /// Cost: about linear in the polytope.
    pub fn edges(&self) -> impl Iterator<Item = (EdgeIdx, Edge)> {
        let mut clusters = Clusters::whole(self);
        self.half_edges().filter_map(move |edge| {
            if clusters.names_an_edge(edge) { clusters.edge(edge).map(|seen| (handle(edge), seen)) } else { None }
        })
    }

    /// The seen edge that an edge of the simple structure belongs to, from either of its ends.
    ///
    /// `None` where there is no such edge, and where it is not seen: of no length, or at infinity. Cost: as for
    /// [`vertex`](Self::vertex).
    #[must_use]
    pub fn edge(&self, idx: EdgeIdx) -> Option<Edge> {
        let edge = Link::new(idx.0 >> 2, (idx.0 & 3) as usize);
        if self.is_empty() || edge.index() > 2 || !self.vertices.is_live(edge.vertex()) {
            return None;
        }
        Clusters::local(self).edge(edge)
    }

    /// The edge between the seen faces of two planes, under the name that [`edges`](Self::edges) gives it.
    ///
    /// `None` where there is none. Cost: proportional to the ring of the face of `p`.
    #[must_use]
    pub fn edge_by_planes(&self, p: PlaneIdx, q: PlaneIdx) -> Option<EdgeIdx> {
        let (p, q) = (self.live(p)?, self.live(q)?);
        if self.is_empty() || p == q || !self.planes.has_face(p) || !self.planes.has_face(q) {
            return None;
        }
        let mut clusters = Clusters::local(self);
        let wanted = [p.min(q), p.max(q)];
        let ring: Vec<(Link, u32)> = self.edges_of_face(p, self.planes.face_vertex(p)).collect();
        // Nearly always it is an edge of the simple structure; else faces without area lie between.
        let direct = ring.iter().filter(|(_, across)| *across == q);
        let others = ring.iter().filter(|(_, across)| *across != q && !is_infinity(*across));
        direct.chain(others).find_map(|(edge, _)| {
            let bundle = clusters.bundle(*edge)?;
            (bundle.planes == wanted).then_some(bundle.name)
        })
    }

    /// All half-edges, none where the set is empty.
    fn half_edges(&self) -> impl Iterator<Item = Link> {
        let shown = if self.is_empty() { 0 } else { usize::MAX };
        self.vertices.slots().take(shown).flat_map(|slot| (0..3).map(move |k| Link::new(slot, k)))
    }

    /// The half-edges around a face, each with the plane on its other side.
    pub(super) fn edges_of_face(&self, plane: u32, start: u32) -> impl Iterator<Item = (Link, u32)> {
        // the edge to the next vertex leaves off the plane after this one and lies on the plane before it
        self.vertices
            .face_corners(plane, start)
            .map(|(slot, k)| (Link::new(slot, NEXT[k]), self.vertices.planes(slot)[BEFORE[k]]))
    }

    /// The half-edge with the smaller handle of the two that an edge has.
    pub(super) fn smaller_half(&self, edge: Link) -> Link {
        let twin = self.vertices.link(edge.vertex(), edge.index());
        if handle(twin) < handle(edge) { twin } else { edge }
    }

    /// The two planes an edge lies on: it runs along the cross product of the second normal with the first.
    fn planes_of_edge(&self, edge: Link) -> [u32; 2] {
        let planes = self.vertices.planes(edge.vertex());
        [planes[NEXT[edge.index()]], planes[BEFORE[edge.index()]]]
    }
}

impl Clusters<'_> {
    /// Whether a half-edge is the one under which a seen edge is listed.
    fn names_an_edge(&mut self, edge: Link) -> bool {
        self.polytope.smaller_half(edge) == edge && self.bundle(edge).is_some_and(|bundle| bundle.name == handle(edge))
    }

    /// The bundle of a half-edge, where it is seen.
    pub(in super::super) fn bundle(&mut self, edge: Link) -> Option<Bundle> {
        let edge = self.polytope.smaller_half(edge);
        if let Some(number) = self.known_bundle(handle(edge).0) {
            return Some(self.bundles[number as usize]);
        }
        let (bundled, planes) = self.walk_bundle(edge, Naming::Settled)?;
        let name = bundled.iter().map(|edge| handle(*edge)).min().expect("the edge itself is one");
        let number = self.bundles.len() as u32;
        for edge in bundled {
            self.set_bundle(handle(edge).0, number);
        }
        let bundle = Bundle { name, planes };
        self.bundles.push(bundle);
        Some(bundle)
    }

    /// The edges seen as one with an edge, the smaller half of each, and the planes of the seen faces on both sides,
    /// ascending; `None` where it is not seen.
    pub(super) fn walk_bundle(&mut self, edge: Link, by: Naming) -> Option<(Vec<Link>, [u32; 2])> {
        let edge = self.polytope.smaller_half(edge);
        let sides = self.polytope.planes_of_edge(edge);
        if sides.into_iter().any(is_infinity) || !self.has_length(edge, by) {
            return None;
        }
        let mut bundled = vec![edge];
        let mut planes = [0; 2];
        for (outer, mut plane) in planes.iter_mut().zip(sides) {
            let mut at = edge;
            while !self.is_seen(plane, at.vertex(), by) {
                at = self.other_edge(plane, at, by)?;
                if at == edge {
                    return None; // no face is seen all around; of a settled structure that is sound, none is so
                }
                bundled.push(at);
                let [p, q] = self.polytope.planes_of_edge(at);
                plane = if p == plane { q } else { p };
            }
            *outer = plane;
        }
        planes.sort_unstable();
        Some((bundled, planes))
    }

    /// Whether the ends of an edge are not seen as one.
    pub(super) fn has_length(&mut self, edge: Link, by: Naming) -> bool {
        let end = self.polytope.vertices.link(edge.vertex(), edge.index()).vertex();
        self.named(edge.vertex(), by) != self.named(end, by)
    }

    /// The other edge with a length of a face that has two corners only.
    fn other_edge(&mut self, plane: u32, edge: Link, by: Naming) -> Option<Link> {
        let polytope = self.polytope;
        polytope
            .edges_of_face(plane, edge.vertex())
            .map(|(other, _)| polytope.smaller_half(other))
            .find(|other| *other != edge && self.has_length(*other, by))
    }

    /// The seen edge of a half-edge.
    fn edge(&mut self, edge: Link) -> Option<Edge> {
        let polytope = self.polytope;
        let Bundle { name, planes } = self.bundle(edge)?;
        let edge = Link::new(name.0 >> 2, (name.0 & 3) as usize);
        let mut ends =
            [edge.vertex(), polytope.vertices.link(edge.vertex(), edge.index()).vertex()].map(|v| self.cluster(v));
        let [p, q] = planes.map(|plane| polytope.row(plane));
        let (kind, direction) = match ends.map(|end| polytope.vertices.is_ideal(end)) {
            [false, false] => {
                let [b, c] = polytope.planes_of_edge(edge).map(|plane| polytope.row(plane));
                let along = direction(c, b);
                if ends[0] < ends[1] {
                    (EdgeKind::Segment, along)
                } else {
                    ends.swap(0, 1);
                    (EdgeKind::Segment, -along)
                }
            }
            [true, true] => {
                let along = direction(p, q);
                if polytope.position(ends[0]).truncate().dot(along) > 0.0 {
                    ends.swap(0, 1);
                }
                (EdgeKind::Line, along)
            }
            [starts_ideal, _] => {
                if starts_ideal {
                    ends.swap(0, 1);
                }
                (EdgeKind::Ray, polytope.position(ends[1]).truncate())
            }
        };
        let [first, second] = ends.map(VertexIdx);
        let planes = (external(planes[0]), external(planes[1]));
        Some(Edge { planes, vertices: (first, second), kind, direction })
    }
}

/// The public handle of a half-edge.
pub(super) fn handle(edge: Link) -> EdgeIdx {
    EdgeIdx(edge.vertex() << 2 | edge.index() as u32)
}
