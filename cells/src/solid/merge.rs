//! Neighbouring cells that share a whole facet and are convex together become one, unless they have coplanar faces of
//! different materials.
//!
//! Let `A` be the set within the planes `P` and `h`, `B` that within the planes `Q` and the opposite of `h`. Where `B` lies
//! within all of `P` and `A` within all of `Q`, their union is the set within `P` and `Q`. Coordinates propose pairs, by the
//! corners of the shared facet; signs decide. The merged cell is `A` without `h`: the kernel takes a plane back in place.

use planecut_csg::{PlaneId, PlaneTable};
use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::cell::{Cell, CellPlane, Corner};

/// A facet: the plane without its side, and the corners in order of their coordinates.
type FacetKey = (u32, Vec<[u64; 3]>);

/// Merges until no pair is left.
pub(super) fn merge_neighbours(table: &PlaneTable, cells: &mut Vec<Cell>) {
    let keys: Vec<Vec<(FacetKey, PlaneId)>> = cells.par_iter().map(|cell| facet_keys(table, cell)).collect();
    let mut merger =
        Merger { table, cells: std::mem::take(cells).into_iter().map(Some).collect(), open: FxHashMap::default() };
    for (number, keys) in (0..).zip(keys) {
        merger.settle(number, keys);
    }
    cells.extend(merger.cells.into_iter().flatten());
}

struct Merger<'a> {
    table: &'a PlaneTable,
    cells: Vec<Option<Cell>>,
    /// The facets of the cells that were looked at.
    open: FxHashMap<FacetKey, Vec<(u32, PlaneId)>>,
}

impl Merger<'_> {
    /// Merges a cell with neighbours that were looked at before, as long as there are any, and notes its facets.
    fn settle(&mut self, mut number: u32, mut keys: Vec<(FacetKey, PlaneId)>) {
        loop {
            let found = keys.iter().find_map(|(key, plane)| Some((*plane, self.partner(number, key, *plane)?)));
            let Some((plane, other)) = found else {
                for (key, plane) in keys {
                    self.open.entry(key).or_default().push((number, plane));
                }
                return;
            };
            number = self.merge(number, plane, other);
            keys = self.cells[number as usize].as_ref().map_or(Vec::new(), |cell| facet_keys(self.table, cell));
        }
    }

    /// A cell beyond a facet with which this is convex.
    fn partner(&self, number: u32, key: &FacetKey, plane: PlaneId) -> Option<u32> {
        let beyond = self.open.get(key)?;
        let fits = |(other, other_plane): &&(u32, PlaneId)| {
            *other_plane == plane.flipped() && self.are_convex(number, *other, plane)
        };
        beyond.iter().find(fits).map(|(other, _)| *other)
    }

    fn are_convex(&self, number: u32, other: u32, plane: PlaneId) -> bool {
        let (Some(a), Some(b)) = (&self.cells[number as usize], &self.cells[other as usize]) else { return false };
        have_same_materials(a, b)
            && holds(self.table, a, &b.corners(self.table), plane)
            && holds(self.table, b, &a.corners(self.table), plane)
    }

    /// Puts the younger cell into the older one, whose number it gives.
    fn merge(&mut self, number: u32, plane: PlaneId, other: u32) -> u32 {
        let (Some(a), Some(mut b)) = (self.cells[number as usize].take(), self.cells[other as usize].take()) else {
            return number;
        };
        for (key, plane) in facet_keys(self.table, &b) {
            if let Some(known) = self.open.get_mut(&key) {
                known.retain(|entry| *entry != (other, plane));
            }
        }
        join(self.table, &mut b, &a, plane.flipped());
        self.cells[other as usize] = Some(b);
        other
    }
}

/// Makes `cell` its union with `other`, which lies beyond `wall`.
fn join(table: &PlaneTable, cell: &mut Cell, other: &Cell, wall: PlaneId) {
    // a plane that carries no face and is not one of both need not hold for the other
    let carries: Vec<PlaneId> = cell.facets().iter().map(|facet| facet.plane).collect();
    let is_idle = |p: &CellPlane| p.plane == wall || !carries.contains(&p.plane) && other.handle(p.plane).is_none();
    let idle: Vec<_> = cell.planes().filter(|(_, p)| is_idle(p)).map(|(handle, _)| handle).collect();
    for handle in idle {
        cell.remove(handle);
    }
    let facets: Vec<CellPlane> = other.facets();
    for facet in facets.into_iter().filter(|facet| facet.plane != wall.flipped()) {
        cell.add(table, facet);
    }
    cell.settle(table);
}

/// Whether no plane carries a facet of one material on the one cell and of another on the other.
fn have_same_materials(a: &Cell, b: &Cell) -> bool {
    let others = b.facets();
    let fits = |facet: &CellPlane| {
        others.iter().find(|other| other.plane == facet.plane).is_none_or(|other| other.material == facet.material)
    };
    a.facets().iter().all(fits)
}

/// Whether corners lie within all facets of a cell but one.
fn holds(table: &PlaneTable, cell: &Cell, corners: &[Corner], wall: PlaneId) -> bool {
    let inside = |plane: PlaneId| corners.iter().all(|(ids, point)| table.side(*ids, point, plane) != Sign::Positive);
    cell.facets().iter().all(|facet| facet.plane.index() == wall.index() || inside(facet.plane))
}

/// The facets of a bounded cell. What is unbounded is left as it is.
fn facet_keys(table: &PlaneTable, cell: &Cell) -> Vec<(FacetKey, PlaneId)> {
    if !cell.polytope().is_bounded() {
        return Vec::new();
    }
    let facets = cell.polytope().facets();
    let of_facet = |(handle, edges): &(planecut_kernel::PlaneIdx, Vec<Option<planecut_kernel::PlaneIdx>>)| {
        let plane = cell.plane(*handle)?.plane;
        let edges: Option<Vec<PlaneId>> = edges.iter().map(|edge| Some(cell.plane((*edge)?)?.plane)).collect();
        let edges = edges?;
        let corner = |k: usize| table.position([plane, edges[k], edges[(k + 1) % edges.len()]]);
        let corners: Option<Vec<DVec3>> = (0..edges.len()).map(corner).collect();
        let mut corners: Vec<[u64; 3]> = corners?.into_iter().map(|p| p.to_array().map(f64::to_bits)).collect();
        corners.sort_unstable();
        Some(((plane.index(), corners), plane))
    };
    facets.iter().filter_map(of_facet).collect()
}
