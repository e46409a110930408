//! The cuts of polygons: what triangles have in common, joined across the diagonals of both.
//!
//! Two triangles share a segment of the line in which their planes meet. Where that ends at a diagonal, the next triangle of the polygon
//! goes on. So segments of two polygons are joined ([`chains`](super::chains)) where just two end in a point that a diagonal, or a vertex
//! within a polygon, defines; unless something else ends there, or an edge is divided: then all that know the point keep it.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::chains::{Vanished, join};
use super::contact::{Along, Contacts, Cut, EdgeCut, InputKey, half_edge};
use super::edge_points::PointOnEdge;
use super::points::PointKey;
use super::polygons::Polygons;
use super::surface::{Surface, sorted};
use crate::base::map_chunks;
use crate::ids::{Id, InputTriangleId, InputVertexId, PointId, TriangleId};

/// Contacts that one thread looks at in a row.
const CHUNK: usize = 1 << 10;

/// A segment within a polygon or triangle; or a point, at which cuts through it are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct KeyedCut {
    /// What is cut, and what it comes from: polygons by their first triangles.
    pub(super) triangle: TriangleId,
    pub(super) other: TriangleId,
    /// The edge of the other one that it lies on.
    pub(super) edge: Option<[PointId; 2]>,
    pub(super) ends: [PointKey; 2],
}

impl KeyedCut {
    pub(super) fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// What cuts polygons and edges.
#[derive(Debug, Default)]
pub(super) struct JoinedCuts {
    pub(super) cuts: Vec<KeyedCut>,
    pub(super) on_edges: Vec<PointOnEdge>,
    /// Triangles that touch along a diagonal, which is none of their edges any more.
    pub(super) pairs: Vec<[InputTriangleId; 2]>,
}

/// A point inside an edge, in numbers of the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeyedEdgeCut {
    /// A half-edge along it.
    side: u32,
    /// The triangle that cuts it.
    other: InputTriangleId,
    pub(super) edge: [PointId; 2],
    pub(super) key: PointKey,
    /// Whether the edge lies within a polygon.
    pub(super) is_diagonal: bool,
}

/// Joins what triangles have in common; `key` gives keys of contacts in numbers of the surface.
pub(super) fn joined_cuts(
    surface: &Surface<'_>,
    polygons: &Polygons,
    planes: &[TriangleId],
    contacts: &Contacts,
    key: impl Fn(InputKey) -> PointKey + Sync,
) -> JoinedCuts {
    let has_polygons = polygons.all().next().is_some();
    let keyed = |cut: &EdgeCut| {
        let side = surface.half_edge_of(cut.side);
        let edge = surface.edge(TriangleId::from_index(side as usize / 3), side as usize % 3);
        let is_diagonal = polygons.is_diagonal(surface, side);
        KeyedEdgeCut { side, other: cut.other, edge, key: key(cut.key), is_diagonal }
    };
    let edge_cuts: Vec<KeyedEdgeCut> = contacts.edge_cuts.par_iter().with_min_len(CHUNK).map(keyed).collect();
    let mut joining = Joining { surface, polygons, planes, edges_at: FxHashMap::default() };
    for KeyedEdgeCut { side, edge, key, is_diagonal, .. } in edge_cuts.iter().filter(|_| has_polygons) {
        if let PointKey::Vertex(vertex) = key
            && polygons.is_within(*vertex)
            && !is_diagonal
        {
            let polygon = polygons.of(TriangleId::from_index(*side as usize / 3));
            joining.edges_at.entry((polygon, *vertex)).or_default().push(*edge);
        }
    }
    let mut found = JoinedCuts { cuts: joining.cuts(contacts, &key), ..JoinedCuts::default() };
    joining.at_shared_edges(contacts, &mut found);
    found.cuts.par_sort_unstable();
    found.cuts.dedup();
    let mut vanished = Vanished::default();
    if has_polygons {
        (found.cuts, vanished) = join(&joining, &found.cuts, &edge_cuts);
    }
    let parts = map_chunks(&edge_cuts, CHUNK, |cuts| joining.points_on_edges(cuts, &vanished)).0;
    for (on_edges, points) in parts {
        found.on_edges.extend(on_edges);
        found.cuts.extend(points);
    }
    found
}

