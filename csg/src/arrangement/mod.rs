//! The arrangement of triangle meshes: where all triangles meet, and the winding numbers of each mesh on both sides of every facet.
//!
//! Every decision is the sign of a polynomial in the numbers that were given: coordinates of vertices, coefficients of planes. Steps:
//!
//! 1. [`operand`] makes closed meshes and convex bodies ready, [`input`] numbers what they have; [`triangle_tree`] puts boxes around triangles,
//!    and [`stars`] knows neighbours that need not be compared.
//! 2. [`pairs`] walks down the boxes, [`self_walk`] does within one operand, and [`contact`] and [`coplanar`] find what two triangles have in common.
//! 3. [`surface`] takes the triangles that touch others; [`patches`] are what is left: they pass through as they are, or go.
//! 4. [`polygons`] are what is cut of [`flat_faces`], and [`joined_cuts`] joins what triangles have in common to cuts of polygons, by [`chains`].
//! 5. [`points`] gives each point one number, whichever edges and planes meet there.
//! 6. [`crossings`] finds where cuts of one polygon cross, and [`subdivide`] makes cells of it.
//! 7. [`facets`] joins cells that lie upon each other, [`around`] sorts facets around edges, and [`winding`] goes from one to the next.
//! 8. [`kept`] keeps the facets that have the solid on one side alone, [`merge`] makes faces of them, [`fill`] triangles of those ([`slits`] are left out),
//!    [`pairing`] tells which of these are neighbours, and [`assemble`] puts them beside what passes through; [`combine`] asks for it.

mod around;
mod assemble;
mod chains;
mod combine;
mod contact;
mod coplanar;
mod crossings;
mod edge_points;
mod exact;
mod facets;
mod fill;
mod flat;
mod flat_faces;
mod hidden;
mod input;
mod joined_cuts;
mod kept;
mod measures;
mod merge;
mod operand;
mod pairing;
mod pairs;
mod patches;
mod points;
mod polygons;
mod predicates;
mod self_walk;
mod slits;
mod stars;
mod straighten;
mod subdivide;
mod surface;
mod triangle_tree;
mod winding;

use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use crate::base::{DisjointSets, map_chunks};
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, InputTriangleId, PointId, TriangleId, number32};
pub use combine::{CombineError, CombinedMeshes, Inside, combine_meshes, unite_meshes};
pub(crate) use combine::{DecidingLeaves, Leaf, combine_leaves};
use contact::{Contacts, InputKey};
use crossings::{CutLine, Neighbours, crossings};
use edge_points::EdgePoints;
use facets::Facets;
use flat_faces::FlatFaces;
use hidden::Hidden;
use input::Input;
use joined_cuts::{JoinedCuts, KeyedCut, joined_cuts};
use patches::Patches;
use points::{PointKey, Points};
use polygons::Polygons;
use predicates::best_axis;
use subdivide::{Cells, View, subdivide};
use surface::{Surface, sorted};
use winding::{NoWindings, Sheets, sheets};

/// Cuts that one thread looks at in a row.
const CHUNK: usize = 1 << 10;

/// What is cut as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cutting {
    /// Flat faces.
    Polygons,
    /// Triangles.
    Triangles,
}

/// The triangles of all operands with the points and cells that they cut out of one another.
#[derive(Debug)]
struct Arrangement<'a> {
    surface: Surface<'a>,
    patches: Patches,
    polygons: Polygons,
    points: Points,
    /// For each triangle the first one that is known to lie in the same plane.
    planes: Vec<TriangleId>,
    edge_points: EdgePoints,
    cells: Cells,
}

/// An arrangement with the winding numbers on both sides of its facets.
#[derive(Debug)]
struct Arranged<'a> {
    arrangement: Arrangement<'a>,
    facets: Facets,
    sheets: Sheets,
}

