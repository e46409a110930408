//! Dividing the cells of a solid along planes, and joining them again.
//!
//! A cell and what it was divided into are a *family*. Where a plane crosses a family, each of its members takes the plane, on
//! the side on which it lies, even if that cuts nothing off it: so members differ in nothing but the sides on which they lie,
//! and when the plane is removed, those that no other plane tells apart have become one and the same cell.

use std::sync::OnceLock;

use planecut_kernel::{HalfSpace, PlaneIdx};
use rustc_hash::{FxHashMap, FxHashSet};

use super::Solid;
use super::cell::CellPlane;
use super::convex::{BodySide, box_side};
use super::cuts::{CutCell, CutId, PlaneCut};

impl Solid {
    /// Divides the cells that a plane crosses; the solid stays the same. [`Solid::remove_plane`] joins again what the plane
    /// alone had divided, in whatever order cuts are removed.
    ///
    /// A Boolean operation makes the division part of its result, as any cut.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId};
    /// use planecut_kernel::{DVec3, HalfSpace};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut solid = Solid::from(Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0)));
    /// let across = solid.divide(&HalfSpace::new(DVec3::X, 0.5)?);
    /// let along = solid.divide(&HalfSpace::new(DVec3::Y, 1.0)?);
    /// assert_eq!((solid.cells().count(), solid.volume()), (4, Some(8.0)));
    /// solid.remove_plane(across);
    /// assert_eq!(solid.cells().count(), 2);
    /// solid.remove_plane(along);
    /// assert_eq!(solid.cells().count(), 1);
    /// # Ok(())
    /// # }
    /// ```
    pub fn divide(&mut self, half_space: &HalfSpace) -> CutId {
        let (id, plane) = self.next_cut(half_space);
        if self.families.is_empty() {
            self.families = (0..self.cells.len() as u32).collect();
        }
        let trims = self.trims();
        let crossed: FxHashSet<u32> = (0..)
            .zip(self.cells.iter().zip(&self.families))
            .filter(|(place, (cell, _))| {
                box_side(&self.table, cell.bounds(), plane.plane) == BodySide::Both
                    && self.sides_of(*place, plane, &trims) == [true; 2]
            })
            .map(|(_, (_, family))| *family)
            .collect();
        let (mut handles, mut copies) = (Vec::new(), FxHashMap::default());
        for place in 0..self.cells.len() {
            if !crossed.contains(&self.families[place]) {
                continue;
            }
            let sides = self.sides_of(place as u32, plane, &trims);
            let mut outside = self.cells[place].clone();
            for (is_outside, plane) in [(false, plane), (true, plane.flipped())] {
                if !sides[usize::from(is_outside)] {
                    continue;
                }
                // the first stays in the place of both
                let is_copy = is_outside && sides[0];
                let cell = if is_copy { &mut outside } else { &mut self.cells[place] };
                let (handle, _) = cell.add_again(&self.table, plane);
                let number = if is_copy { self.cells.len() } else { place };
                handles.push(CutCell { cell: number as u32, handle, is_outside });
            }
            if sides == [true; 2] {
                copies.insert(place as u32, self.cells.len() as u32);
                self.cells.push(outside);
                self.families.push(self.families[place]);
            }
        }
        for cut in &mut self.cuts {
            for k in 0..cut.handles.len() {
                if let Some(copy) = copies.get(&cut.handles[k].cell) {
                    cut.handles.push(CutCell { cell: *copy, ..cut.handles[k] });
                }
            }
        }
        self.cuts.push(PlaneCut { id, plane: plane.plane, divides: true, handles });
        self.index = OnceLock::new();
        id
    }

    /// The planes of each cell that cut away what lies outside of them.
    fn trims(&self) -> FxHashMap<u32, Vec<PlaneIdx>> {
        let mut trims: FxHashMap<u32, Vec<PlaneIdx>> = FxHashMap::default();
        for member in self.cuts.iter().filter(|cut| !cut.divides).flat_map(|cut| &cut.handles) {
            trims.entry(member.cell).or_default().push(member.handle);
        }
        trims
    }

    /// Whether there is something of a cell inside of a plane, and outside, were nothing cut away: that may come back.
    fn sides_of(&self, place: u32, plane: CellPlane, trims: &FxHashMap<u32, Vec<PlaneIdx>>) -> [bool; 2] {
        let mut whole = self.cells[place as usize].clone();
        trims.get(&place).into_iter().flatten().for_each(|handle| whole.remove(*handle));
        [plane, plane.flipped()].map(|plane| {
            let (handle, _) = whole.add_again(&self.table, plane);
            let is_left = !whole.is_empty();
            whole.remove(handle);
            is_left
        })
    }

    /// Joins the cells that nothing tells apart any more, after a plane was taken out of all that had it.
    pub(super) fn rejoin(&mut self, former: &[CutCell]) {
        let families: FxHashSet<u32> = former.iter().map(|cut| self.families[cut.cell as usize]).collect();
        // for each cell of these on which side of which cuts it lies
        let mut sides: FxHashMap<u32, Vec<(CutId, bool)>> = FxHashMap::default();
        for cut in self.cuts.iter().filter(|cut| cut.divides) {
            let members = cut.handles.iter().filter(|member| families.contains(&self.families[member.cell as usize]));
            members.for_each(|member| sides.entry(member.cell).or_default().push((cut.id, member.is_outside)));
        }
        let mut seen: FxHashSet<(u32, Vec<(CutId, bool)>)> = FxHashSet::default();
        let mut is_kept = |place: u32, family: u32| {
            !families.contains(&family) || seen.insert((family, sides.remove(&place).unwrap_or_default()))
        };
        let kept: Vec<bool> = (0..).zip(&self.families).map(|(place, family)| is_kept(place, *family)).collect();
        let mut count = 0;
        let new_place: Vec<u32> = kept
            .iter()
            .map(|is_kept| {
                count += u32::from(*is_kept);
                count.wrapping_sub(1)
            })
            .collect();
        let mut of_cell = kept.iter();
        self.cells.retain(|_| of_cell.next().is_some_and(|is_kept| *is_kept));
        let mut of_family = kept.iter();
        self.families.retain(|_| of_family.next().is_some_and(|is_kept| *is_kept));
        for cut in &mut self.cuts {
            cut.handles.retain(|member| kept[member.cell as usize]);
            cut.handles.iter_mut().for_each(|member| member.cell = new_place[member.cell as usize]);
        }
        self.index = OnceLock::new();
    }
}
