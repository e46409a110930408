//! The triangles of a surface that are cut as one polygon: those of a flat face that something cuts.

use rustc_hash::{FxHashMap, FxHashSet};

use super::contact::Contacts;
use super::flat_faces::is_within_face;
use super::surface::Surface;
use crate::base::DisjointSets;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, PointId, TriangleId, number32};

/// Which triangles are cut as one.
#[derive(Debug)]
pub(super) struct Polygons {
    /// For each triangle the first one of its polygon; it alone where it is none.
    first: Vec<TriangleId>,
    /// The triangles of polygons, each after the first one of its polygon, sorted.
    members: Vec<[TriangleId; 2]>,
    /// For each triangle whether it is of a polygon.
    is_member: Vec<bool>,
    /// The edges within polygons.
    diagonals: FxHashMap<[PointId; 2], Diagonal>,
    /// Those of further polygons at an edge that lies within several.
    further: FxHashSet<(TriangleId, [PointId; 2])>,
    /// For each vertex whether it lies within a polygon for all triangles that have it.
    is_within: Vec<bool>,
}

/// An edge within a polygon.
#[derive(Debug)]
struct Diagonal {
    /// The first polygon that it lies within.
    polygon: TriangleId,
    /// Whether it is an edge of something else, too.
    is_shared: bool,
}

impl Polygons {
    /// `flat_edges` are half-edges with triangles of one plane on both sides; `has_no_area` tells triangles that count for nothing.
    pub(super) fn new(surface: &Surface<'_>, contacts: &Contacts, flat_edges: &[u32], has_no_area: &[bool]) -> Self {
        let parts = Parts::new(surface, contacts, flat_edges);
        let first = parts.cut(surface, contacts);
        let mut members: Vec<[TriangleId; 2]> = (TriangleId::all(first.len())).map(|t| [first[t.index()], t]).collect();
        members.sort_unstable();
        let groups = members.chunk_by(|a, b| a[0] == b[0]).filter(|group| group.len() > 1);
        let members: Vec<[TriangleId; 2]> = groups.flatten().copied().collect();
        let mut is_member = vec![false; first.len()];
        members.iter().for_each(|[_, triangle]| is_member[triangle.index()] = true);
        let mut polygons = Self {
            first,
            members,
            is_member,
            diagonals: FxHashMap::default(),
            further: FxHashSet::default(),
            is_within: Vec::new(),
        };
        polygons.find_diagonals(surface, has_no_area);
        polygons
    }

    fn find_diagonals(&mut self, surface: &Surface<'_>, has_no_area: &[bool]) {
        self.is_within = vec![false; surface.positions.len()];
        if self.members.is_empty() {
            return;
        }
        for [polygon, triangle] in &self.members {
            for side in 0..3 {
                if self.is_diagonal(surface, 3 * triangle.number() + number32(side)) {
                    let edge = surface.edge(*triangle, side);
                    let fresh = Diagonal { polygon: *polygon, is_shared: false };
                    if self.diagonals.entry(edge).or_insert(fresh).polygon != *polygon {
                        self.further.insert((*polygon, edge));
                    }
                }
            }
            surface.corners(*triangle).iter().for_each(|corner| self.is_within[corner.index()] = true);
        }
        let is_corner = self.is_within.clone();
        for triangle in TriangleId::all(surface.len()).filter(|triangle| !has_no_area[triangle.index()]) {
            let vertices = surface.triangle(triangle).corners;
            for (side, corner) in surface.corners(triangle).into_iter().enumerate() {
                if !surface.is_core(vertices[side].vertex) {
                    self.is_within[corner.index()] = false;
                }
                if self.is_diagonal(surface, 3 * triangle.number() + number32(side)) {
                    continue;
                }
                let edge = surface.edge(triangle, side);
                edge.iter().for_each(|end| self.is_within[end.index()] = false);
                if edge.iter().all(|end| is_corner[end.index()])
                    && let Some(diagonal) = self.diagonals.get_mut(&edge)
                {
                    diagonal.is_shared = true;
                }
            }
        }
    }

