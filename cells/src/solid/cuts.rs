//! Cutting a solid along planes, and taking cuts back.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use planecut_csg::{MaterialId, PlaneId};
use planecut_kernel::{HalfSpace, PlaneIdx};

use super::Solid;
use super::cell::{Cell, CellPlane, Cut};
use super::convex::{BodySide, box_side};

/// Handle of a plane with which a [`Solid`] was cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CutId(u32);

/// A plane and its handle in each cell that it may reach.
#[derive(Debug, Clone)]
pub(super) struct PlaneCut {
    pub(super) id: CutId,
    pub(super) plane: PlaneId,
    /// Whether what lies outside of it stays, as cells of their own.
    pub(super) divides: bool,
    pub(super) handles: Vec<CutCell>,
}

/// A cell that was cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct CutCell {
    /// Its place among the cells.
    pub(super) cell: u32,
    pub(super) handle: PlaneIdx,
    /// Whether it is the part outside.
    pub(super) is_outside: bool,
}

impl Solid {
    /// Cuts away what lies outside a half-space; [`Solid::remove_plane`] takes the cut back. Each cell that the plane
    /// may reach takes it in place, about a microsecond for each. The faces that the cut opens have the material 0.
    ///
    /// A Boolean operation makes cuts part of its result: they cannot be removed there. The operands keep theirs.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId};
    /// use planecut_kernel::{DVec3, HalfSpace};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut solid = Solid::from(Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0)));
    /// let cut = solid.add_plane(HalfSpace::new(DVec3::X, 0.5)?);
    /// assert_eq!(solid.volume(), Some(2.0));
    /// solid.remove_plane(cut);
    /// assert_eq!(solid.volume(), Some(8.0));
    /// # Ok(())
    /// # }
    /// ```
    pub fn add_plane(&mut self, half_space: HalfSpace) -> CutId {
        let (id, cell_plane) = self.next_cut(&half_space);
        let mut handles = Vec::new();
        // Boxes stay those of the uncut cells, so that what a cut passes by now it passes by whatever is removed.
        for (place, cell) in (0..).zip(&mut self.cells) {
            if box_side(&self.table, cell.bounds(), cell_plane.plane) != BodySide::Inside {
                let handle = cell.add_again(&self.table, cell_plane).0;
                handles.push(CutCell { cell: place, handle, is_outside: false });
            }
        }
        self.cuts.push(PlaneCut { id, plane: cell_plane.plane, divides: false, handles });
        id
    }

    /// Takes a cut back: the solid is what it would be had the plane never been added, or its cells what they would be had it
    /// not divided them. Gives the half-space, `None` where there is no such cut.
    pub fn remove_plane(&mut self, cut: CutId) -> Option<HalfSpace> {
        let place = self.cuts.iter().position(|known| known.id == cut)?;
        let cut = self.cuts.remove(place);
        for CutCell { cell, handle, .. } in &cut.handles {
            self.cells[*cell as usize].remove(*handle);
        }
        if cut.divides {
            self.rejoin(&cut.handles);
        }
        Some(*self.table.half_space(cut.plane))
    }

    /// The handle of a cut, and its plane as the cells take it.
    pub(super) fn next_cut(&mut self, half_space: &HalfSpace) -> (CutId, CellPlane) {
        let plane = Arc::make_mut(&mut self.table).insert(half_space);
        let id = CutId(self.next_cut);
        self.next_cut += 1;
        (id, CellPlane { plane, brush_face: None, material: MaterialId(0) })
    }

    /// The part inside a half-space, and the part outside.
    #[must_use]
    pub fn split(&self, half_space: &HalfSpace) -> (Self, Self) {
        let this = self.baked();
        let mut table = Arc::clone(&this.table);
        let plane = Arc::make_mut(&mut table).insert(half_space);
        let plane = CellPlane { plane, brush_face: None, material: MaterialId(0) };
        let half = |plane: CellPlane| {
            let cells = this.cells.iter().filter_map(|cell| {
                let mut cell = cell.clone();
                match cell.add(&table, plane) {
                    Cut::Empty => return None,
                    Cut::Face => {}
                    Cut::Nothing => return Some(cell),
                }
                cell.settle(&table);
                Some(cell)
            });
            Self::of_cells(Arc::clone(&table), cells.collect(), this.sources.clone())
        };
        (half(plane), half(plane.flipped()))
    }

    /// Makes cuts part of the cells for good.
    pub(super) fn bake(&mut self) {
        if self.cuts.is_empty() {
            return;
        }
        self.cuts.clear();
        self.families.clear();
        self.index = OnceLock::new();
        self.cover = None;
        self.cells.retain(|cell| !cell.is_empty());
        for cell in &mut self.cells {
            cell.settle(&self.table);
        }
    }

    /// The solid with its cuts made for good.
    pub(super) fn baked(&self) -> Cow<'_, Self> {
        if self.cuts.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut baked = self.clone();
        baked.bake();
        Cow::Owned(baked)
    }

    /// The cells that are not cut away, cuts made for good.
    pub(super) fn baked_cells(&self) -> Cow<'_, [Cell]> {
        match self.baked() {
            Cow::Borrowed(solid) => Cow::Borrowed(&solid.cells),
            Cow::Owned(solid) => Cow::Owned(solid.cells),
        }
    }
}
