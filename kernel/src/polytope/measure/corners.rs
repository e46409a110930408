//! The corners in about 100 bits, counted from one of them, with bounds of their errors.
//!
//! Where three planes `n·x ≤ d` meet, counted from a reference point, only the distances `r = d − n·reference` enter, and
//! those are known to twice the working precision however far off the body lies. So errors are small against the body,
//! not against its coordinates.

use std::array::from_fn;

use glam::DVec3;

use crate::arithmetic::{DoubleDouble, exact_product, exponent, ldexp};
use crate::meet::meet;
use crate::polytope::IncrementalPolytope;
use crate::sign::minor;

/// Error of a corner's double-double evaluation in units of the magnitudes of its terms: at most 16 times `2⁻¹⁰⁶` (operations
/// of relative error `3·2⁻¹⁰⁶` and `5·2⁻¹⁰⁶`: Joldes, Muller, Popescu 2017), with room for the rounding of the magnitudes.
const CORNER_BOUND: f64 = f64::from_bits((1023 - 101) << 52);
/// Error of a sum of five numbers in units of their magnitudes, with room.
const SUM_BOUND: f64 = f64::from_bits((1023 - 50) << 52);
/// Sizes at which no low word of a corner underflows.
const SAFE_REFERENCE: std::ops::RangeInclusive<f64> = 1e-150..=1e150;
const SAFE_DISTANCE: std::ops::RangeInclusive<f64> = 1e-120..=1e150;

/// A position in three coordinates of about 100 bits.
pub(super) type Corner = [DoubleDouble; 3];

/// A number of about 100 bits and a bound of its error.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bounded {
    pub(super) value: DoubleDouble,
    pub(super) error: f64,
}

/// Corners by slot, scaled by a power of two on each axis so that all coordinates are at most one.
pub(super) struct Corners {
    pub(super) corners: Vec<Corner>,
    /// The largest error of a coordinate of each, scaled as they are.
    pub(super) errors: Vec<f64>,
    /// `d − n·reference` for each plane with a face, not scaled.
    pub(super) distances: Vec<Bounded>,
    /// A corner, rounded.
    pub(super) reference: DVec3,
    /// The units: powers of two, between one and two times the largest coordinate.
    pub(super) exponents: [i64; 3],
}

impl IncrementalPolytope {
    /// `None` where some number leaves the range in which the bounds hold.
    pub(super) fn double_corners(&self) -> Option<Corners> {
        let first = self.vertices.slots().next()?;
        let reference = self.rounded_corner(first)?;
        let mut distances = vec![Bounded::default(); self.planes.slot_count() as usize];
        for plane in self.face_slots() {
            distances[plane as usize] = distance(self.row(plane).coefficients(), reference)?;
        }
        let mut corners = vec![Corner::default(); self.vertices.slot_count()];
        let mut errors = vec![[0.0f64; 3]; self.vertices.slot_count()];
        let mut size = [0.0f64; 3];
        let mut may_be_exact = true;
        for vertex in self.vertices.slots() {
            let exact = if may_be_exact { self.exact_corner(vertex) } else { None };
            may_be_exact = exact.is_some();
            let corner = match exact {
                Some(position) => from_fn(|axis| DoubleDouble::sum(position[axis], -reference[axis])),
                None => {
                    let from = self.vertices.planes(vertex).map(|plane| distances[plane as usize]);
                    let (corner, error) = self.double_corner(vertex, from)?;
                    errors[vertex as usize] = error;
                    corner
                }
            };
            for axis in 0..3 {
                size[axis] = size[axis].max(corner[axis].high.abs());
            }
            corners[vertex as usize] = corner;
        }
        if size.into_iter().any(|s| !(1e-60..1e60).contains(&s)) {
            return None;
        }
        let exponents = size.map(|s| i64::from(exponent(s)) + 1);
        let scale = exponents.map(|e| ldexp(1.0, -e));
        for corner in &mut corners {
            for (axis, coordinate) in corner.iter_mut().enumerate() {
                *coordinate = scaled(*coordinate, scale[axis]);
            }
        }
        // what a low word may lose to underflow is far below the smallest normal number
        let largest = |e: &[f64; 3]| (0..3).map(|axis| e[axis] * scale[axis]).fold(f64::MIN_POSITIVE, f64::max);
        let errors = errors.iter().map(largest).collect();
        Some(Corners { corners, errors, distances, reference, exponents })
    }

