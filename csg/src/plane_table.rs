//! Every plane of a model once: interned exactly up to scale, with noise snapped away.

use std::cmp::Ordering;

use planecut_kernel::sign::{Homogeneous, Row, Sign, cross_component, orient3};
use planecut_kernel::{DVec3, HalfSpace, meet};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::distinct::{WEIGHTS, distinct, sortable};

/// Planes whose unit normals and relative offsets differ by at most this are taken to be one plane that went through
/// rotations or decimal text, relative to the largest distance of a plane from the origin.
pub const SNAP_TOLERANCE: f64 = 1e-12;

/// Planes whose normal has coprime integer components of at most this many bits are exact and never snapped onto others:
/// what went through rotations or decimal text is hardly ever that short.
const EXACT_BITS: u32 = 36;

/// Side of the cells in which near planes are sought; many times the tolerance, so that one cell nearly always does.
const SNAP_CELL: f64 = 1024.0 * SNAP_TOLERANCE;

/// An oriented plane of a [`PlaneTable`]: an index and a bit for the opposite side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PlaneId(u32);

impl PlaneId {
    fn new(index: usize, flipped: bool) -> Self {
        Self((index as u32) << 1 | u32::from(flipped))
    }

    /// The unsided plane of an index.
    pub(crate) fn of_index(index: u32) -> Self {
        Self::new(index as usize, false)
    }

    /// The same side of a plane of another index.
    pub(crate) fn with_index(self, index: u32) -> Self {
        Self(index << 1 | self.0 & 1)
    }

    /// The same plane, its normal reversed.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// Index of the plane without its side.
    #[must_use]
    pub fn index(self) -> u32 {
        self.0 >> 1
    }

    /// The side of the plane on which the first coefficient of the normal that is not zero is positive.
    #[must_use]
    pub fn unsided(self) -> Self {
        Self(self.0 & !1)
    }
}

/// All planes of a model, each once, and the signs among them.
///
/// [`PlaneTable::intern`] numbers the planes of a model at once; [`PlaneTable::insert`] adds to a table. An id, once given,
/// keeps its plane.
#[derive(Debug, Clone, Default)]
pub struct PlaneTable {
    /// Two rows a plane: the side with the positive first coefficient, and the other.
    rows: Vec<Row>,
    half_spaces: Vec<HalfSpace>,
    /// The planes that were replaced by one that was nearly the same: their sides with a positive first coefficient.
    replaced: Vec<(Row, PlaneId)>,
    /// The largest distance of a plane from the origin, exactly inserted planes left out.
    reach: f64,
    /// Where to find what is there, made when a plane is first inserted.
    index: Option<Index>,
}

impl PlaneTable {
    /// Interns half-spaces; gives the table and the id of each half-space in the order given.
    ///
    /// The numbering depends on the planes alone, not on the order in which they were given.
    #[must_use]
    pub fn intern(half_spaces: &[HalfSpace]) -> (Self, Vec<PlaneId>) {
        Self::intern_within(half_spaces, 0.0)
    }

    /// The same among others, of which the largest distance from the origin is known.
    fn intern_within(half_spaces: &[HalfSpace], reach: f64) -> (Self, Vec<PlaneId>) {
        let rows: Vec<Row> = half_spaces.par_iter().with_min_len(1024).map(Row::new).collect();
        let (exact, class) = group_exactly(&rows);
        let mut table = Self { reach, ..Self::default() };
        let ids = table.snap(&exact);
        let of_input = class.into_iter().zip(&rows).map(|(class, row)| {
            let id: PlaneId = ids[class as usize];
            if is_reversed(row) { id.flipped() } else { id }
        });
        let of_input = of_input.collect();
        (table, of_input)
    }

    /// The id of a half-space, whose plane is added where it is not there yet. A plane that is nearly the same as one that
    /// is there ([`SNAP_TOLERANCE`], relative to the largest distance from the origin so far) is taken to be that one,
    /// unless its normal is made of short integers.
    ///
    /// ```
    /// use planecut_csg::PlaneTable;
    /// use planecut_kernel::{DVec3, HalfSpace};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut table = PlaneTable::default();
    /// let wall = table.insert(&HalfSpace::new(DVec3::X, 0.5)?);
    /// assert_eq!(table.insert(&HalfSpace::new(DVec3::X * -4.0, -2.0)?), wall.flipped());
    /// # Ok(())
    /// # }
    /// ```
    pub fn insert(&mut self, half_space: &HalfSpace) -> PlaneId {
        self.find_or_add(
            half_space,
            |_, _| true,
            |table, row| {
                let place = unit(row);
                table.reach = table.reach.max(place[3].abs());
                let near = if is_exact(row) { None } else { table.find_near(&place) };
                if let Some(near) = near {
                    table.replaced.push((*row, near));
                    return near;
                }
                table.add(row)
            },
        )
    }

