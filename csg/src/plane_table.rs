//! Every plane of a model once: interned exactly up to scale, with noise snapped away.

use std::cmp::Ordering;

use planecut_kernel::sign::{Homogeneous, Row, Sign, cross_component, orient3};
use planecut_kernel::{DVec3, HalfSpace, meet};
use rustc_hash::FxHashMap;

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
/// The numbering depends on the planes alone, not on the order in which they were given.
#[derive(Debug, Clone, Default)]
pub struct PlaneTable {
    /// Two rows a plane: the side with the positive first coefficient, and the other.
    rows: Vec<Row>,
    half_spaces: Vec<HalfSpace>,
    snapped: usize,
}

impl PlaneTable {
    /// Interns half-spaces; gives the table and the id of each half-space in the order given.
    #[must_use]
    pub fn intern(half_spaces: &[HalfSpace]) -> (Self, Vec<PlaneId>) {
        let rows: Vec<Row> = half_spaces.iter().map(Row::new).collect();
        let (exact, class) = group_exactly(&rows);
        let mut table = Self::default();
        let ids = table.snap(&exact);
        let of_input = class.into_iter().zip(&rows).map(|(class, row)| {
            let id: PlaneId = ids[class as usize];
            if is_reversed(row) { id.flipped() } else { id }
        });
        let of_input = of_input.collect();
        (table, of_input)
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
        self.snapped
    }

    /// The exact coefficients of a plane.
    #[must_use]
    pub fn row(&self, plane: PlaneId) -> &Row {
        &self.rows[plane.0 as usize]
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
        let units: Vec<[f64; 4]> = planes.iter().map(unit).collect();
        let size = units.iter().map(|unit| unit[3].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let is_exact = |row: &Row| row.integer_bits().is_some_and(|bits| bits <= EXACT_BITS);
        let mut order: Vec<usize> = (0..planes.len()).collect();
        order.sort_unstable_by(|a, b| {
            let (p, q) = (&planes[*a], &planes[*b]);
            is_exact(q).cmp(&is_exact(p)).then_with(|| compare_coefficients(p, q))
        });
        let any_noise = order.last().is_some_and(|last| !is_exact(&planes[*last]));
        let mut near = NearPlanes::default();
        let mut ids = vec![PlaneId(0); planes.len()];
        for plane in order {
            let row = &planes[plane];
            let [x, y, z, d] = units[plane];
            let place = [x, y, z, d / size];
            let found = if is_exact(row) { None } else { near.find(&place) };
            ids[plane] = if let Some((index, opposite)) = found {
                self.snapped += 1;
                PlaneId::new(index, opposite)
            } else {
                if any_noise {
                    near.insert(place, self.len());
                }
                let id = PlaneId::new(self.len(), false);
                self.push(row);
                id
            };
        }
        ids
    }

    fn push(&mut self, row: &Row) {
        let [x, y, z, d] = *row.coefficients();
        let half_space = HalfSpace::new(DVec3::new(x, y, z), d).expect("scaled from a valid half-space");
        self.half_spaces.extend([half_space, half_space.flipped()]);
        self.rows.extend([*row, row.flipped()]);
    }
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
    let mut buckets: FxHashMap<(usize, [u64; 3]), Vec<u32>> = FxHashMap::default();
    let mut exact: Vec<Row> = Vec::new();
    let mut class = Vec::with_capacity(rows.len());
    for row in rows {
        let row = if is_reversed(row) { row.flipped() } else { *row };
        let (first, ratios) = row.ratios();
        let bucket = buckets.entry((first, ratios.map(f64::to_bits))).or_default();
        let known = bucket.iter().copied().find(|g| exact[*g as usize].is_same_plane(&row));
        let group = known.unwrap_or_else(|| {
            exact.push(row);
            bucket.push(exact.len() as u32 - 1);
            exact.len() as u32 - 1
        });
        let least = &mut exact[group as usize];
        if compare_coefficients(&row, least).is_lt() {
            *least = row;
        }
        class.push(group);
    }
    (exact, class)
}

/// Unit normal and distance from the origin.
fn unit(row: &Row) -> [f64; 4] {
    let [x, y, z, d] = *row.coefficients();
    let length = DVec3::new(x, y, z).length();
    [x / length, y / length, z / length, d / length]
}

/// A hash of planes by their unit normal and relative offset.
#[derive(Default)]
struct NearPlanes {
    cells: FxHashMap<[i64; 4], Vec<(usize, [f64; 4])>>,
}

impl NearPlanes {
    fn insert(&mut self, unit: [f64; 4], index: usize) {
        self.cells.entry(unit.map(cell)).or_default().push((index, unit));
    }

    /// A plane within the tolerance, and whether it is the opposite side that is near.
    fn find(&self, unit: &[f64; 4]) -> Option<(usize, bool)> {
        [false, true].into_iter().find_map(|opposite| {
            let wanted = if opposite { unit.map(|v| -v) } else { *unit };
            self.find_side(&wanted).map(|index| (index, opposite))
        })
    }

    fn find_side(&self, unit: &[f64; 4]) -> Option<usize> {
        let low = unit.map(|v| cell(v - SNAP_TOLERANCE));
        let high = unit.map(|v| cell(v + SNAP_TOLERANCE));
        let near = |other: &[f64; 4]| (0..4).all(|k| (unit[k] - other[k]).abs() <= SNAP_TOLERANCE);
        (0..16usize)
            .map(|corner| std::array::from_fn(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] }))
            .filter_map(|key: [i64; 4]| self.cells.get(&key))
            .flatten()
            .filter(|(_, other)| near(other))
            .map(|(index, _)| *index)
            .min()
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
    fn ids_do_not_depend_on_the_order() {
        let given: Vec<HalfSpace> =
            (0..50).map(|k| plane(f64::from(k % 7 - 3) + 0.1, f64::from(k % 5 - 2), 1.0, f64::from(k % 11))).collect();
        let (_, ids) = PlaneTable::intern(&given);
        let reversed: Vec<HalfSpace> = given.iter().rev().copied().collect();
        let (_, back) = PlaneTable::intern(&reversed);
        assert!(ids.iter().eq(back.iter().rev()));
    }
}