impl<'a> Arranged<'a> {
    /// Arranges the triangles of operands, given what they have in common.
    fn new(
        input: &'a Input<'a>,
        (contacts, faces): (Contacts, FlatFaces<'_>),
        cutting: Cutting,
        hidden: &'a Hidden,
    ) -> Result<Self, NoWindings> {
        let surface = Surface::new(input, &contacts, &faces, hidden);
        let (arrangement, is_split, is_doubled) = Arrangement::new(surface, &contacts, cutting);
        drop((contacts, faces));
        let facets = Facets::new(&arrangement, is_split, &is_doubled);
        let sheets = sheets(&arrangement, &facets)?;
        Ok(Self { arrangement, facets, sheets })
    }
}

impl<'a> Arrangement<'a> {
    /// Cuts triangles along what they have in common. Also tells which of them are not whole any more, and which may have doubles.
    fn new(surface: Surface<'a>, contacts: &Contacts, cutting: Cutting) -> (Self, Vec<bool>, Vec<bool>) {
        let patches = Patches::new(&surface);
        let mut is_split = vec![false; surface.len()];
        for (operand, own) in surface.input.operands.iter().enumerate() {
            for triangle in own.flat() {
                is_split[surface.triangle_of(surface.input.number(operand, *triangle)).index()] = true;
            }
        }
        let flat_edges = surface.flat_edges();
        let planes = planes(&surface, contacts, &flat_edges);
        let within_polygons = if cutting == Cutting::Polygons { &flat_edges[..] } else { &[] };
        let polygons = Polygons::new(&surface, contacts, within_polygons, &is_split);
        let key = |key: InputKey| canonical(&surface, &planes, key);
        let JoinedCuts { cuts: keyed, on_edges, pairs } = joined_cuts(&surface, &polygons, &planes, contacts, key);
        let mut points = Points::new(&surface);
        for point in &on_edges {
            let triangle = TriangleId::from_index(point.side as usize / 3);
            let other = match surface.twins[point.side as usize] {
                NO_TWIN => triangle,
                twin => TriangleId::from_index(twin as usize / 3),
            };
            let at = [triangle, other].map(|triangle| planes[triangle.index()]);
            points.know_edge(surface.edge(triangle, point.side as usize % 3), at);
        }
        let ends = keyed.iter().flat_map(|cut| &cut.ends);
        let keys = ends.chain(on_edges.iter().map(|point| &point.key)).copied();
        points.add(&surface, keys.filter(|key| !matches!(key, PointKey::Vertex(_))));
        let (edge_points, cut_sides) = EdgePoints::new(&surface, &points, &on_edges);
        let cuts = cut_lines(&points, &keyed);
        let neighbours =
            Neighbours::new(surface.len(), &pairs_of(&surface, &polygons, contacts.pairs.iter().chain(&pairs)));
        let found = crossings(&surface, &points, &planes, &cuts, &neighbours);
        points.add(&surface, found.iter().map(|(_, key)| *key).filter(|key| !matches!(key, PointKey::Vertex(_))));
        let mut is_doubled = vec![false; surface.len()];
        for triangle in contacts.overlapping.as_flattened() {
            let triangle = surface.triangle_of(*triangle);
            is_doubled[triangle.index()] = true;
            is_doubled[polygons.of(triangle).index()] = true;
        }
        let mut split: Vec<TriangleId> =
            cuts.iter().filter(|cut| !cut.is_point()).map(|cut| cut.triangle).chain(cut_sides).collect();
        split.iter_mut().for_each(|triangle| *triangle = polygons.of(*triangle));
        split.extend(polygons.all());
        split.sort_unstable();
        split.dedup();
        split.retain(|triangle| !is_split[triangle.index()]);
        split.iter().for_each(|triangle| is_split[triangle.index()] = true);
        polygons.triangles().for_each(|triangle| is_split[triangle.index()] = true);
        let mut arrangement = Self { surface, patches, polygons, points, planes, edge_points, cells: Cells::default() };
        arrangement.cells = arrangement.subdivided(&split, &cuts, &found);
        (arrangement, is_split, is_doubled)
    }

    /// The cells of triangles that are cut.
    fn subdivided(&self, split: &[TriangleId], cuts: &[CutLine], found: &[(u32, PointKey)]) -> Cells {
        let work = |triangles: &[TriangleId]| {
            let mut cells = Cells::default();
            for triangle in triangles {
                self.subdivide(*triangle, cuts, found, &mut cells);
            }
            cells
        };
        let (parts, _): (Vec<Cells>, Counts) = map_chunks(split, 32, work);
        let mut cells = Cells::default();
        parts.iter().for_each(|part| cells.append(part));
        cells
    }

