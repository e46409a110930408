//! The arrangement of triangle meshes: where all triangles meet, and the winding numbers of each mesh on both sides of every facet.
//!
//! Every decision is the sign of a polynomial in the numbers that were given: coordinates of vertices, coefficients of planes. Steps:
//!
//! 1. [`operand`] makes closed meshes and convex bodies ready, [`input`] numbers what they have; [`triangle_tree`] puts boxes around triangles,
//!    and [`stars`] knows neighbours that need not be compared.
//! 2. [`pairs`] walks down the boxes, [`self_walk`] does within one operand, and [`contact`] and [`coplanar`] find what two triangles have in common.
//! 3. [`surface`] takes the triangles that touch others; [`patches`] are what is left: they pass through as they are, or go.
//! 4. [`points`] gives each point one number, whichever edges and planes meet there.
//! 5. [`crossings`] finds where cuts of one triangle cross, and [`subdivide`] makes cells of it.
//! 6. [`facets`] joins cells that lie upon each other, [`around`] sorts facets around edges, and [`winding`] goes from one to the next.
//! 7. [`kept`] keeps the facets that have the solid on one side alone, [`merge`] makes faces of them, [`fill`] triangles of those ([`slits`] are left out),
//!    [`pairing`] tells which of these are neighbours, and [`assemble`] puts them beside what passes through; [`combine`] asks for it.

mod around;
mod assemble;
mod combine;
mod contact;
mod coplanar;
mod crossings;
mod edge_points;
mod exact;
mod facets;
mod fill;
mod flat;
mod input;
mod kept;
mod measures;
mod merge;
mod operand;
mod pairing;
mod pairs;
mod patches;
mod points;
mod predicates;
mod self_walk;
mod slits;
mod stars;
mod subdivide;
mod surface;
mod triangle_tree;
mod winding;

use planecut_kernel::sign::Counts;
use rustc_hash::FxHashMap;

use crate::base::{DisjointSets, map_chunks};
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, InputTriangleId, PointId, TriangleId, number32};
pub use combine::{CombineError, CombinedMeshes, Inside, combine_meshes};
pub(crate) use combine::{Leaf, combine_leaves};
use contact::{Contacts, InputKey};
use crossings::{CutLine, Neighbours, crossings};
use edge_points::{EdgePoints, PointOnEdge};
use facets::Facets;
use flat::are_coplanar;
use input::Input;
use patches::Patches;
use points::{PointKey, Points};
use predicates::best_axis;
use subdivide::{Cells, View, subdivide};
use surface::{Surface, sorted};
use winding::{Contradiction, Sheets, sheets};

/// The triangles of all operands with the points and cells that they cut out of one another.
#[derive(Debug)]
struct Arrangement<'a> {
    surface: Surface<'a>,
    patches: Patches,
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
    /// Arranges the triangles of operands.
    fn new(input: &'a Input<'a>) -> Result<Self, Contradiction> {
        let contacts = pairs::contacts(input);
        let surface = Surface::new(input, &contacts);
        let (arrangement, is_split, is_doubled) = Arrangement::new(surface, &contacts);
        drop(contacts);
        let facets = Facets::new(&arrangement, is_split, &is_doubled);
        let sheets = sheets(&arrangement, &facets)?;
        Ok(Self { arrangement, facets, sheets })
    }
}

