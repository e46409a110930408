//! Planes that are nearly the same.

use crate::ids::number32;
use planecut_kernel::DVec3;
use planecut_kernel::sign::Row;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::PlaneId;
use crate::base::{WEIGHTS, sortable};
use crate::ids::RowGroupId;
use crate::tolerances::SNAP_TOLERANCE;

/// Side of the cells in which near planes are sought; many times the tolerance, so that one cell nearly always does.
const SNAP_CELL: f64 = 1024.0 * SNAP_TOLERANCE;

/// Unit normal and distance from the origin.
pub(crate) fn unit(row: &Row) -> [f64; 4] {
    let [x, y, z, d] = *row.coefficients();
    let length = DVec3::new(x, y, z).length();
    [x / length, y / length, z / length, d / length]
}

/// A hash of planes by their unit normal and relative offset.
#[derive(Debug, Clone)]
pub(crate) struct NearPlanes {
    /// The last plane of each cell.
    cells: FxHashMap<[i64; 4], u32>,
    /// Each with the one before in its cell.
    planes: Vec<([f64; 4], PlaneId, Option<u32>)>,
    /// Distances from the origin are hashed as shares of this.
    size: f64,
}

impl NearPlanes {
    pub(super) fn new(size: f64) -> Self {
        Self { cells: FxHashMap::default(), planes: Vec::new(), size: size.max(f64::MIN_POSITIVE) }
    }

    pub(super) fn of(rows: &[Row], size: f64) -> Self {
        let mut near = Self::new(size);
        for (k, row) in rows.iter().step_by(2).enumerate() {
            near.insert(unit(row), PlaneId::new(k, false));
        }
        near
    }

    /// Whether planes at this distance can be found.
    pub(super) fn holds(&self, reach: f64) -> bool {
        reach <= self.size
    }

    /// Which of some planes may be within the tolerance of another: most are told apart by one number each.
    pub(super) fn may_be_near(&self, units: &[[f64; 4]]) -> Vec<bool> {
        // the sum of the weights times the tolerance, and room for rounding
        const APART: f64 = 3.0 * SNAP_TOLERANCE;
        let number = |unit: &[f64; 4]| self.shares(*unit).iter().zip(WEIGHTS).map(|(share, w)| share * w).sum::<f64>();
        let mut sorted: Vec<(u64, u32)> = units
            .par_iter()
            .enumerate()
            .with_min_len(1024)
            .map(|(k, unit)| (sortable(number(unit)), number32(k)))
            .collect();
        sorted.par_sort_unstable();
        // the side of a plane whose first coefficient is noise is noise, too
        let mut may_be_near: Vec<bool> = units.iter().map(|unit| unit[0] <= SNAP_TOLERANCE).collect();
        for pair in sorted.windows(2) {
            let [p, q] = [0, 1].map(|k| pair[k].1 as usize);
            if number(&units[q]) - number(&units[p]) <= APART {
                (may_be_near[p], may_be_near[q]) = (true, true);
            }
        }
        may_be_near
    }

    pub(super) fn insert(&mut self, unit: [f64; 4], id: PlaneId) {
        let before = self.cells.insert(self.shares(unit).map(cell), number32(self.planes.len()));
        self.planes.push((unit, id, before));
    }

    /// The side of a plane that is within the tolerance; `reach` is the largest distance from the origin.
    pub(super) fn find(&self, unit: &[f64; 4], reach: f64) -> Option<PlaneId> {
        let opposite = || {
            // both have a first coefficient that is not negative
            let may_be_near = unit[0] <= SNAP_TOLERANCE;
            may_be_near.then(|| self.find_side(&unit.map(|v| -v), reach)).flatten().map(PlaneId::flipped)
        };
        self.find_side(unit, reach).or_else(opposite)
    }