/// What is known as cuts are joined.
pub(super) struct Joining<'a> {
    surface: &'a Surface<'a>,
    pub(super) polygons: &'a Polygons,
    planes: &'a [TriangleId],
    /// For each polygon and vertex within another one the edges of the first that go through the vertex.
    edges_at: FxHashMap<(TriangleId, PointId), Vec<[PointId; 2]>>,
}

impl Joining<'_> {
    fn edge(&self, [a, b]: [InputVertexId; 2]) -> [PointId; 2] {
        sorted(self.surface.vertex_of(a), self.surface.vertex_of(b))
    }

    /// The cuts of contacts, and those along diagonals: what runs along the edge of a triangle is no cut of that, but one of its polygon.
    fn cuts(&self, contacts: &Contacts, key: &(impl Fn(InputKey) -> PointKey + Sync)) -> Vec<KeyedCut> {
        let cut = |cut: &Cut| {
            let edge = cut.edge.map(|edge| self.edge(edge));
            self.cut([cut.triangle, cut.other], edge, cut.ends.map(key))
        };
        let along = |along: &Along| self.along_diagonal(along, key);
        let mut parts = map_chunks(&contacts.cuts, CHUNK, |cuts| cuts.iter().filter_map(cut).collect()).0;
        parts.extend(map_chunks(&contacts.along, CHUNK, |cuts| cuts.iter().filter_map(along).collect::<Vec<_>>()).0);
        parts.concat()
    }

    /// A cut that is none of polygons alone: it does not lie on a diagonal of the other one within its plane.
    fn cut(
        &self,
        triangles: [InputTriangleId; 2],
        edge: Option<[PointId; 2]>,
        ends: [PointKey; 2],
    ) -> Option<KeyedCut> {
        let [p, q] = triangles.map(|triangle| self.surface.triangle_of(triangle));
        let [triangle, other] = [p, q].map(|triangle| self.polygons.of(triangle));
        let is_along = edge.is_some_and(|edge| self.polygons.has_diagonal(other, edge));
        if is_along && self.planes[p.index()] == self.planes[q.index()]
            || ends[0] == ends[1] && self.is_nothing([triangle, other], &ends[0])
        {
            return None;
        }
        let ends = if ends[0] < ends[1] { ends } else { [ends[1], ends[0]] };
        // along a diagonal a cut may go on, unless that is an edge of something else
        let edge = edge.filter(|edge| !is_along || self.polygons.is_shared(*edge));
        Some(KeyedCut { triangle, other, edge, ends })
    }

    /// Whether a point is none of two polygons' borders, but one that comes of how they are cut into triangles.
    fn is_nothing(&self, pair: [TriangleId; 2], key: &PointKey) -> bool {
        let is_diagonal = |edge: &[PointId; 2]| self.polygons.have_mere_diagonal(pair, *edge);
        match key {
            PointKey::Vertex(vertex) => self.polygons.is_within(*vertex),
            PointKey::EdgePlane { edge, .. } => is_diagonal(edge),
            PointKey::EdgeEdge(edges) => edges.iter().all(is_diagonal),
            PointKey::ThreePlanes(_) => false,
        }
    }

    /// Whether segments of some polygons may go on into one another at a point.
    pub(super) fn may_join(&self, key: &PointKey) -> bool {
        let is_diagonal = |edge: &[PointId; 2]| self.polygons.is_mere_diagonal(*edge);
        match key {
            PointKey::Vertex(vertex) => self.polygons.is_within(*vertex),
            PointKey::EdgePlane { edge, .. } => is_diagonal(edge),
            PointKey::EdgeEdge(edges) => edges.iter().any(is_diagonal),
            PointKey::ThreePlanes(_) => false,
        }
    }

    /// Whether two segments that end in a point go on into one another.
    pub(super) fn joins(&self, cut: &KeyedCut, key: &PointKey) -> bool {
        let pair = [cut.triangle, cut.other];
        let is_diagonal = |edge: &[PointId; 2]| self.polygons.have_mere_diagonal(pair, *edge);
        match key {
            PointKey::Vertex(vertex) => {
                let is_on_other = |polygon: &TriangleId| {
                    let edges = self.edges_at.get(&(*polygon, *vertex));
                    edges.is_some_and(|edges| edges.iter().any(|edge| Some(*edge) != cut.edge))
                };
                self.polygons.is_within(*vertex) && !pair.iter().any(is_on_other)
            }
            PointKey::EdgePlane { edge, .. } => is_diagonal(edge),
            PointKey::EdgeEdge([one, other]) => {
                let are_diagonals = [is_diagonal(one), is_diagonal(other)];
                let goes_on = |k: usize, edge: &[PointId; 2]| are_diagonals[k] || Some(*edge) == cut.edge;
                are_diagonals.contains(&true) && goes_on(0, one) && goes_on(1, other)
            }
            PointKey::ThreePlanes(_) => false,
        }
    }

    /// The cut along an edge of a triangle, where that is a diagonal.
    fn along_diagonal(&self, along: &Along, key: &impl Fn(InputKey) -> PointKey) -> Option<KeyedCut> {
        if !self.polygons.is_diagonal(self.surface, self.surface.half_edge_of(along.side)) {
            return None;
        }
        let triangle = InputTriangleId::from_index(along.side as usize / 3);
        let own = self.surface.edge(self.surface.triangle_of(triangle), along.side as usize % 3);
        let edge = along.edge.map(|edge| self.edge(edge));
        let cut = self.cut([triangle, along.other], edge, along.ends.map(key))?;
        // a diagonal of the other one alone says less than one that is an edge of something else
        let own = Some(own).filter(|own| self.polygons.is_shared(*own));
        Some(KeyedCut { edge: cut.edge.or(own), ..cut })
    }

    /// Adds cuts along diagonals that are edges of other triangles from end to end.
    fn at_shared_edges(&self, contacts: &Contacts, found: &mut JoinedCuts) {
        let surface = self.surface;
        let mut add = |one: u32, other: u32| {
            if !self.polygons.is_diagonal(surface, surface.half_edge_of(one)) {
                return;
            }
            let triangles = [one, other].map(|side| InputTriangleId::from_index(side as usize / 3));
            let edge = surface.edge(surface.triangle_of(triangles[0]), one as usize % 3);
            found.cuts.extend(self.cut(triangles, Some(edge), edge.map(PointKey::Vertex)));
            found.pairs.push(triangles);
        };
        for [one, other] in &contacts.shared_edges {
            add(*one, *other);
            add(*other, *one);
        }
        for pair in &contacts.identical {
            let [p, q] = pair.map(|triangle| surface.triangle_of(triangle));
            if ![p, q].iter().any(|triangle| self.polygons.has(*triangle)) {
                continue;
            }
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                if surface.edge(p, i) == surface.edge(q, j) {
                    let sides = [(pair[0], i), (pair[1], j)].map(|(t, side)| half_edge(t, side));
                    add(sides[0], sides[1]);
                    add(sides[1], sides[0]);
                }
            }
        }
    }

    /// The points at which edges are cut, and those within polygons, at which cuts are.
    fn points_on_edges(&self, edge_cuts: &[KeyedEdgeCut], vanished: &Vanished) -> (Vec<PointOnEdge>, Vec<KeyedCut>) {
        let (mut on_edges, mut points) = (Vec::new(), Vec::new());
        for KeyedEdgeCut { side, other, edge, key, is_diagonal } in edge_cuts {
            let may_vanish = !vanished.is_empty() && self.may_join(key);
            let is_gone = |edge: &[PointId; 2]| may_vanish && vanished.contains(&(*edge, *key));
            if !is_diagonal {
                if !is_gone(edge) {
                    on_edges.push(PointOnEdge { side: *side, key: *key });
                }
                continue;
            }
            // a point within a polygon: other cuts may go through it
            let triangle = TriangleId::from_index(*side as usize / 3);
            let pair = [triangle, self.surface.triangle_of(*other)].map(|triangle| self.polygons.of(triangle));
            let is_gone = match key {
                PointKey::EdgeEdge(edges) => edges.iter().any(is_gone),
                _ => false,
            };
            if !is_gone && !self.is_nothing(pair, key) {
                points.push(KeyedCut { triangle: pair[0], other: pair[1], edge: None, ends: [*key; 2] });
            }
        }
        (on_edges, points)
    }
}