    /// The id of a half-space, whose plane is added where it is not there yet; it is never taken for one that is merely
    /// near, nor does its distance from the origin count for later ones. For planes that a computation needs beside those
    /// that the user gave.
    pub fn insert_exact(&mut self, half_space: &HalfSpace) -> PlaneId {
        self.find_or_add(half_space, |table, (row, id)| table.row(*id).is_same_plane(row), Self::add)
    }

    /// Gives all planes new indices, each once.
    pub(crate) fn renumber(&mut self, new_of_old: &[u32]) {
        let mut old_of_new = vec![0; new_of_old.len()];
        for (old, new) in new_of_old.iter().enumerate() {
            old_of_new[*new as usize] = old;
        }
        let sides = |old: &usize| [2 * old, 2 * old + 1];
        self.rows = old_of_new.iter().flat_map(sides).map(|k| self.rows[k]).collect();
        self.half_spaces = old_of_new.iter().flat_map(sides).map(|k| self.half_spaces[k]).collect();
        for (_, id) in &mut self.replaced {
            *id = id.with_index(new_of_old[id.index() as usize]);
        }
        self.index = None;
    }

    /// How many planes there are, both sides counting once.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len() / 2
    }

    /// Whether there are no planes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// How many different planes were replaced by one that was nearly the same.
    #[must_use]
    pub fn snapped(&self) -> usize {
        self.replaced.len()
    }

    /// The largest distance of a plane from the origin, those aside that were added exactly.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The exact coefficients of a plane.
    #[must_use]
    pub fn row(&self, plane: PlaneId) -> &Row {
        &self.rows[plane.0 as usize]
    }

    /// Numbers that order the sides of planes, whatever their scale and whichever other planes are in the table.
    pub(crate) fn order(&self, plane: PlaneId) -> (bool, usize, [u64; 3]) {
        let row = self.row(plane);
        let (first, ratios) = row.ratios();
        (is_reversed(row), first, ratios.map(sortable))
    }

    /// The half-space of a plane.
    #[must_use]
    pub fn half_space(&self, plane: PlaneId) -> &HalfSpace {
        &self.half_spaces[plane.0 as usize]
    }

    /// The meeting point of three planes, for asking sides.
    pub(crate) fn homogeneous(&self, planes: [PlaneId; 3]) -> Homogeneous {
        let [a, b, c] = planes.map(|p| self.row(p));
        Homogeneous::meet(a, b, c)
    }

    /// On which side of `plane` the meeting point of a right-handed triple lies: positive is outside.
    pub(crate) fn side(&self, planes: [PlaneId; 3], point: &Homogeneous, plane: PlaneId) -> Sign {
        if planes.iter().any(|p| p.index() == plane.index()) {
            return Sign::Zero;
        }
        point.side_of(planes.map(|p| self.row(p)), self.row(plane))
    }

    /// The sign of the determinant of three normals.
    pub(crate) fn orient3(&self, a: PlaneId, b: PlaneId, c: PlaneId) -> Sign {
        orient3(self.row(a), self.row(b), self.row(c))
    }

    /// The sign of a component of the cross product of two normals.
    pub(crate) fn cross_component(&self, a: PlaneId, b: PlaneId, axis: usize) -> Sign {
        cross_component(self.row(a), self.row(b), axis)
    }

    /// The correctly rounded meeting point of three planes.
    pub(crate) fn position(&self, planes: [PlaneId; 3]) -> Option<DVec3> {
        let [a, b, c] = planes.map(|p| self.row(p));
        meet(a, b, c)
    }

    /// Stores different planes, given by their sides with a positive first coefficient, snapping those that are nearly
    /// equal; gives their ids.
    ///
    /// Exact planes come first, then the others by their coefficients, so that the outcome does not depend on the order of
    /// the input.
    fn snap(&mut self, planes: &[Row]) -> Vec<PlaneId> {
        let units: Vec<[f64; 4]> = planes.par_iter().with_min_len(1024).map(unit).collect();
        self.reach = units.iter().map(|unit| unit[3].abs()).fold(self.reach, f64::max);
        let place = |(k, row): (usize, &Row)| (!is_exact(row), row.coefficients().map(sortable), k as u32);
        let mut order: Vec<(bool, [u64; 4], u32)> =
            planes.par_iter().enumerate().with_min_len(1024).map(place).collect();
        order.par_sort_unstable();
        let any_noise = order.last().is_some_and(|last| last.0);
        let mut near = NearPlanes::new(self.reach);
        let may_be_near = if any_noise { near.may_be_near(&units) } else { vec![false; planes.len()] };
        self.rows.reserve_exact(2 * planes.len());
        self.half_spaces.reserve_exact(2 * planes.len());
        let mut ids = vec![PlaneId(0); planes.len()];
        for (is_noisy, _, plane) in order {
            let plane = plane as usize;
            let row = &planes[plane];
            let found = if is_noisy && may_be_near[plane] { near.find(&units[plane], self.reach) } else { None };
            ids[plane] = found.unwrap_or_else(|| {
                let id = self.push(row);
                if may_be_near[plane] {
                    near.insert(units[plane], id);
                }
                id
            });
            if let Some(id) = found {
                self.replaced.push((*row, id));
            }
        }
        ids
    }

    /// The id of a half-space where exactly its plane is known and `serves`, else what `add` gives for the side with a
    /// positive first coefficient.
    fn find_or_add(
        &mut self,
        half_space: &HalfSpace,
        serves: impl Fn(&Self, &(Row, PlaneId)) -> bool,
        add: impl FnOnce(&mut Self, &Row) -> PlaneId,
    ) -> PlaneId {
        let row = Row::new(half_space);
        let reversed = is_reversed(&row);
        let row = if reversed { row.flipped() } else { row };
        if self.index.is_none() {
            self.index = Some(Index::of(&self.rows, &self.replaced));
        }
        let bucket = self.index.as_ref().and_then(|index| index.exact.get(&key(&row)));
        let known = bucket.and_then(|bucket| bucket.iter().find(|k| k.0.is_same_plane(&row) && serves(self, k)));
        let id = known.map(|(_, id)| *id);
        let id = id.unwrap_or_else(|| {
            let id = add(self, &row);
            self.index.get_or_insert_default().exact.entry(key(&row)).or_default().push((row, id));
            id
        });
        if reversed { id.flipped() } else { id }
    }

    fn find_near(&mut self, place: &[f64; 4]) -> Option<PlaneId> {
        let (reach, rows) = (self.reach, &self.rows);
        let index = self.index.get_or_insert_default();
        let near = index.near.take().filter(|near| reach <= near.size);
        // twice the reach, so that tables that grow are hashed again only now and then
        let near = near.unwrap_or_else(|| NearPlanes::of(rows, 2.0 * reach));
        index.near.insert(near).find(place, reach)
    }

    /// Adds a plane that is not there; `row` is the side with a positive first coefficient.
    fn add(&mut self, row: &Row) -> PlaneId {
        let id = self.push(row);
        if let Some(near) = self.index.as_mut().and_then(|index| index.near.as_mut()) {
            near.insert(unit(row), id);
        }
        id
    }

    fn push(&mut self, row: &Row) -> PlaneId {
        let id = PlaneId::new(self.len(), false);
        let [x, y, z, d] = *row.coefficients();
        let half_space = HalfSpace::new(DVec3::new(x, y, z), d).expect("scaled from a valid half-space");
        self.half_spaces.extend([half_space, half_space.flipped()]);
        self.rows.extend([*row, row.flipped()]);
        id
    }
}