    fn find_side(&self, unit: &[f64; 4], reach: f64) -> Option<PlaneId> {
        let around = cells_around(unit, &tolerances(reach), self.size);
        around
            .filter_map(|key| self.cells.get(&key))
            .flat_map(|last| std::iter::successors(Some(*last), |k| self.planes[*k as usize].2))
            .map(|k| &self.planes[k as usize])
            .filter(|(other, ..)| is_within(unit, other, &tolerances(reach)))
            .map(|(_, id, _)| *id)
            .min()
    }

    fn shares(&self, unit: [f64; 4]) -> [f64; 4] {
        shares(unit, self.size)
    }
}

/// Groups of planes by where they are, to be put in and taken out.
#[derive(Debug, Default)]
pub(crate) struct NearCells {
    cells: FxHashMap<[i64; 4], Vec<([f64; 4], RowGroupId)>>,
    /// At least the largest distance from the origin, which they are near each other as a share of.
    size: f64,
}

impl NearCells {
    pub(crate) fn new(size: f64) -> Self {
        Self { cells: FxHashMap::default(), size }
    }

    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    pub(crate) fn insert(&mut self, unit: &[f64; 4], number: RowGroupId) {
        self.cells.entry(shares(*unit, self.size).map(cell)).or_default().push((*unit, number));
    }

    pub(crate) fn remove(&mut self, unit: &[f64; 4], number: RowGroupId) {
        let key = shares(*unit, self.size).map(cell);
        let Some(members) = self.cells.get_mut(&key) else { return };
        members.retain(|member| member.1 != number);
        if members.is_empty() {
            self.cells.remove(&key);
        }
    }

    /// Adds the numbers of those that are near a plane, on either side: itself, if it is there.
    pub(crate) fn find(&self, unit: &[f64; 4], found: &mut Vec<RowGroupId>) {
        let tolerances = tolerances(self.size);
        let mut find = |unit: &[f64; 4]| {
            let members = cells_around(unit, &tolerances, self.size).filter_map(|key| self.cells.get(&key)).flatten();
            let near = members.filter(|(other, _)| is_within(unit, other, &tolerances));
            found.extend(near.map(|(_, number)| *number));
        };
        find(unit);
        if unit[0] <= SNAP_TOLERANCE {
            find(&unit.map(|v| -v));
        }
    }
}

/// Whether two planes are within the tolerance of each other, or one of the other side of the other; `reach` is the largest
/// distance from the origin.
pub(crate) fn is_nearly_same(unit: &[f64; 4], other: &[f64; 4], flipped: bool, reach: f64) -> bool {
    if !flipped {
        return is_within(unit, other, &tolerances(reach));
    }
    // both have a first coefficient that is not negative
    unit[0] <= SNAP_TOLERANCE && is_within(&unit.map(|v| -v), other, &tolerances(reach))
}

fn tolerances(reach: f64) -> [f64; 4] {
    [SNAP_TOLERANCE, SNAP_TOLERANCE, SNAP_TOLERANCE, SNAP_TOLERANCE * reach]
}

fn is_within(unit: &[f64; 4], other: &[f64; 4], tolerances: &[f64; 4]) -> bool {
    (0..4).all(|k| (unit[k] - other[k]).abs() <= tolerances[k])
}

/// The cells that hold what is within the tolerances, each once.
fn cells_around(unit: &[f64; 4], tolerances: &[f64; 4], size: f64) -> impl Iterator<Item = [i64; 4]> + use<> {
    let low = shares(std::array::from_fn(|k| unit[k] - tolerances[k]), size).map(cell);
    let high = shares(std::array::from_fn(|k| unit[k] + tolerances[k]), size).map(cell);
    let different = (0..4).filter(|k| low[*k] != high[*k]).fold(0, |bits, k| bits | 1 << k);
    (0..16_usize)
        .filter(move |corner| corner & !different == 0)
        .map(move |corner| std::array::from_fn(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] }))
}

fn shares([x, y, z, d]: [f64; 4], size: f64) -> [f64; 4] {
    [x, y, z, d / size]
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates: what lies beyond shares the last cell, and is compared there"
)]
fn cell(v: f64) -> i64 {
    (v / SNAP_CELL).floor() as i64
}