    fn subdivide(&self, triangle: TriangleId, cuts: &[CutLine], found: &[(u32, PointKey)], cells: &mut Cells) {
        let Self { surface, points, .. } = self;
        let Some((axis, facing)) = best_axis(surface.input, &surface.triangle(triangle)) else { return };
        let mut pieces = Vec::new();
        let first = cuts.partition_point(|cut| cut.triangle < triangle);
        let mut between = Vec::new();
        for (place, cut) in (first..).zip(cuts[first..].iter().take_while(|cut| cut.triangle == triangle)) {
            if cut.is_point() {
                continue;
            }
            let place = number32(place);
            let start = found.partition_point(|(cut, _)| *cut < place);
            between.clear();
            between.extend(found[start..].iter().take_while(|(of, _)| *of == place).map(|(_, key)| points.of_key(key)));
            let [from, to] = cut.ends;
            // what touches an edge from elsewhere cuts it, too
            let on_edge = cut.edge.into_iter().flat_map(|[a, b]| self.edge_points.from(a, b));
            between.extend(on_edge.filter(|point| points.is_between(surface, from, to, *point)));
            between.retain(|point| *point != from && *point != to);
            points.sort_along(surface, from, to, &mut between);
            let mut last = from;
            for point in between.iter().copied().chain([to]) {
                pieces.push(sorted(last, point));
                last = point;
            }
        }
        let border: Vec<[PointId; 2]> = self
            .polygons
            .border(surface, triangle)
            .into_iter()
            .flat_map(|half_edge| {
                let corners = surface.corners(TriangleId::from_index(half_edge as usize / 3));
                let [from, to] = [half_edge as usize % 3, (half_edge as usize + 1) % 3].map(|k| corners[k]);
                let along: Vec<PointId> = self.edge_points.from(from, to).chain([to]).collect();
                along.windows(2).map(|ends| [ends[0], ends[1]]).collect::<Vec<_>>()
            })
            .collect();
        let is_triangle = self.polygons.members(triangle).is_empty();
        subdivide(View { surface, points, axis, facing }, triangle, &border, is_triangle, &mut pieces, cells);
    }
}

/// For each triangle the first one that is known to lie in the same plane.
fn planes(surface: &Surface<'_>, contacts: &Contacts, flat_edges: &[u32]) -> Vec<TriangleId> {
    let mut sets = DisjointSets::new(surface.len());
    for pair in &contacts.coplanar {
        let [a, b] = pair.map(|triangle| surface.triangle_of(triangle).number());
        sets.join(a, b);
    }
    // large flat faces are made of many triangles
    for half_edge in flat_edges {
        sets.join(half_edge / 3, surface.twins[*half_edge as usize] / 3);
    }
    // triangles of convex bodies know their planes
    if surface.input.has_bodies {
        let mut first_on: FxHashMap<u32, u32> = FxHashMap::default();
        for triangle in TriangleId::all(surface.len()) {
            if let Some(plane) = surface.input.plane(surface.number(triangle)) {
                let first = *first_on.entry(plane.index()).or_insert(triangle.number());
                sets.join(first, triangle.number());
            }
        }
    }
    (0..number32(surface.len())).map(|triangle| TriangleId::from_index(sets.root(triangle) as usize)).collect()
}

/// A key in numbers of the surface, with planes named by the first triangle in them.
fn canonical(surface: &Surface<'_>, planes: &[TriangleId], key: InputKey) -> PointKey {
    key.renumbered(|vertex| surface.vertex_of(vertex), |triangle| planes[surface.triangle_of(triangle).index()])
}

/// The cuts of polygons and triangles, sorted, each once.
fn cut_lines(points: &Points, keyed: &[KeyedCut]) -> Vec<CutLine> {
    let cut_line = |cut: &KeyedCut| {
        let [from, to] = cut.ends.map(|key| points.of_key(&key));
        CutLine { triangle: cut.triangle, other: cut.other, ends: sorted(from, to), edge: cut.edge }
    };
    let mut cuts: Vec<CutLine> = keyed.par_iter().with_min_len(CHUNK).map(cut_line).collect();
    cuts.par_sort_unstable();
    cuts.dedup();
    cuts
}

/// Pairs of polygons or triangles that touch, each once.
fn pairs_of<'a>(
    surface: &Surface<'_>,
    polygons: &Polygons,
    pairs: impl Iterator<Item = &'a [InputTriangleId; 2]>,
) -> Vec<[TriangleId; 2]> {
    let of = |pair: &[InputTriangleId; 2]| {
        let [a, b] = pair.map(|triangle| polygons.of(surface.triangle_of(triangle)));
        sorted(a, b)
    };
    let mut pairs: Vec<[TriangleId; 2]> = pairs.map(of).filter(|pair| pair[0] != pair[1]).collect();
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}
