//! Boolean operators on solids.
//!
//! What is subtracted are the convex bodies that the other solid is known to be the union of, not its cells. Both ways round
//! are tried for a union, and the one kept that makes fewer cells.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not, Sub, SubAssign};
use std::sync::{Arc, OnceLock};

use planecut_csg::stages::Boxes;
use planecut_csg::{PlaneId, PlaneTable};

use super::carve::Carver;
use super::cell::Cell;
use super::convex::Convex;
use super::formula::{Formula, Kind};
use super::order::Rule;
use super::{Solid, merge};

/// The other operand, its planes numbered by the table of the first.
struct Operand {
    cells: Vec<Cell>,
    /// Bodies whose union it is, where these are fewer than the cells.
    cover: Option<Vec<Arc<Cell>>>,
}

/// The bodies whose union a solid is.
fn cover_of<'a>(cover: &'a Option<Vec<Arc<Cell>>>, cells: &'a [Cell]) -> Vec<&'a Cell> {
    match cover {
        Some(cover) => cover.iter().map(|cell| &**cell).collect(),
        None => cells.iter().collect(),
    }
}

/// The bodies of both, where that is worth its cost.
fn joint_cover(solid: &Solid, other: &Operand) -> Option<Vec<Arc<Cell>>> {
    let list = |cover: &Option<Vec<Arc<Cell>>>, cells: &[Cell]| match cover {
        Some(cover) => Some(cover.clone()),
        None if cells.len() <= SHORT => Some(cells.iter().cloned().map(Arc::new).collect()),
        None => None,
    };
    let mut cover = list(&solid.cover, &solid.cells)?;
    cover.append(&mut list(&other.cover, &other.cells)?);
    Some(cover)
}

/// Solids of more cells are not copied to remember what they were before a union.
const SHORT: usize = 64;

/// Bodies to carve with, and which of them are where.
struct Tools {
    bodies: Vec<Convex>,
    boxes: Boxes,
}

impl Tools {
    /// Of the bodies those that come near the cells.
    fn new(table: &PlaneTable, bodies: &[&Cell], cells: &[Cell]) -> Self {
        let bounds_of = |cells: &mut dyn Iterator<Item = &Cell>| Boxes::new(cells.map(|cell| *cell.bounds()).collect());
        let (mut wanted, mut near) = (vec![false; bodies.len()], Vec::new());
        // the hierarchy is made of what is less
        if bodies.len() <= cells.len() {
            let boxes = bounds_of(&mut bodies.iter().copied());
            for cell in cells {
                boxes.touching(cell.bounds(), &mut near);
                near.iter().for_each(|body| wanted[*body as usize] = true);
            }
        } else {
            let boxes = bounds_of(&mut cells.iter());
            for (body, wanted) in bodies.iter().zip(&mut wanted) {
                boxes.touching(body.bounds(), &mut near);
                *wanted = !near.is_empty();
            }
        }
        let wanted = bodies.iter().zip(wanted).filter(|(_, wanted)| *wanted);
        let bodies: Vec<Convex> = wanted.map(|(cell, _)| Convex::new(table, (*cell).clone())).collect();
        let boxes = Boxes::new(bodies.iter().map(|body| *body.bounds()).collect());
        Self { bodies, boxes }
    }

    fn carver<'a>(&'a self, table: &'a PlaneTable) -> Carver<'a> {
        Carver::new(table, self.bodies.iter().collect(), Rule::default())
    }
}

/// For each cell that a body reaches, by its place: what becomes of it.
type Changes = Vec<(usize, Vec<Cell>)>;

/// What is left of cells without some bodies; those that no body reaches are left out.
fn without(table: &PlaneTable, cells: &[Cell], tools: &Tools) -> Changes {
    let outside = |near: &[u32]| Formula::combine(Kind::And, near.iter().map(|body| Formula::body(*body, true)));
    changes(table, cells, tools, outside)
}

fn changes(table: &PlaneTable, cells: &[Cell], tools: &Tools, formula: impl Fn(&[u32]) -> Formula) -> Changes {
    let carver = tools.carver(table);
    let (mut changes, mut near) = (Vec::new(), Vec::new());
    for (place, cell) in cells.iter().enumerate() {
        tools.boxes.touching(cell.bounds(), &mut near);
        near.retain(|body| !tools.bodies[*body as usize].is_parted_from(table, cell));
        if !near.is_empty() {
            let mut pieces = Vec::new();
            carver.carve(cell.clone(), formula(&near), &mut pieces);
            changes.push((place, pieces));
        }
    }
    changes
}

fn count(changes: &Changes) -> usize {
    changes.iter().map(|(_, pieces)| pieces.len()).sum()
}

/// Puts pieces, neighbours among them merged, where the cells were that they come from.
fn apply(table: &PlaneTable, cells: &mut Vec<Cell>, changes: Changes) {
    let mut places: Vec<usize> = changes.iter().map(|(place, _)| *place).collect();
    let mut pieces: Vec<Cell> = changes.into_iter().flat_map(|(_, pieces)| pieces).collect();
    merge::merge_neighbours(table, &mut pieces);
    let spare = pieces.split_off(pieces.len().min(places.len()));
    let empty = places.split_off(pieces.len());
    for (place, piece) in places.into_iter().zip(pieces) {
        cells[place] = piece;
    }
    cells.extend(spare);
    for place in empty.into_iter().rev() {
        cells.swap_remove(place);
    }
}

