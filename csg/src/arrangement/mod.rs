//! The arrangement of triangle meshes: where all triangles meet, and the winding numbers of each mesh on both sides of every facet.
//!
//! Every decision is the sign of a polynomial in the coordinates that were given. Steps:
//!
//! 1. [`operand`] joins vertices and makes sure that each mesh is closed; [`triangle_tree`] puts boxes around its triangles.
//! 2. [`pairs`] walks down the boxes, and [`contact`] and [`coplanar`] find what two triangles have in common.
//! 3. [`points`] gives each point one number, whichever edges and planes meet there.
//! 4. [`crossings`] finds where cuts of one triangle cross, and [`subdivide`] makes cells of it.
//! 5. [`facets`] joins cells that lie upon each other, [`around`] sorts facets around edges, and [`winding`] goes from one to the next.
//! 6. [`boundary`] keeps the facets that have the solid on one side alone, [`merge`] makes
//!    faces of them, which become a mesh; [`combine`] asks for it.

mod around;
mod boundary;
mod combine;
mod contact;
mod coplanar;
mod crossings;
mod edge_points;
mod exact;
mod facets;
mod measures;
mod merge;
mod operand;
mod pairs;
mod points;
mod predicates;

mod subdivide;
mod surface;
mod triangle_tree;
mod winding;

use planecut_kernel::sign::Counts;

use crate::base::{DisjointSets, map_chunks};
use crate::ids::{Id, PointId, TriangleId, number32};
pub use combine::{CombineError, CombinedMeshes, Inside, combine_meshes};
use contact::Contacts;
use crossings::{CutLine, Neighbours, crossings};
use edge_points::EdgePoints;
use facets::Facets;
use points::{PointKey, Points};
use predicates::best_axis;
use subdivide::{Cells, View, subdivide};
use surface::{Surface, sorted};
use triangle_tree::TriangleTree;
use winding::{Contradiction, Sheets, sheets};

/// The triangles of all operands with the points and cells that they cut out of one another.
#[derive(Debug)]
struct Arrangement {
    surface: Surface,
    points: Points,
    /// For each triangle the first one that is known to lie in the same plane.
    planes: Vec<TriangleId>,
    edge_points: EdgePoints,
    cells: Cells,
    /// Triangles that are cut, or whose edges other surfaces share, or that have no area.
    is_touched: Vec<bool>,
}

/// An arrangement with the winding numbers on both sides of its facets.
#[derive(Debug)]
struct Arranged {
    arrangement: Arrangement,
    facets: Facets,
    sheets: Sheets,
}

impl Arranged {
    /// Arranges the triangles of operands; `trees` has those of each that have an area.
    fn new(
        surface: Surface,
        trees: &[&TriangleTree],
        is_clean: &[bool],
        is_flat: Vec<bool>,
    ) -> Result<Self, Contradiction> {
        let contacts = pairs::contacts(&surface, trees, is_clean);
        let (arrangement, is_split, is_doubled) = Arrangement::new(surface, contacts, is_flat);
        let facets = Facets::new(&arrangement, is_split, &is_doubled);
        let sheets = sheets(&arrangement, &facets, trees)?;
        Ok(Self { arrangement, facets, sheets })
    }
}

impl Arrangement {
    /// Cuts triangles along what they have in common. Also tells which of them are not whole any more, and which may have doubles.
    fn new(surface: Surface, mut contacts: Contacts, is_flat: Vec<bool>) -> (Self, Vec<bool>, Vec<bool>) {
        let planes = planes(surface.len(), &contacts);
        let mut points = points_of(&surface, &contacts, &planes);
        let (edge_points, cut_sides) = EdgePoints::new(&surface, &points, &planes, &contacts.edge_cuts);
        let mut cuts: Vec<CutLine> = contacts
            .cuts
            .iter()
            .map(|cut| {
                let ends = cut.ends.map(|key| points.of_key(&canonical(key, &planes)));
                CutLine { triangle: cut.triangle, other: cut.other, ends: sorted(ends[0], ends[1]), edge: cut.edge }
            })
            .collect();
        cuts.sort_unstable();
        cuts.dedup();
        contacts.pairs.sort_unstable();
        contacts.pairs.dedup();
        let neighbours = Neighbours::new(surface.len(), &contacts.pairs);
        let found = crossings(&surface, &points, &planes, &cuts, &neighbours);
        points.add(&surface, found.iter().map(|(_, key)| *key).filter(|key| !matches!(key, PointKey::Vertex(_))));
        let mut is_touched = is_flat.clone();
        let of_overlaps = contacts.overlapping.as_flattened().iter();
        for triangle in contacts.touched.iter().chain(of_overlaps).chain(&cut_sides) {
            is_touched[triangle.index()] = true;
        }
        for cut in cuts.iter().filter(|cut| !cut.is_point()) {
            is_touched[cut.triangle.index()] = true;
        }
        let mut is_doubled = vec![false; surface.len()];
        contacts.overlapping.as_flattened().iter().for_each(|triangle| is_doubled[triangle.index()] = true);
        let mut arrangement = Self { surface, points, planes, edge_points, cells: Cells::default(), is_touched };
        let mut is_split = is_flat;
        let mut split: Vec<TriangleId> =
            cuts.iter().filter(|cut| !cut.is_point()).map(|cut| cut.triangle).chain(cut_sides).collect();
        split.sort_unstable();
        split.dedup();
        split.retain(|triangle| !is_split[triangle.index()]);
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
        let Some((axis, facing)) = best_axis(surface, triangle) else { return };
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

    /// The point next to a vertex on an edge.
    fn next_on_edge(&self, vertex: PointId, end: PointId) -> PointId {
        self.edge_points.from(vertex, end).nth(1).unwrap_or(end)
    }
}

/// For each triangle the first one that is known to lie in the same plane.
fn planes(triangles: usize, contacts: &Contacts) -> Vec<TriangleId> {
    let mut sets = DisjointSets::new(triangles);
    contacts.coplanar.iter().for_each(|[a, b]| sets.join(a.number(), b.number()));
    (0..number32(triangles)).map(|triangle| TriangleId::from_index(sets.root(triangle) as usize)).collect()
}

/// A key that names planes by the first triangle in them.
fn canonical(key: PointKey, planes: &[TriangleId]) -> PointKey {
    match key {
        PointKey::EdgePlane { edge, triangle } => PointKey::EdgePlane { edge, triangle: planes[triangle.index()] },
        key => key,
    }
}

/// The points at which triangles touch.
fn points_of(surface: &Surface, contacts: &Contacts, planes: &[TriangleId]) -> Points {
    let near = contacts.pairs.as_flattened().iter().flat_map(|triangle| surface.corners(*triangle));
    let mut points = Points::new(surface, near);
    let keys = contacts.cuts.iter().flat_map(|cut| cut.ends).chain(contacts.edge_cuts.iter().map(|cut| cut.key));
    let constructed = keys.map(|key| canonical(key, planes)).filter(|key| !matches!(key, PointKey::Vertex(_)));
    points.add(surface, constructed);
    points
}