    /// The first triangle of the polygon of a triangle.
    #[inline]
    pub(super) fn of(&self, triangle: TriangleId) -> TriangleId {
        self.first[triangle.index()]
    }

    /// The first triangles of polygons.
    pub(super) fn all(&self) -> impl Iterator<Item = TriangleId> + '_ {
        self.members.chunk_by(|a, b| a[0] == b[0]).map(|group| group[0][0])
    }

    /// The triangles of all polygons.
    pub(super) fn triangles(&self) -> impl Iterator<Item = TriangleId> + '_ {
        self.members.iter().map(|[_, triangle]| *triangle)
    }

    /// The triangles of a polygon, each after the first one; none where that is no polygon.
    pub(super) fn members(&self, first: TriangleId) -> &[[TriangleId; 2]] {
        let start = self.members.partition_point(|member| member[0] < first);
        let end = start + self.members[start..].partition_point(|member| member[0] == first);
        &self.members[start..end]
    }

    /// Whether a half-edge lies within a polygon.
    #[inline]
    pub(super) fn is_diagonal(&self, surface: &Surface<'_>, half_edge: u32) -> bool {
        let twin = surface.twins[half_edge as usize];
        twin != NO_TWIN && self.first[half_edge as usize / 3] == self.first[twin as usize / 3]
    }

    /// Whether a triangle is of a polygon, not alone.
    #[inline]
    pub(super) fn has(&self, triangle: TriangleId) -> bool {
        self.is_member[triangle.index()]
    }

    /// Whether the edge between two vertices lies within a polygon, given by its first triangle.
    pub(super) fn has_diagonal(&self, polygon: TriangleId, edge: [PointId; 2]) -> bool {
        self.diagonals.get(&edge).is_some_and(|diagonal| self.lies_within(diagonal, polygon, edge))
    }

    /// Whether the edge between two vertices lies within one of two polygons, and is no edge of anything else.
    pub(super) fn have_mere_diagonal(&self, pair: [TriangleId; 2], edge: [PointId; 2]) -> bool {
        self.diagonals.get(&edge).is_some_and(|diagonal| {
            !diagonal.is_shared && pair.iter().any(|polygon| self.lies_within(diagonal, *polygon, edge))
        })
    }

    fn lies_within(&self, diagonal: &Diagonal, polygon: TriangleId, edge: [PointId; 2]) -> bool {
        diagonal.polygon == polygon || !self.further.is_empty() && self.further.contains(&(polygon, edge))
    }

    /// Whether the edge between two vertices lies within some polygon, and is no edge of anything else.
    pub(super) fn is_mere_diagonal(&self, edge: [PointId; 2]) -> bool {
        self.diagonals.get(&edge).is_some_and(|diagonal| !diagonal.is_shared)
    }

    /// Whether a diagonal is an edge of something else, too.
    pub(super) fn is_shared(&self, edge: [PointId; 2]) -> bool {
        self.diagonals.get(&edge).is_some_and(|diagonal| diagonal.is_shared)
    }

    /// Whether a vertex lies within a polygon for all triangles that have it: then nothing ends there.
    pub(super) fn is_within(&self, vertex: PointId) -> bool {
        self.is_within[vertex.index()]
    }

    /// The half-edges around a polygon, or around a triangle.
    pub(super) fn border(&self, surface: &Surface<'_>, first: TriangleId) -> Vec<u32> {
        let sides = |triangle: TriangleId| (0..3).map(move |side| 3 * triangle.number() + side);
        match self.members(first) {
            [] => sides(first).collect(),
            members => members
                .iter()
                .flat_map(|[_, triangle]| sides(*triangle))
                .filter(|half_edge| !self.is_diagonal(surface, *half_edge))
                .collect(),
        }
    }
}

