//! Planes that are nearly the same.
//!
//! Two planes are taken for one where their unit normals differ by at most [`SNAP_TOLERANCE`] and their distances from the origin by that
//! share of the larger one. Where planes pass near the origin, what is rounded is the coordinates of the bodies: then it is that share
//! of the size of the smallest body. So neither a body far away nor a tool without end takes two planes of another body for one.

use crate::ids::number32;
use planecut_kernel::sign::Row;
use planecut_kernel::{DVec3, HalfSpace};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::PlaneId;
use crate::base::hash_of;
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

/// The size of a body: how far from the origin the farthest of its planes is. None where it has too few planes to be bounded, or all
/// of them pass through the origin.
pub fn size_of<'a>(half_spaces: impl Iterator<Item = &'a HalfSpace>) -> Option<f64> {
    let (mut count, mut size) = (0, 0.0_f64);
    for half_space in half_spaces {
        // no component leaves the range of numbers
        let scale = half_space.normal().abs().max_element();
        size = size.max((half_space.offset() / scale).abs() / (half_space.normal() / scale).length());
        count += 1;
    }
    (count > 3 && size > 0.0).then_some(size)
}

/// The size of the smallest of some bodies, for [`PlaneTable::intern`](super::PlaneTable::intern); 0 where there is none.
pub fn smallest_size<'a, B: Iterator<Item = &'a HalfSpace>>(bodies: impl Iterator<Item = B>) -> f64 {
    bodies.filter_map(size_of).reduce(f64::min).unwrap_or(0.0)
}

/// A hash of planes by their unit normal and offset.
#[derive(Debug, Clone)]
pub(crate) struct NearPlanes {
    /// The last plane of each cell.
    cells: FxHashMap<[i64; 4], u32>,
    /// Each with the one before in its cell.
    planes: Vec<([f64; 4], PlaneId, Option<u32>)>,
    /// The size of the smallest body.
    size: f64,
}

impl NearPlanes {
    pub(super) fn new(size: f64) -> Self {
        Self { cells: FxHashMap::default(), planes: Vec::new(), size }
    }

    pub(super) fn of(rows: &[Row], size: f64) -> Self {
        let mut near = Self::new(size);
        for (k, row) in rows.iter().step_by(2).enumerate() {
            near.insert(unit(row), PlaneId::new(k, false));
        }
        near
    }

    pub(super) fn insert(&mut self, unit: [f64; 4], id: PlaneId) {
        let before = self.cells.insert(cell(&unit, self.size), number32(self.planes.len()));
        self.planes.push((unit, id, before));
    }

    /// The side of a plane that is within the tolerance.
    pub(super) fn find(&self, unit: &[f64; 4]) -> Option<PlaneId> {
        let opposite = || {
            // both have a first coefficient that is not negative
            let may_be_near = unit[0] <= SNAP_TOLERANCE;
            may_be_near.then(|| self.find_side(&unit.map(|v| -v))).flatten().map(PlaneId::flipped)
        };
        self.find_side(unit).or_else(opposite)
    }

    fn find_side(&self, unit: &[f64; 4]) -> Option<PlaneId> {
        cells_around(unit, self.size)
            .filter_map(|key| self.cells.get(&key))
            .flat_map(|last| std::iter::successors(Some(*last), |k| self.planes[*k as usize].2))
            .map(|k| &self.planes[k as usize])
            .filter(|(other, ..)| is_within(unit, other, self.size))
            .map(|(_, id, _)| *id)
            .min()
    }
}

/// Groups of planes by where they are, to be put in and taken out. Where each is, is known elsewhere: there are very many.
#[derive(Debug, Clone, Default)]
pub(crate) struct NearCells {
    /// By the hash of their cell.
    cells: FxHashMap<u64, SmallVec<[RowGroupId; 4]>>,
    /// At least the size of the smallest body.
    size: f64,
}

impl NearCells {
    pub(crate) fn new(size: f64) -> Self {
        Self { cells: FxHashMap::default(), size }
    }

    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Makes room for many groups.
    pub(crate) fn reserve(&mut self, count: usize) {
        self.cells.reserve(count);
    }