impl Solid {
    /// Makes the planes of another solid those of this one's table.
    fn take_in(&mut self, other: &Self) -> Operand {
        self.index = OnceLock::new();
        let first_brush = self.sources.brushes;
        let mut ids: Vec<PlaneId> = Vec::new();
        if !Arc::ptr_eq(&self.table, &other.table) {
            let table = Arc::make_mut(&mut self.table);
            let planes = (0..other.table.len() as u32).map(PlaneId::of_index);
            ids.extend(planes.map(|plane| table.insert(other.table.half_space(plane))));
        }
        let is_same = Arc::ptr_eq(&self.table, &other.table);
        let id = |plane: PlaneId| {
            if is_same {
                return plane;
            }
            let unsided = ids[plane.index() as usize];
            if plane == plane.unsided() { unsided } else { unsided.flipped() }
        };
        self.sources.append(&other.sources, id);
        let exactly = |plane: PlaneId| is_same || self.table.row(id(plane)).is_same_plane(other.table.row(plane));
        let moved = |cell: &Cell| cell.renumbered(&self.table, id, exactly, first_brush);
        let cells = other.baked_cells().iter().filter_map(moved).collect();
        let cover = other.cover.as_ref().filter(|_| other.cuts.is_empty());
        let cover = cover.map(|cover| cover.iter().filter_map(|cell| moved(cell)).map(Arc::new).collect());
        Operand { cells, cover }
    }

    fn subtract(&mut self, other: &Operand) {
        let tools = Tools::new(&self.table, &cover_of(&other.cover, &other.cells), &self.cells);
        let changes = without(&self.table, &self.cells, &tools);
        apply(&self.table, &mut self.cells, changes);
        self.cover = None;
    }

    fn unite(&mut self, other: Operand) {
        let table = &self.table;
        let theirs = Tools::new(table, &cover_of(&other.cover, &other.cells), &self.cells);
        let mine = Tools::new(table, &cover_of(&self.cover, &self.cells), &other.cells);
        let (mine, theirs) = (without(table, &self.cells, &theirs), without(table, &other.cells, &mine));
        let cover = joint_cover(self, &other);
        let mut cells = other.cells;
        // how many cells each way adds to those that are there anyway
        let (by_old, by_new) = (count(&mine) + theirs.len(), count(&theirs) + mine.len());
        if by_new <= by_old {
            apply(table, &mut cells, theirs);
        } else {
            apply(table, &mut self.cells, mine);
        }
        self.cells.append(&mut cells);
        self.cover = cover.filter(|cover| cover.len() < self.cells.len());
    }

    fn intersect(&mut self, other: &Operand) {
        let tools = Tools::new(&self.table, &cover_of(&other.cover, &other.cells), &self.cells);
        let inside = |near: &[u32]| Formula::combine(Kind::Or, near.iter().map(|body| Formula::body(*body, false)));
        let mut pieces: Vec<Cell> =
            changes(&self.table, &self.cells, &tools, inside).into_iter().flat_map(|(_, pieces)| pieces).collect();
        merge::merge_neighbours(&self.table, &mut pieces);
        self.cells = pieces;
        self.cover = None;
    }

    fn exclude(&mut self, mut other: Operand) {
        let table = &self.table;
        let theirs = Tools::new(table, &cover_of(&other.cover, &other.cells), &self.cells);
        let mine = Tools::new(table, &cover_of(&self.cover, &self.cells), &other.cells);
        let (mine, theirs) = (without(table, &self.cells, &theirs), without(table, &other.cells, &mine));
        apply(&self.table, &mut self.cells, mine);
        apply(&self.table, &mut other.cells, theirs);
        self.cells.append(&mut other.cells);
        self.cover = None;
    }

    /// What does not lie in the solid.
    #[must_use]
    pub fn complement(&self) -> Self {
        let this = self.baked();
        let mut cells = vec![Cell::everything()];
        let tools = Tools::new(&this.table, &cover_of(&this.cover, &this.cells), &cells);
        let changes = without(&this.table, &cells, &tools);
        apply(&this.table, &mut cells, changes);
        Self::of_cells(Arc::clone(&this.table), cells, this.sources.clone())
    }
}

impl SubAssign<&Self> for Solid {
    fn sub_assign(&mut self, other: &Self) {
        self.bake();
        let other = self.take_in(other);
        self.subtract(&other);
    }
}

impl BitOrAssign<&Self> for Solid {
    fn bitor_assign(&mut self, other: &Self) {
        self.bake();
        let other = self.take_in(other);
        self.unite(other);
    }
}

impl BitAndAssign<&Self> for Solid {
    fn bitand_assign(&mut self, other: &Self) {
        self.bake();
        let other = self.take_in(other);
        self.intersect(&other);
    }
}

impl BitXorAssign<&Self> for Solid {
    fn bitxor_assign(&mut self, other: &Self) {
        self.bake();
        let other = self.take_in(other);
        self.exclude(other);
    }
}

impl Sub for &Solid {
    type Output = Solid;
    fn sub(self, other: Self) -> Solid {
        let mut result = self.clone();
        result -= other;
        result
    }
}

impl BitOr for &Solid {
    type Output = Solid;
    fn bitor(self, other: Self) -> Solid {
        let mut result = self.clone();
        result |= other;
        result
    }
}

impl BitAnd for &Solid {
    type Output = Solid;
    fn bitand(self, other: Self) -> Solid {
        let mut result = self.clone();
        result &= other;
        result
    }
}

impl BitXor for &Solid {
    type Output = Solid;
    fn bitxor(self, other: Self) -> Solid {
        let mut result = self.clone();
        result ^= other;
        result
    }
}

impl Not for &Solid {
    type Output = Solid;
    fn not(self) -> Solid {
        self.complement()
    }
}
