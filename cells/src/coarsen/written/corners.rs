//! The corners of a cell, and points with exact coordinates whose hull holds it.

use planecut_kernel::sign::Row;
use planecut_kernel::{DVec3, HalfSpace, MAX_COORDINATE, PlaneIdx, meet};
use rustc_hash::FxHashMap;

use super::super::part::{Part, holds};

/// Coordinates nearer to zero are outside of what hulls accept.
pub(super) const LEAST: f64 = 2.0 / MAX_COORDINATE;

/// A corner, and three faces at it.
pub(super) struct Corner {
    /// Rounded.
    pub(super) place: DVec3,
    pub(super) faces: [usize; 3],
}

/// The corners of a cell.
pub(super) struct Corners {
    /// One for each three planes that meet in one: there may be several at one place.
    pub(super) corners: Vec<Corner>,
    /// Unit normals of the faces.
    pub(super) normals: Vec<DVec3>,
    /// Points whose hull holds the cell, exactly: its corners where they have coordinates in double precision, otherwise the corners of a box around each.
    pub(super) holding: Vec<DVec3>,
}

impl Corners {
    /// Those of a cell that is scaled.
    pub(super) fn of(part: &Part, scale: f64) -> Self {
        let mut faces: FxHashMap<usize, usize> = FxHashMap::default();
        let mut normals = Vec::new();
        let mut face = |plane: PlaneIdx, half_space: &HalfSpace| {
            *faces.entry(plane.0).or_insert_with(|| {
                normals.push(half_space.normal().normalize_or(DVec3::Z));
                normals.len() - 1
            })
        };
        let (mut corners, mut holding) = (Vec::new(), Vec::new());
        for planes in part.polytope.simple_vertices() {
            let [Some(a), Some(b), Some(c)] = planes else { continue };
            let [Some(p), Some(q), Some(r)] = [a, b, c].map(|plane| part.polytope.plane(plane)) else { continue };
            let Some(place) = meet(&Row::new(p), &Row::new(q), &Row::new(r)) else { continue };
            let is_exact = [p, q, r].into_iter().all(|plane| holds(plane, place) && holds(&plane.flipped(), place));
            surround(place, is_exact, scale, &mut holding);
            corners.push(Corner { place: place * scale, faces: [face(a, p), face(b, q), face(c, r)] });
        }
        holding.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap_or(std::cmp::Ordering::Equal));
        holding.dedup();
        Self { corners, normals, holding }
    }

    /// Where the corners are.
    pub(super) fn places(&self) -> Vec<DVec3> {
        self.corners.iter().map(|corner| corner.place).collect()
    }

    /// How far a corner may be from its rounded place: a unit in the last place of each coordinate, twice, since scaling rounds again.
    pub(super) fn rounding(&self) -> f64 {
        let largest = self.corners.iter().map(|corner| corner.place.abs().max_element()).fold(0.0, f64::max);
        4.0 * f64::EPSILON * largest.max(LEAST)
    }
}

/// Adds points whose hull holds a corner that was rounded to `place`, scaled.
fn surround(place: DVec3, is_exact: bool, scale: f64, points: &mut Vec<DVec3>) {
    let ranges = place.to_array().map(|value| range(value, is_exact, scale));
    for corner in 0..8 {
        if (0..3).all(|axis| corner >> axis & 1 == 0 || ranges[axis][0] < ranges[axis][1]) {
            points.push(DVec3::from_array([0, 1, 2].map(|axis| ranges[axis][corner >> axis & 1])));
        }
    }
}

/// Two numbers that a scaled coordinate is surely not outside of; both are it where it is exact. A coordinate that is rounded to the nearest has
/// the true one between the numbers next to it.
fn range(value: f64, is_exact: bool, scale: f64) -> [f64; 2] {
    let [low, high] = if is_exact { [value, value] } else { [value.next_down(), value.next_up()] };
    let (low, high) = (scaled(low, scale, f64::next_down), scaled(high, scale, f64::next_up));
    let is_usable = |value: f64| value == 0.0 || value.abs() >= LEAST;
    let low = if is_usable(low) {
        low
    } else if low > 0.0 {
        0.0
    } else {
        -LEAST
    };
    let high = if is_usable(high) {
        high
    } else if high < 0.0 {
        0.0
    } else {
        LEAST
    };
    [low + 0.0, high + 0.0]
}

/// A product, or where it is rounded what `beyond` makes of it.
fn scaled(value: f64, scale: f64, beyond: fn(f64) -> f64) -> f64 {
    let product = value * scale;
    if value.mul_add(scale, -product) == 0.0 && (product != 0.0 || value == 0.0) { product } else { beyond(product) }
}