/// The connected parts of flat faces in a surface.
struct Parts {
    /// For each triangle the first one of its part.
    first: Vec<u32>,
    size: Vec<u32>,
}

impl Parts {
    fn new(surface: &Surface<'_>, contacts: &Contacts, flat_edges: &[u32]) -> Self {
        // triangles beside those that pass through stay as they are
        let mut is_alone = vec![false; surface.len()];
        surface.seams.iter().for_each(|(half_edge, _)| is_alone[*half_edge as usize / 3] = true);
        let mut sets = DisjointSets::new(surface.len());
        for half_edge in flat_edges {
            let twin = surface.twins[*half_edge as usize];
            let (operand, own) = surface.in_operand(*half_edge);
            if !is_alone[*half_edge as usize / 3]
                && !is_alone[twin as usize / 3]
                && is_within_face(surface.input, operand, own)
            {
                sets.join(half_edge / 3, twin / 3);
            }
        }
        let mut first: Vec<u32> = (0..number32(surface.len())).map(|triangle| sets.root(triangle)).collect();
        // where a part touches itself each triangle is one
        let mut is_alone = vec![false; surface.len()];
        for pair in &contacts.pairs {
            let [one, other] = pair.map(|triangle| first[surface.triangle_of(triangle).index()]);
            is_alone[one as usize] |= one == other;
        }
        for (triangle, first) in (0..).zip(&mut first) {
            if is_alone[*first as usize] {
                *first = triangle;
            }
        }
        let mut size = vec![0; surface.len()];
        first.iter().for_each(|first| size[*first as usize] += 1);
        Self { first, size }
    }

    fn of(&self, triangle: TriangleId) -> u32 {
        self.first[triangle.index()]
    }

    /// For each triangle the first one of its part, where that is cut; it alone otherwise.
    fn cut(&self, surface: &Surface<'_>, contacts: &Contacts) -> Vec<TriangleId> {
        let mut is_cut = vec![false; surface.len()];
        for cut in contacts.cuts.iter().filter(|cut| cut.ends[0] != cut.ends[1]) {
            is_cut[self.of(surface.triangle_of(cut.triangle)) as usize] = true;
        }
        for cut in &contacts.edge_cuts {
            let side = surface.half_edge_of(cut.side);
            is_cut[self.first[side as usize / 3] as usize] = true;
            if surface.twins[side as usize] != NO_TWIN {
                is_cut[self.first[surface.twins[side as usize] as usize / 3] as usize] = true;
            }
        }
        // parts that lie upon each other are cut alike
        let parts = |pair: [TriangleId; 2]| pair.map(|triangle| self.of(triangle));
        let mut like: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        for pair in &contacts.identical {
            let [a, b] = parts(pair.map(|triangle| surface.triangle_of(triangle)));
            *like.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
        let mut sets = DisjointSets::new(surface.len());
        let mut last = [0; 2];
        for pair in &contacts.overlapping {
            let [a, b] = parts(pair.map(|triangle| surface.triangle_of(triangle)));
            let (a, b) = (a.min(b), a.max(b));
            let [of_a, of_b] = [a, b].map(|part| self.size[part as usize]);
            if [a, b] == last || of_a == 1 && of_b == 1 {
                continue;
            }
            last = [a, b];
            sets.join(a, b);
            if of_a != of_b || like.get(&[a, b]) != Some(&of_a) {
                is_cut[a as usize] = true;
            }
        }
        for part in 0..number32(surface.len()) {
            if is_cut[part as usize] {
                is_cut[sets.root(part) as usize] = true;
            }
        }
        let mut first = |triangle: u32| {
            let part = self.first[triangle as usize];
            let is_cut = is_cut[sets.root(part) as usize];
            TriangleId::from_index(if is_cut { part } else { triangle } as usize)
        };
        (0..number32(surface.len())).map(&mut first).collect()
    }
}
