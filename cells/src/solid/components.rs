//! Connected parts of a solid.

use std::sync::Arc;

use planecut_csg::stages::Boxes;
use planecut_csg::{PlaneId, PlaneTable};
use rustc_hash::FxHashMap;

use super::Solid;
use super::cell::{Cell, CellPlane, Cut};

impl Solid {
    /// The connected parts, in the order of their first cells. Cells are connected where they share part of a face; to touch
    /// along an edge or in a corner does not connect. Cuts become part of the result.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |min: f64, max: f64| {
    ///     Solid::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)))
    /// };
    /// let chain = &(&block(0.0, 1.0) | &block(1.0, 2.0)) | &block(1.5, 3.0);
    /// assert_eq!(chain.connected_components().len(), 2);
    /// ```
    #[must_use]
    pub fn connected_components(&self) -> Vec<Self> {
        let this = self.baked();
        let labels = labels(&this.table, &this.cells);
        let mut parts: Vec<Vec<Cell>> = Vec::new();
        let mut part_of: FxHashMap<u32, usize> = FxHashMap::default();
        for (cell, label) in this.cells.iter().zip(labels) {
            let part = *part_of.entry(label).or_insert(parts.len());
            if part == parts.len() {
                parts.push(Vec::new());
            }
            parts[part].push(cell.clone());
        }
        parts.into_iter().map(|cells| Self::of_cells(Arc::clone(&this.table), cells, this.sources.clone())).collect()
    }
}

/// For each cell a number that connected ones share.
fn labels(table: &PlaneTable, cells: &[Cell]) -> Vec<u32> {
    let boxes = Boxes::new(cells.iter().map(|cell| *cell.bounds()).collect());
    let facets: Vec<Vec<CellPlane>> = cells.iter().map(Cell::facets).collect();
    let mut parents: Vec<u32> = (0..cells.len() as u32).collect();
    let mut near = Vec::new();
    for (number, cell) in (0..).zip(cells) {
        boxes.touching(cell.bounds(), &mut near);
        for &other in near.iter().filter(|other| **other > number) {
            let (a, b) = (root(&mut parents, number), root(&mut parents, other));
            let others = &facets[other as usize];
            if a != b && share_a_face(table, cell, &facets[number as usize], others) {
                parents[b.max(a) as usize] = a.min(b);
            }
        }
    }
    (0..cells.len() as u32).map(|k| root(&mut parents, k)).collect()
}

fn root(parents: &mut [u32], mut k: u32) -> u32 {
    while parents[k as usize] != k {
        parents[k as usize] = parents[parents[k as usize] as usize];
        k = parents[k as usize];
    }
    k
}

/// Whether a cell has a facet that overlaps one of another cell from the other side, in more than an edge.
fn share_a_face(table: &PlaneTable, cell: &Cell, facets: &[CellPlane], others: &[CellPlane]) -> bool {
    facets
        .iter()
        .map(|facet| facet.plane)
        .any(|plane| others.iter().any(|other| other.plane == plane.flipped()) && overlap(table, cell, plane, others))
}

/// Whether the facet of a cell on a plane overlaps that of another cell beyond: cut by the planes of the other but the
/// shared one, the cell still has a face there.
fn overlap(table: &PlaneTable, cell: &Cell, plane: PlaneId, others: &[CellPlane]) -> bool {
    let mut cut = cell.clone();
    for other in others.iter().filter(|other| other.plane.index() != plane.index()) {
        if cut.add(table, *other) == Cut::Empty {
            return false;
        }
    }
    cut.facets().iter().any(|facet| facet.plane == plane)
}