    pub(crate) fn insert(&mut self, unit: &[f64; 4], number: RowGroupId) {
        self.cells.entry(hash_of(&cell(unit, self.size))).or_default().push(number);
    }

    pub(crate) fn remove(&mut self, unit: &[f64; 4], number: RowGroupId) {
        let key = hash_of(&cell(unit, self.size));
        let Some(members) = self.cells.get_mut(&key) else { return };
        members.retain(|member| *member != number);
        if members.is_empty() {
            self.cells.remove(&key);
        }
    }

    /// Adds the numbers of those that are near a plane, on either side: itself, if it is there. `place` tells where each is.
    pub(crate) fn find(
        &self,
        unit: &[f64; 4],
        place: impl Fn(RowGroupId) -> Option<[f64; 4]>,
        found: &mut Vec<RowGroupId>,
    ) {
        let mut find = |unit: &[f64; 4]| {
            let members = cells_around(unit, self.size).filter_map(|cell| self.cells.get(&hash_of(&cell))).flatten();
            found.extend(
                members
                    .copied()
                    .filter(|number| place(*number).is_some_and(|other| is_within(unit, &other, self.size))),
            );
        };
        find(unit);
        if unit[0] <= SNAP_TOLERANCE {
            find(&unit.map(|v| -v));
        }
    }
}

/// Whether two planes are within the tolerance of each other, or one of the other side of the other; `size` is that of the smallest
/// body.
pub(crate) fn is_nearly_same(unit: &[f64; 4], other: &[f64; 4], flipped: bool, size: f64) -> bool {
    if !flipped {
        return is_within(unit, other, size);
    }
    // both have a first coefficient that is not negative
    unit[0] <= SNAP_TOLERANCE && is_within(&unit.map(|v| -v), other, size)
}

fn is_within(unit: &[f64; 4], other: &[f64; 4], size: f64) -> bool {
    let distance = unit[3].abs().max(other[3].abs()).max(size);
    (0..3).all(|k| (unit[k] - other[k]).abs() <= SNAP_TOLERANCE)
        && (unit[3] - other[3]).abs() <= SNAP_TOLERANCE * distance
}

/// The cells that hold what is within the tolerance, each once.
fn cells_around(unit: &[f64; 4], size: f64) -> impl Iterator<Item = [i64; 4]> + use<> {
    // the other one may be a little farther away, and so its tolerance larger
    let distance = 1.001 * SNAP_TOLERANCE * unit[3].abs().max(size);
    let tolerances = [SNAP_TOLERANCE, SNAP_TOLERANCE, SNAP_TOLERANCE, distance];
    let low = cell(&std::array::from_fn(|k| unit[k] - tolerances[k]), size);
    let high = cell(&std::array::from_fn(|k| unit[k] + tolerances[k]), size);
    let different = (0..4).filter(|k| low[*k] != high[*k]).fold(0, |bits, k| bits | 1 << k);
    (0..16_usize)
        .filter(move |corner| corner & !different == 0)
        .map(move |corner| std::array::from_fn(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] }))
}

/// The cell of a plane. Its offset is divided by the power of two that is at its distance, or at the smallest size, and that power is part
/// of the cell; both sides of 0 are cut alike, so that what is within the tolerance is in two cells at most, also where the power changes.
fn cell([x, y, z, d]: &[f64; 4], size: f64) -> [i64; 4] {
    let exponent = d.abs().max(size).max(f64::MIN_POSITIVE).to_bits() >> 52;
    let power = f64::from_bits(exponent << 52);
    let [x, y, z, share] = [*x, *y, *z, d.abs() / power].map(share_cell);
    let offset = share + (exponent.cast_signed() << 34);
    [x, y, z, if *d < 0.0 { !offset } else { offset }]
}

#[expect(clippy::cast_possible_truncation, reason = "components of unit normals, and shares below 2")]
fn share_cell(v: f64) -> i64 {
    (v / SNAP_CELL).floor() as i64
}