/// The planes of many half-spaces that a table of all of them would replace by one that is nearly the same, without such a
/// table.
pub(crate) struct Snapped {
    replaced: FxHashMap<[u64; 4], HalfSpace>,
}

impl Snapped {
    /// Those among some half-spaces.
    pub(crate) fn of<'a>(half_spaces: impl Iterator<Item = &'a HalfSpace> + Clone) -> Self {
        let mut snapped = Self { replaced: FxHashMap::default() };
        let rows = || half_spaces.clone().map(Row::new);
        if rows().all(|row| is_exact(&row)) {
            return snapped;
        }
        let first_sides = rows().map(|row| if is_reversed(&row) { row.flipped() } else { row });
        let units: Vec<[f64; 4]> = first_sides.map(|row| unit(&row)).collect();
        let reach = units.iter().map(|unit| unit[3].abs()).fold(0.0, f64::max);
        let may_be_near = NearPlanes::new(reach).may_be_near(&units);
        drop(units);
        let doubtful = half_spaces.zip(may_be_near).filter(|(_, is_near)| *is_near);
        let doubtful: Vec<HalfSpace> = doubtful.map(|(half_space, _)| *half_space).collect();
        let (table, ids) = PlaneTable::intern_within(&doubtful, reach);
        for (half_space, id) in doubtful.iter().zip(ids) {
            if !table.row(id).is_same_plane(&Row::new(half_space)) {
                snapped.replaced.insert(bits(half_space), *table.half_space(id));
            }
        }
        snapped
    }

    /// What stands for a half-space.
    pub(crate) fn of_plane(&self, half_space: &HalfSpace) -> HalfSpace {
        if self.replaced.is_empty() {
            return *half_space;
        }
        self.replaced.get(&bits(half_space)).copied().unwrap_or(*half_space)
    }
}

