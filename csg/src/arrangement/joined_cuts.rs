//! The cuts of polygons: what triangles have in common, joined across the diagonals of both.
//!
//! Two triangles share a segment of the line in which their planes meet. Where that ends at a diagonal, the next triangle of the polygon
//! goes on. So segments of two polygons are joined where just two end in a point that a diagonal, or a vertex within a polygon, defines;
//! unless something else ends there, or an edge is divided: then all that know the point keep it.

use planecut_parallel::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::contact::{Contacts, EdgeCut, InputKey, half_edge};
use super::edge_points::PointOnEdge;
use super::points::PointKey;
use super::polygons::Polygons;
use super::surface::{Surface, sorted};
use crate::ids::{Id, InputTriangleId, InputVertexId, PointId, TriangleId};

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
    fn is_point(&self) -> bool {
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

/// Joins what triangles have in common; `key` gives keys of contacts in numbers of the surface.
pub(super) fn joined_cuts(
    surface: &Surface<'_>,
    polygons: &Polygons,
    planes: &[TriangleId],
    contacts: &Contacts,
    key: impl Fn(InputKey) -> PointKey,
) -> JoinedCuts {
    let has_polygons = polygons.all().next().is_some();
    let on_edge = |cut: &EdgeCut| {
        let side = surface.half_edge_of(cut.side);
        let edge = surface.edge(TriangleId::from_index(side as usize / 3), side as usize % 3);
        (side, edge, key(cut.key))
    };
    let mut joining = Joining { surface, polygons, planes, edges_at: FxHashMap::default() };
    for (side, edge, key) in contacts.edge_cuts.iter().filter(|_| has_polygons).map(on_edge) {
        if let PointKey::Vertex(vertex) = key
            && polygons.is_within(vertex)
            && !polygons.is_diagonal(surface, side)
        {
            let polygon = polygons.of(TriangleId::from_index(side as usize / 3));
            joining.edges_at.entry((polygon, vertex)).or_default().push(edge);
        }
    }
    let mut found = JoinedCuts::default();
    for cut in &contacts.cuts {
        let edge = cut.edge.map(|edge| joining.edge(edge));
        found.cuts.extend(joining.cut([cut.triangle, cut.other], edge, cut.ends.map(&key)));
    }
    joining.along_diagonals(contacts, &key, &mut found);
    found.cuts.par_sort_unstable();
    found.cuts.dedup();
    let mut vanished = FxHashSet::default();
    if has_polygons {
        let divided = contacts.edge_cuts.iter().map(on_edge);
        let divided = divided.filter(|(side, ..)| !polygons.is_diagonal(surface, *side));
        let stays = joining.ends(&found.cuts, divided.map(|(_, edge, key)| (edge, key)));
        vanished = joining.join(&mut found.cuts, &stays);
    }
    for cut in &contacts.edge_cuts {
        let (side, edge, key) = on_edge(cut);
        if !polygons.is_diagonal(surface, side) {
            if !vanished.contains(&(edge, key)) {
                found.on_edges.push(PointOnEdge { side, key });
            }
            continue;
        }
        // a point within a polygon: other cuts may go through it
        let triangle = TriangleId::from_index(side as usize / 3);
        let pair = [triangle, surface.triangle_of(cut.other)].map(|triangle| polygons.of(triangle));
        let is_gone = match key {
            PointKey::EdgeEdge(edges) => edges.iter().any(|edge| vanished.contains(&(*edge, key))),
            _ => false,
        };
        if !is_gone && !joining.is_nothing(pair, &key) {
            found.cuts.push(KeyedCut { triangle: pair[0], other: pair[1], edge: None, ends: [key; 2] });
        }
    }
    found
}

struct Joining<'a> {
    surface: &'a Surface<'a>,
    polygons: &'a Polygons,
    planes: &'a [TriangleId],
    /// For each polygon and vertex within another one the edges of the first that go through the vertex.
    edges_at: FxHashMap<(TriangleId, PointId), Vec<[PointId; 2]>>,
}