    /// A vertex, rounded, where it is in the range in which the bounds hold.
    pub(super) fn rounded_corner(&self, vertex: u32) -> Option<DVec3> {
        let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane));
        let corner = meet(a, b, c)?;
        corner.to_array().into_iter().all(|v| v == 0.0 || SAFE_REFERENCE.contains(&v.abs())).then_some(corner)
    }

    /// The position of a vertex where it can be seen at once that its coordinates are exact.
    fn exact_corner(&self, vertex: u32) -> Option<DVec3> {
        let rows = self.vertices.planes(vertex).map(|plane| self.row(plane));
        let point = meet(rows[0], rows[1], rows[2])?;
        let on_plane = |coefficients: &[f64; 4]| {
            let terms: [(f64, f64); 3] = from_fn(|k| exact_product(coefficients[k], point[k]));
            // two sums of exact terms that are both exact leave no doubt
            let sum = DoubleDouble::sum(terms[0].0, terms[1].0);
            let all = DoubleDouble::sum(sum.high, terms[2].0);
            terms.iter().all(|(_, low)| *low == 0.0) && sum.low == 0.0 && all.low == 0.0 && all.high == coefficients[3]
        };
        rows.into_iter().all(|row| on_plane(row.coefficients())).then_some(point)
    }

    /// A vertex counted from a reference, given the distances of its three planes from there, with bounds of the errors.
    pub(super) fn double_corner(&self, vertex: u32, from: [Bounded; 3]) -> Option<(Corner, [f64; 3])> {
        let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane).coefficients());
        let (mut w, mut w_size) = (DoubleDouble::default(), 0.0);
        let mut numerators = [Bounded::default(); 3];
        for (axis, numerator) in numerators.iter_mut().enumerate() {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let minors = [minor(b, c, u, v), minor(c, a, u, v), minor(a, b, u, v)];
            let terms: [DoubleDouble; 3] = from_fn(|k| minors[k].times_sum(from[k].value));
            numerator.value = terms[0].plus(terms[1]).plus(terms[2]);
            let of_term = |k: usize| CORNER_BOUND * terms[k].high.abs() + minors[k].high.abs() * from[k].error;
            numerator.error = of_term(0) + of_term(1) + of_term(2);
            let term = minors[0].times(a[axis]);
            w = w.plus(term);
            w_size += term.high.abs();
        }
        let w_error = CORNER_BOUND * w_size / w.high.abs();
        if w_error.is_nan() || w_error > 1e-3 {
            return None;
        }
        let inverse = DoubleDouble::sum(1.0, 0.0).over(w);
        let corner: Corner = from_fn(|axis| numerators[axis].value.times_sum(inverse));
        let error = from_fn(|axis| {
            1.01 * (numerators[axis].error / w.high.abs() + corner[axis].high.abs() * (w_error + CORNER_BOUND))
        });
        Some((corner, error))
    }
}

/// `d − n·point` of a row `[n | d]`, its error relative to itself but for what lies far below; `None` where it is out of range.
pub(super) fn distance(row: &[f64; 4], point: DVec3) -> Option<Bounded> {
    let products: [(f64, f64); 3] = from_fn(|k| exact_product(-row[k], point[k]));
    let [(x, x_low), (y, y_low), (z, z_low)] = products;
    let mut parts = [x_low, y_low, z_low, x, y, z, row[3]];
    // each pass moves what it can to the end, without error (Ogita, Rump, Oishi 2005)
    for _ in 0..2 {
        for k in 1..parts.len() {
            let sum = DoubleDouble::sum(parts[k], parts[k - 1]);
            (parts[k], parts[k - 1]) = (sum.high, sum.low);
        }
    }
    let [rest @ .., most] = parts;
    let value = DoubleDouble::sum(most, rest.iter().sum());
    let size = value.high.abs();
    let error = SUM_BOUND * rest.iter().map(|v| v.abs()).sum::<f64>();
    (size == 0.0 || SAFE_DISTANCE.contains(&size)).then_some(Bounded { value, error })
}

/// Times a power of two.
pub(super) fn scaled(v: DoubleDouble, power: f64) -> DoubleDouble {
    DoubleDouble { high: v.high * power, low: v.low * power }
}