fn bits(half_space: &HalfSpace) -> [u64; 4] {
    half_space.normal().extend(half_space.offset()).to_array().map(f64::to_bits)
}

/// Finds planes of a table.
#[derive(Debug, Clone, Default)]
struct Index {
    /// By their ratios the rows with a positive first coefficient.
    exact: FxHashMap<Key, Vec<(Row, PlaneId)>>,
    /// Made when a plane is first inserted that is not exact.
    near: Option<NearPlanes>,
}

impl Index {
    fn of(rows: &[Row], replaced: &[(Row, PlaneId)]) -> Self {
        let mut index = Self::default();
        let first_sides = rows.iter().step_by(2).enumerate().map(|(k, row)| (*row, PlaneId::new(k, false)));
        for (row, id) in first_sides.chain(replaced.iter().copied()) {
            index.exact.entry(key(&row)).or_default().push((row, id));
        }
        index
    }
}

/// Numbers that equal planes share.
type Key = (usize, [u64; 3]);

fn key(row: &Row) -> Key {
    let (first, ratios) = row.ratios();
    (first, ratios.map(f64::to_bits))
}

/// Whether a plane is surely meant as it is.
fn is_exact(row: &Row) -> bool {
    row.integer_bits().is_some_and(|bits| bits <= EXACT_BITS)
}

/// Whether the first coefficient of the normal that is not zero is negative.
fn is_reversed(row: &Row) -> bool {
    row.coefficients().iter().find(|v| **v != 0.0).is_some_and(|v| *v < 0.0)
}