impl Joining<'_> {
    fn edge(&self, [a, b]: [InputVertexId; 2]) -> [PointId; 2] {
        sorted(self.surface.vertex_of(a), self.surface.vertex_of(b))
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
        let edge = edge.filter(|edge| !is_along || self.polygons.is_shared(edge));
        Some(KeyedCut { triangle, other, edge, ends })
    }

    /// Whether a point is none of two polygons' borders, but one that comes of how they are cut into triangles.
    fn is_nothing(&self, pair: [TriangleId; 2], key: &PointKey) -> bool {
        let is_diagonal =
            |edge: &[PointId; 2]| pair.iter().any(|polygon| self.polygons.has_mere_diagonal(*polygon, *edge));
        match key {
            PointKey::Vertex(vertex) => self.polygons.is_within(*vertex),
            PointKey::EdgePlane { edge, .. } => is_diagonal(edge),
            PointKey::EdgeEdge(edges) => edges.iter().all(is_diagonal),
            PointKey::ThreePlanes(_) => false,
        }
    }

    /// Whether two segments that end in a point go on into one another.
    fn joins(&self, cut: &KeyedCut, key: &PointKey) -> bool {
        let pair = [cut.triangle, cut.other];
        let is_diagonal =
            |edge: &[PointId; 2]| pair.iter().any(|polygon| self.polygons.has_mere_diagonal(*polygon, *edge));
        match key {
            PointKey::Vertex(vertex) => {
                let is_on_other = |polygon: &TriangleId| {
                    let edges = self.edges_at.get(&(*polygon, *vertex));
                    edges.is_some_and(|edges| edges.iter().any(|edge| Some(*edge) != cut.edge))
                };
                self.polygons.is_within(*vertex) && !pair.iter().any(is_on_other)
            }
            PointKey::EdgePlane { edge, .. } => is_diagonal(edge),
            PointKey::EdgeEdge(edges) => {
                edges.iter().any(is_diagonal) && edges.iter().all(|edge| is_diagonal(edge) || Some(*edge) == cut.edge)
            }
            PointKey::ThreePlanes(_) => false,
        }
    }

    /// Adds cuts along diagonals: what runs along the edge of a triangle is no cut of that, but one of its polygon.
    fn along_diagonals(&self, contacts: &Contacts, key: &impl Fn(InputKey) -> PointKey, found: &mut JoinedCuts) {
        let surface = self.surface;
        for along in &contacts.along {
            let side = surface.half_edge_of(along.side);
            if self.polygons.is_diagonal(surface, side) {
                let triangle = InputTriangleId::from_index(along.side as usize / 3);
                let own = surface.edge(surface.triangle_of(triangle), along.side as usize % 3);
                let edge = along.edge.map(|edge| self.edge(edge));
                let cut = self.cut([triangle, along.other], edge, along.ends.map(key));
                // a diagonal of the other one alone says less than one that is an edge of something else
                let own = Some(own).filter(|own| self.polygons.is_shared(own));
                found.cuts.extend(cut.map(|cut| KeyedCut { edge: cut.edge.or(own), ..cut }));
            }
        }
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
            if [p, q].iter().all(|triangle| self.polygons.members(self.polygons.of(*triangle)).is_empty()) {
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

    /// The points at which no cuts are joined, although some might be: another cut ends there, or an edge is divided.
    fn ends(&self, cuts: &[KeyedCut], edges: impl Iterator<Item = ([PointId; 2], PointKey)>) -> FxHashSet<PointKey> {
        let mut ends = FxHashSet::default();
        let mut within_edges = FxHashSet::default();
        let mut degree: FxHashMap<PointKey, u32> = FxHashMap::default();
        for group in self.groups(cuts).filter(|group| self.is_of_polygon(group)) {
            degree.clear();
            for cut in group.iter().filter(|cut| !cut.is_point()) {
                cut.ends.iter().for_each(|end| *degree.entry(*end).or_insert(0) += 1);
            }
            for (end, degree) in &degree {
                if *degree != 2 || !self.joins(&group[0], end) {
                    ends.insert(*end);
                } else if let Some(edge) = group[0].edge {
                    within_edges.insert((edge, *end));
                }
            }
        }
        ends.extend(edges.filter(|point| !within_edges.contains(point)).map(|(_, key)| key));
        ends
    }

    /// Cuts of the same two polygons, and along the same edge.
    fn groups<'b>(&self, cuts: &'b [KeyedCut]) -> impl Iterator<Item = &'b [KeyedCut]> {
        cuts.chunk_by(|a, b| (a.triangle, a.other, a.edge) == (b.triangle, b.other, b.edge))
    }

    fn is_of_polygon(&self, group: &[KeyedCut]) -> bool {
        [group[0].triangle, group[0].other].iter().any(|first| !self.polygons.members(*first).is_empty())
    }

    /// Joins cuts, sorted afterwards, but for those at some ends. Gives the points at which cuts along edges of others were joined, with
    /// these edges.
    fn join(&self, cuts: &mut Vec<KeyedCut>, stays: &FxHashSet<PointKey>) -> FxHashSet<([PointId; 2], PointKey)> {
        let mut vanished = FxHashSet::default();
        let all = std::mem::take(cuts);
        // the two cuts of a group that end in a point
        let mut at: FxHashMap<PointKey, [usize; 2]> = FxHashMap::default();
        for group in self.groups(&all) {
            if group.len() == 1 || !self.is_of_polygon(group) {
                cuts.extend(group);
                continue;
            }
            at.clear();
            for (k, cut) in group.iter().enumerate().filter(|(_, cut)| !cut.is_point()) {
                for end in cut.ends.iter().filter(|end| !stays.contains(end)) {
                    at.entry(*end).or_insert([k; 2])[1] = k;
                }
            }
            let mut is_done = vec![false; group.len()];
            for start in 0..group.len() {
                if std::mem::replace(&mut is_done[start], true) {
                    continue;
                }
                let mut ends = group[start].ends;
                for end in ends.iter_mut().filter(|_| !group[start].is_point()) {
                    let mut k = start;
                    while let Some([one, other]) = at.get(end) {
                        k = if *one == k { *other } else { *one };
                        if std::mem::replace(&mut is_done[k], true) {
                            break;
                        }
                        vanished.extend(group[0].edge.map(|edge| (edge, *end)));
                        let [a, b] = group[k].ends;
                        *end = if a == *end { b } else { a };
                    }
                }
                let ends = if ends[0] < ends[1] { ends } else { [ends[1], ends[0]] };
                cuts.push(KeyedCut { ends, ..group[start] });
            }
        }
        cuts.par_sort_unstable();
        vanished
    }
}
