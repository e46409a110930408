//! Every plane of a model once: interned exactly up to scale, with noise snapped away.

mod interning;
mod known_planes;
mod morton;
mod near;
mod same;
mod snapped;
#[cfg(test)]
mod tests;

use crate::ids::number32;
use planecut_kernel::sign::{Homogeneous, Row, Sign, cross_component, orient3};
use planecut_kernel::{DVec3, HalfSpace, meet};
use rustc_hash::FxHashMap;

use crate::base::sortable;
pub(crate) use interning::InternedPlanes;
pub use known_planes::{KnownPlanes, compare};
pub use morton::curve_number;
pub(crate) use morton::{in_order_of_space, spread};
use near::NearPlanes;
pub(crate) use near::{NearCells, is_nearly_same, unit};
pub use near::{size_of, smallest_size};
pub(crate) use same::{Key, compare_coefficients, first_side, is_exact, is_reversed, key, settling_order};
pub(crate) use snapped::Snapped;

/// An oriented plane of a [`PlaneTable`]: an index and a bit for the opposite side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PlaneId(u32);

impl PlaneId {
    #[inline]
    fn new(index: usize, flipped: bool) -> Self {
        Self(number32(index) << 1 | u32::from(flipped))
    }

    /// The unsided plane of an index.
    #[inline]
    #[must_use]
    pub fn of_index(index: u32) -> Self {
        Self::new(index as usize, false)
    }

    /// The same side of a plane of another index.
    #[inline]
    pub(crate) fn with_index(self, index: u32) -> Self {
        Self(index << 1 | self.0 & 1)
    }

    /// The same plane, its normal reversed.
    #[inline]
    #[must_use]
    pub fn flipped(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// Index of the plane without its side.
    #[inline]
    #[must_use]
    pub fn index(self) -> u32 {
        self.0 >> 1
    }

    /// A number in the order of ids, another one for each side.
    #[inline]
    pub(crate) fn sided_index(self) -> u32 {
        self.0
    }

    /// The side of the plane on which the first coefficient of the normal that is not zero is positive.
    #[inline]
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
    /// The planes that were replaced by one that was nearly the same: their sides with a positive first coefficient.
    replaced: Vec<(Row, PlaneId)>,
    /// The largest distance of a plane from the origin, exactly inserted planes left out.
    reach: f64,
    /// The size of the smallest body, as far as it was known when the table was made.
    size: f64,
    /// Where to find what is there, made when a plane is first inserted.
    index: Option<Index>,
}

impl PlaneTable {
    /// The id of a half-space, whose plane is added where it is not there yet. A plane that is nearly the same as one that
    /// is there ([`SNAP_TOLERANCE`](crate::SNAP_TOLERANCE), relative to its distance from the origin or the size of the smallest body) is
    /// taken to be that one, unless its normal is made of short integers.
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

    /// How many planes there are, both sides counting once.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len() / 2
    }

    /// Whether there are no planes.
    #[inline]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// How many different planes were replaced by one that was nearly the same.
    #[must_use]
    pub fn snapped(&self) -> usize {
        self.replaced.len()
    }

    /// The size of the smallest body, as far as it was known when the table was made.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The largest distance of a plane from the origin, those aside that were added exactly.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The exact coefficients of a plane.
    #[inline]
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
    #[inline]
    #[must_use]
    pub fn half_space(&self, plane: PlaneId) -> &HalfSpace {
        self.row(plane).half_space()
    }

    /// The meeting point of three planes, for asking sides.
    #[inline]
    #[must_use]
    pub fn homogeneous(&self, planes: [PlaneId; 3]) -> Homogeneous {
        let [a, b, c] = planes.map(|p| self.row(p));
        Homogeneous::meet(a, b, c)
    }

    /// On which side of `plane` the meeting point of a right-handed triple lies: positive is outside.
    #[inline]
    #[must_use]
    pub fn side(&self, planes: [PlaneId; 3], point: &Homogeneous, plane: PlaneId) -> Sign {
        if planes.iter().any(|p| p.index() == plane.index()) {
            return Sign::Zero;
        }
        point.side_of(planes.map(|p| self.row(p)), self.row(plane))
    }

    /// The sign of the determinant of three normals.
    #[inline]
    pub(crate) fn orient3(&self, a: PlaneId, b: PlaneId, c: PlaneId) -> Sign {
        orient3(self.row(a), self.row(b), self.row(c))
    }

    /// The sign of a component of the cross product of two normals.
    pub(crate) fn cross_component(&self, a: PlaneId, b: PlaneId, axis: usize) -> Sign {
        cross_component(self.row(a), self.row(b), axis)
    }

    /// The correctly rounded meeting point of three planes.
    #[must_use]
    pub fn position(&self, planes: [PlaneId; 3]) -> Option<DVec3> {
        let [a, b, c] = planes.map(|p| self.row(p));
        meet(a, b, c)
    }

    /// The id of a half-space where exactly its plane is known and `serves`, else what `add` gives for the side with a
    /// positive first coefficient.
    fn find_or_add(
        &mut self,
        half_space: &HalfSpace,
        serves: impl Fn(&Self, &(Row, PlaneId)) -> bool,
        add: impl FnOnce(&mut Self, &Row) -> PlaneId,
    ) -> PlaneId {
        let (row, reversed) = first_side(&Row::new(half_space));
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
        let (size, rows) = (self.size, &self.rows);
        let index = self.index.get_or_insert_default();
        index.near.get_or_insert_with(|| NearPlanes::of(rows, size)).find(place)
    }

    /// Adds a plane that is not there; `row` is the side with a positive first coefficient.
    fn add(&mut self, row: &Row) -> PlaneId {
        let id = self.push(row);
        if let Some(near) = self.index.as_mut().and_then(|index| index.near.as_mut()) {
            near.insert(unit(row), id);
        }
        id
    }

    /// Adds a plane without looking for it; only for tables to which [`insert`](Self::insert) adds nothing.
    pub(crate) fn push(&mut self, row: &Row) -> PlaneId {
        let id = PlaneId::new(self.len(), false);
        self.rows.extend([*row, row.flipped()]);
        id
    }

    /// Puts another plane in the place of one; only for tables to which [`insert`](Self::insert) adds nothing.
    pub(crate) fn put(&mut self, index: u32, row: &Row) {
        let at = 2 * index as usize;
        (self.rows[at], self.rows[at + 1]) = (*row, row.flipped());
    }
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