/// The order of rows by their coefficients.
fn compare_coefficients(p: &Row, q: &Row) -> Ordering {
    let pairs = p.coefficients().iter().zip(q.coefficients());
    pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Groups rows that describe the same plane: for each group its side with a positive first coefficient, and the group of
/// each row. Of rows of different scale the least stands for the group, so that the order of the input does not matter.
fn group_exactly(rows: &[Row]) -> (Vec<Row>, Vec<u32>) {
    let rows: Vec<Row> =
        rows.par_iter().with_min_len(1024).map(|row| if is_reversed(row) { row.flipped() } else { *row }).collect();
    let keys: Vec<Key> = rows.par_iter().with_min_len(1024).map(key).collect();
    // spread by the low bits of a ratio
    let spread = |key: &Key| (key.1[0] ^ key.1[1] >> 7 ^ key.1[2] >> 13) as usize & 0xFFFF;
    let (different, mut class) = distinct(&keys, 1 << 16, spread);
    let mut groups: Vec<Option<Row>> = vec![None; different.len()];
    // groups that share all numbers with one that was there before
    let mut further: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for (row, class) in rows.iter().zip(&mut class) {
        let same = |group: &u32| groups[*group as usize].is_none_or(|other| other.is_same_plane(row));
        if !same(class) {
            let others = further.entry(*class).or_default();
            *class = others.iter().copied().find(same).unwrap_or_else(|| {
                others.push(groups.len() as u32);
                groups.push(None);
                groups.len() as u32 - 1
            });
        }
        let least = groups[*class as usize].get_or_insert(*row);
        if compare_coefficients(row, least).is_lt() {
            *least = *row;
        }
    }
    (groups.into_iter().flatten().collect(), class)
}

/// Unit normal and distance from the origin.
fn unit(row: &Row) -> [f64; 4] {
    let [x, y, z, d] = *row.coefficients();
    let length = DVec3::new(x, y, z).length();
    [x / length, y / length, z / length, d / length]
}

/// A hash of planes by their unit normal and relative offset.
#[derive(Debug, Clone)]
struct NearPlanes {
    /// The last plane of each cell.
    cells: FxHashMap<[i64; 4], u32>,
    /// Each with the one before in its cell.
    planes: Vec<([f64; 4], PlaneId, Option<u32>)>,
    /// Distances from the origin are hashed as shares of this.
    size: f64,
}

impl NearPlanes {
    fn new(size: f64) -> Self {
        Self { cells: FxHashMap::default(), planes: Vec::new(), size: size.max(f64::MIN_POSITIVE) }
    }

    fn of(rows: &[Row], size: f64) -> Self {
        let mut near = Self::new(size);
        for (k, row) in rows.iter().step_by(2).enumerate() {
            near.insert(unit(row), PlaneId::new(k, false));
        }
        near
    }

    /// Which of some planes may be within the tolerance of another: most are told apart by one number each.
    fn may_be_near(&self, units: &[[f64; 4]]) -> Vec<bool> {
        // the sum of the weights times the tolerance, and room for rounding
        const APART: f64 = 3.0 * SNAP_TOLERANCE;
        let number = |unit: &[f64; 4]| self.shares(*unit).iter().zip(WEIGHTS).map(|(share, w)| share * w).sum::<f64>();
        let mut sorted: Vec<(u64, u32)> = units
            .par_iter()
            .enumerate()
            .with_min_len(1024)
            .map(|(k, unit)| (sortable(number(unit)), k as u32))
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

    fn insert(&mut self, unit: [f64; 4], id: PlaneId) {
        let before = self.cells.insert(self.shares(unit).map(cell), self.planes.len() as u32);
        self.planes.push((unit, id, before));
    }

    /// The side of a plane that is within the tolerance; `reach` is the largest distance from the origin.
    fn find(&self, unit: &[f64; 4], reach: f64) -> Option<PlaneId> {
        let opposite = || {
            // both have a first coefficient that is not negative
            let may_be_near = unit[0] <= SNAP_TOLERANCE;
            may_be_near.then(|| self.find_side(&unit.map(|v| -v), reach)).flatten().map(PlaneId::flipped)
        };
        self.find_side(unit, reach).or_else(opposite)
    }

    fn find_side(&self, unit: &[f64; 4], reach: f64) -> Option<PlaneId> {
        let tolerances = [SNAP_TOLERANCE, SNAP_TOLERANCE, SNAP_TOLERANCE, SNAP_TOLERANCE * reach];
        let near = |other: &[f64; 4]| (0..4).all(|k| (unit[k] - other[k]).abs() <= tolerances[k]);
        let low = self.shares(std::array::from_fn(|k| unit[k] - tolerances[k])).map(cell);
        let high = self.shares(std::array::from_fn(|k| unit[k] + tolerances[k])).map(cell);
        let different = (0..4).filter(|k| low[*k] != high[*k]).fold(0, |bits, k| bits | 1 << k);
        (0..16usize)
            .filter(|corner| corner & !different == 0)
            .map(|corner| std::array::from_fn(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] }))
            .filter_map(|key: [i64; 4]| self.cells.get(&key))
            .flat_map(|last| std::iter::successors(Some(*last), |k| self.planes[*k as usize].2))
            .map(|k| &self.planes[k as usize])
            .filter(|(other, ..)| near(other))
            .map(|(_, id, _)| *id)
            .min()
    }

    fn shares(&self, [x, y, z, d]: [f64; 4]) -> [f64; 4] {
        [x, y, z, d / self.size]
    }
}