impl<'a> Arrangement<'a> {
    /// Cuts triangles along what they have in common. Also tells which of them are not whole any more, and which may have doubles.
    fn new(surface: Surface<'a>, contacts: &Contacts) -> (Self, Vec<bool>, Vec<bool>) {
        let patches = Patches::new(&surface);
        let mut is_split = vec![false; surface.len()];
        for (operand, own) in surface.input.operands.iter().enumerate() {
            for triangle in own.flat() {
                is_split[surface.triangle_of(surface.input.number(operand, *triangle)).index()] = true;
            }
        }
        let planes = planes(&surface, contacts, &is_split);
        let key = |key: InputKey| canonical(&surface, &planes, key);
        let on_edges: Vec<PointOnEdge> = contacts
            .edge_cuts
            .iter()
            .map(|cut| PointOnEdge { side: surface.half_edge_of(cut.side), key: key(cut.key) })
            .collect();
        let ends: Vec<[PointKey; 2]> = contacts.cuts.iter().map(|cut| cut.ends.map(key)).collect();
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
        let keys = ends.as_flattened().iter().chain(on_edges.iter().map(|point| &point.key)).copied();
        points.add(&surface, keys.filter(|key| !matches!(key, PointKey::Vertex(_))));
        let (edge_points, cut_sides) = EdgePoints::new(&surface, &points, &on_edges);
        let cuts = cut_lines(&surface, &points, contacts, &ends);
        let neighbours = Neighbours::new(surface.len(), &pairs_of(&surface, contacts));
        let found = crossings(&surface, &points, &planes, &cuts, &neighbours);
        points.add(&surface, found.iter().map(|(_, key)| *key).filter(|key| !matches!(key, PointKey::Vertex(_))));
        let mut is_doubled = vec![false; surface.len()];
        for triangle in contacts.overlapping.as_flattened() {
            is_doubled[surface.triangle_of(*triangle).index()] = true;
        }
        let mut split: Vec<TriangleId> =
            cuts.iter().filter(|cut| !cut.is_point()).map(|cut| cut.triangle).chain(cut_sides).collect();
        split.sort_unstable();
        split.dedup();
        split.retain(|triangle| !is_split[triangle.index()]);
        let mut arrangement = Self { surface, patches, points, planes, edge_points, cells: Cells::default() };
        arrangement.cells = arrangement.subdivided(&split, &cuts, &found);
        split.iter().for_each(|triangle| is_split[triangle.index()] = true);
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
        let corners = surface.corners(triangle);
        let border: Vec<PointId> =
            (0..3).flat_map(|k| self.edge_points.from(corners[k], corners[(k + 1) % 3])).collect();
        subdivide(View { surface, points, axis, facing }, triangle, &border, &mut pieces, cells);
    }
}

/// For each triangle the first one that is known to lie in the same plane.
fn planes(surface: &Surface<'_>, contacts: &Contacts, is_flat: &[bool]) -> Vec<TriangleId> {
    let mut sets = DisjointSets::new(surface.len());
    for pair in &contacts.coplanar {
        let [a, b] = pair.map(|triangle| surface.triangle_of(triangle).number());
        sets.join(a, b);
    }
    // large flat faces are made of many triangles
    for (half_edge, &twin) in
        (0..).zip(&surface.twins).filter(|(half_edge, twin)| **twin != NO_TWIN && half_edge < *twin)
    {
        let [one, other] = [half_edge, twin].map(|side: u32| TriangleId::from_index(side as usize / 3));
        if is_flat[one.index()] || is_flat[other.index()] {
            continue;
        }
        let [a, b, c] = surface.triangle(one).corners;
        let apex = surface.corner(surface.corners(other)[(twin as usize + 2) % 3]);
        let are_there = [a, b, c, apex].iter().all(|corner| surface.input.is_where_it_is_said(corner.vertex));
        if are_there && are_coplanar([a.at, b.at, c.at, apex.at]) {
            sets.join(one.number(), other.number());
        }
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

/// The cuts of triangles, sorted, each once.
fn cut_lines(surface: &Surface<'_>, points: &Points, contacts: &Contacts, ends: &[[PointKey; 2]]) -> Vec<CutLine> {
    let cut_line = |(cut, ends): (&contact::Cut, &[PointKey; 2])| {
        let [from, to] = ends.map(|key| points.of_key(&key));
        CutLine {
            triangle: surface.triangle_of(cut.triangle),
            other: surface.triangle_of(cut.other),
            ends: sorted(from, to),
            edge: cut.edge.map(|[a, b]| sorted(surface.vertex_of(a), surface.vertex_of(b))),
        }
    };
    let mut cuts: Vec<CutLine> = contacts.cuts.iter().zip(ends).map(cut_line).collect();
    cuts.sort_unstable();
    cuts.dedup();
    cuts
}

/// Pairs of triangles that touch, each once.
fn pairs_of(surface: &Surface<'_>, contacts: &Contacts) -> Vec<[TriangleId; 2]> {
    let of = |pair: &[InputTriangleId; 2]| pair.map(|triangle| surface.triangle_of(triangle));
    let mut pairs: Vec<[TriangleId; 2]> = contacts.pairs.iter().map(of).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