fn cell(v: f64) -> i64 {
    (v / SNAP_CELL).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(x: f64, y: f64, z: f64, d: f64) -> HalfSpace {
        HalfSpace::new(DVec3::new(x, y, z), d).expect("a valid plane")
    }

    #[test]
    fn equal_planes_share_an_id_whatever_scale_and_side() {
        let third = 1.0 / 3.0;
        let given = [
            plane(1.0, 2.0, -3.0, 4.0),
            plane(3.0, 6.0, -9.0, 12.0),
            plane(-5.0, -10.0, 15.0, -20.0),
            plane(third, 2.0 * third, 0.0, 4.0 * third),
            plane(1.0, 2.0, 0.0, 4.0),
        ];
        let (table, ids) = PlaneTable::intern(&given);
        assert_eq!(ids[0], ids[1]);
        assert_eq!(ids[0].flipped(), ids[2]);
        assert_eq!(ids[3], ids[4]);
        assert_eq!((table.len(), table.snapped()), (2, 0));
    }

    #[test]
    fn noise_is_snapped_and_counted_and_integers_are_not() {
        let (s, c) = 0.3_f64.sin_cos();
        let noise = 1.0 + 4.0 * f64::EPSILON;
        let given = [
            plane(s, c, 0.0, 7.0),
            plane(-s * noise, -c, 0.0, -7.0),
            plane(1e9, 1.0, 0.0, 0.0),
            plane(1e9, 2.0, 0.0, 0.0),
        ];
        let (table, ids) = PlaneTable::intern(&given);
        assert_eq!(ids[0], ids[1].flipped());
        assert_ne!(ids[2], ids[3]);
        assert_eq!(table.snapped(), 1);
    }

    #[test]
    fn planes_that_are_inserted_join_those_that_are_there() {
        let (s, c) = 0.3_f64.sin_cos();
        let (mut table, ids) = PlaneTable::intern(&[plane(s, c, 0.0, 7.0), plane(1.0, 2.0, 3.0, 4.0)]);
        let noise = 1.0 + 4.0 * f64::EPSILON;
        assert_eq!(table.insert(&plane(-2.0, -4.0, -6.0, -8.0)), ids[1].flipped());
        assert_eq!(table.insert(&plane(-s * noise, -c, 0.0, -7.0)), ids[0].flipped());
        assert_eq!((table.len(), table.snapped()), (2, 1));
        // the same noise once more is known, and does not count again
        assert_eq!(table.insert(&plane(s * noise, c, 0.0, 7.0)), ids[0]);
        assert_eq!(table.snapped(), 1);
        let third = table.insert(&plane(s, c, 0.0, 9.0));
        assert_eq!((third.index(), table.len()), (2, 3));
        // of planes that were added later, too, noise is taken away
        assert_eq!(table.insert(&plane(s * noise, c, 0.0, 9.0)), third);
        assert_eq!(table.insert(&plane(1e9, 2.0, 0.0, 0.0)), table.insert(&plane(1e9, 2.0, 0.0, 0.0)));
        assert_ne!(table.insert(&plane(1e9, 1.0, 0.0, 0.0)), table.insert(&plane(1e9, 2.0, 0.0, 0.0)));
    }

    #[test]
    fn exactly_inserted_planes_are_not_snapped_and_do_not_widen_the_tolerance() {
        let (s, c) = 0.3_f64.sin_cos();
        let noise = 1.0 + 4.0 * f64::EPSILON;
        let mut table = PlaneTable::default();
        let wall = table.insert(&plane(s, c, 0.0, 7.0));
        let beside = table.insert_exact(&plane(s * noise, c, 0.0, 7.0));
        assert_ne!(wall, beside);
        let noisier = plane(s * noise * noise, c, 0.0, 7.0);
        assert_eq!(table.insert(&noisier), wall);
        assert!(![wall, beside].contains(&table.insert_exact(&noisier)));
        table.insert_exact(&plane(1.0, 0.0, 0.0, 1e12));
        assert_ne!(table.insert(&plane(s, c, 0.0, 7.0 + 1e-6)), wall);
        assert_eq!(table.snapped(), 1);
    }

    #[test]
    fn a_table_that_grows_is_hashed_again() {
        let (s, c) = 0.3_f64.sin_cos();
        let mut table = PlaneTable::default();
        let ids: Vec<PlaneId> = (0..60).map(|k| table.insert(&plane(s, c, 0.0, 1.5_f64.powi(k)))).collect();
        let noisy = |k: i32| plane(s, c, 0.0, 1.5_f64.powi(k) * (1.0 + 2.0 * f64::EPSILON));
        assert_eq!(table.len(), 60);
        assert!((0..60).all(|k| table.insert(&noisy(k)) == ids[k as usize]));
        assert_eq!(table.len(), 60);
    }

    #[test]
    fn ids_do_not_depend_on_the_order() {
        let given: Vec<HalfSpace> =
            (0..50).map(|k| plane(f64::from(k % 7 - 3) + 0.1, f64::from(k % 5 - 2), 1.0, f64::from(k % 11))).collect();
        let (_, ids) = PlaneTable::intern(&given);
        let reversed: Vec<HalfSpace> = given.iter().rev().copied().collect();
        let (_, back) = PlaneTable::intern(&reversed);
        assert!(ids.iter().eq(back.iter().rev()));
    }
}
