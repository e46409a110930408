//! The tier of about 100 bits: double-double sums with an error bound.
//!
//! In the units of [`corners`](super::corners) all coordinates are at most one. On a face the coordinate `k` along which its
//! (scaled) normal is largest is a combination `h + α·u + β·v` of the two others with `|α|, |β| ≤ 1` and `|h| ≤ 3`, so that
//! only six planar sums run over its corners (Mirtich 1996).

use std::array::from_fn;

use super::corners::{Bounded, Corner, Corners, distance, scaled};
use super::moments::Sums;
use crate::arithmetic::{DoubleDouble, exponent, ldexp};
use crate::polytope::IncrementalPolytope;

/// Relative error of a double-double product or sum (`5·2⁻¹⁰⁶` at most, Joldes, Muller, Popescu 2017), with room.
const ROUNDING: f64 = f64::from_bits((1023 - 103) << 52);
/// The same for a chain of a dozen of them, or a quotient.
const STEP_BOUND: f64 = f64::from_bits((1023 - 99) << 52);
/// What each further term of a running sum adds to that.
const TERM_BOUND: f64 = f64::from_bits((1023 - 104) << 52);
const HALF_UNIT: f64 = f64::from_bits((1023 - 55) << 52);
/// What the difference of two coordinates that were rounded to single numbers can be off by, twice.
const EDGE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The sums of all faces with bounds of their errors, and the area where it is certain.
pub(super) struct DoubleSums {
    pub(super) sums: Sums,
    pub(super) area: Option<f64>,
}

/// Sums over the fan of one face in two coordinates.
#[derive(Default)]
struct PlanarSums {
    /// Twice the area.
    twice: DoubleDouble,
    /// With the sums of the corners' `u`, `v`.
    first: [DoubleDouble; 2],
    /// With the sums for `u·u`, `u·v`, `v·v`.
    second: [DoubleDouble; 3],
    /// A bound of the error of `twice`.
    error: f64,
}

/// A face in the units of the axes, seen along the axis that its scaled normal is nearest to.
struct Projection {
    /// The axis `k` and the two others, in positive order.
    axes: [usize; 3],
    /// The scaled normal, and the inverse of its component `k`.
    normal: [f64; 3],
    inverse: DoubleDouble,
    /// `|n| / |n_k|` of the normal as it is.
    factor: DoubleDouble,
}

impl Projection {
    fn of(normal: [f64; 3], exponents: [i64; 3], largest: i64) -> Self {
        let scaled: [f64; 3] = from_fn(|k| normal[k] * ldexp(1.0, exponents[k] - largest));
        let k = (0..3).fold(0, |k, i| if scaled[i].abs() > scaled[k].abs() { i } else { k });
        let over = |dividend: DoubleDouble, divisor: f64| dividend.over(DoubleDouble::sum(divisor, 0.0));
        Self {
            axes: [k, (k + 1) % 3, (k + 2) % 3],
            normal: scaled,
            inverse: over(DoubleDouble::sum(1.0, 0.0), scaled[k]),
            factor: over(length(normal), normal[k].abs()),
        }
    }

    /// The intercept `h` of a plane whose scaled distance from the reference is given.
    fn intercept(&self, distance: Bounded) -> Bounded {
        let value = self.inverse.times_sum(distance.value);
        let error = distance.error / self.normal[self.axes[0]].abs() + STEP_BOUND * value.high.abs();
        Bounded { value, error: 1.01 * error }
    }
}

/// The running sums over faces.
#[derive(Default)]
struct Running {
    six_volume: DoubleDouble,
    first: [DoubleDouble; 3],
    second: [DoubleDouble; 6],
    errors: [f64; 3],
}

impl Running {
    /// The part of a face whose intercept is `h`; `step` is the relative error of the sums.
    fn add(&mut self, planar: &PlanarSums, projection: &Projection, h: &Bounded, step: f64) {
        for (sum, error) in self.errors.iter_mut().zip(face_errors(h, planar, step)) {
            *sum += 1.01 * error;
        }
        let h = h.value;
        let [k, u, v] = projection.axes;
        let slope = |axis: usize| projection.inverse.times(-projection.normal[axis]);
        let (alpha, beta) = (slope(u), slope(v));
        let combine = |p: DoubleDouble, q: DoubleDouble| alpha.times_sum(p).plus(beta.times_sum(q));
        let [fu, fv] = planar.first;
        let [uu, uv, vv] = planar.second;
        let slanted = combine(fu, fv);
        let h_twice = h.times_sum(planar.twice);
        let fk = h_twice.times(3.0).plus(slanted);
        let (slant_u, slant_v) = (combine(uu, uv), combine(uv, vv));
        let uk = h.times_sum(fu).times(4.0).plus(slant_u);
        let vk = h.times_sum(fv).times(4.0).plus(slant_v);
        let kk = h.times_sum(h_twice.times(12.0).plus(slanted.times(8.0))).plus(combine(slant_u, slant_v));
        self.six_volume = self.six_volume.plus(h_twice);
        for (axis, value) in [(u, fu), (v, fv), (k, fk)] {
            self.first[axis] = self.first[axis].plus(h.times_sum(value));
        }
        for (place, value) in [(u, uu), (v, vv), (k, kk), (3 + u, vk), (3 + v, uk), (3 + k, uv)] {
            self.second[place] = self.second[place].plus(h.times_sum(value));
        }
    }
}

impl IncrementalPolytope {
    /// The sums, where no number leaves the range in which the bounds hold.
    pub(super) fn double_sums(&self) -> Option<DoubleSums> {
        let Corners { corners, errors: corner_errors, distances, reference, exponents } = self.double_corners()?;
        let mut running = Running::default();
        let step = self.step_bound();
        let (mut area, mut area_error) = (DoubleDouble::default(), 0.0);
        let largest = exponents.into_iter().max()?;
        let to_units = ldexp(1.0, -largest);
        for plane in self.face_slots() {
            let Bounded { value, error } = distances[plane as usize];
            let distance = Bounded { value: scaled(value, to_units), error: error * to_units };
            // the cone over a face through the reference has no volume
            let with_moments = value.high != 0.0 || error != 0.0;
            let [x, y, z, _] = *self.row(plane).coefficients();
            let projection = Projection::of([x, y, z], exponents, largest);
            let [_, u, v] = projection.axes;
            let start = self.planes.face_vertex(plane);
            let slots = || self.vertices.face_ring(plane, start);
            let error = slots().map(|vertex| corner_errors[vertex as usize]).fold(0.0, f64::max);
            let ring = slots().map(|vertex| &corners[vertex as usize]);
            let planar = PlanarSums::of(ring, [u, v], error, with_moments);
            let unit = ldexp(1.0, exponents[u] + exponents[v] - 2 * largest);
            let part = planar.area(&projection.factor, step);
            area = area.plus(scaled(part.value, unit));
            area_error += part.error * unit;
            if with_moments {
                running.add(&planar, &projection, &projection.intercept(distance), step);
            }
        }
        let area = certain_area(area, area_error).map(|area| ldexp(area, 2 * largest));
        let Running { six_volume, first, second, errors } = running;
        let sums = Sums { six_volume, first, second, errors, exponent: 0, reference, units: exponents };
        Some(DoubleSums { sums, area: area.filter(|_| largest.abs() < 200) })
    }

    /// The area of one face, where it is certain.
    pub(super) fn double_face_area(&self, plane: u32) -> Option<f64> {
        let start = self.planes.face_vertex(plane);
        let reference = self.rounded_corner(start)?;
        let (mut corners, mut error, mut size) = (Vec::new(), f64::MIN_POSITIVE, 0.0f64);
        for vertex in self.vertices.face_ring(plane, start) {
            let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane).coefficients());
            let from = [distance(a, reference)?, distance(b, reference)?, distance(c, reference)?];
            let (corner, corner_error) = self.double_corner(vertex, from)?;
            size = corner.iter().fold(size, |size, coordinate| size.max(coordinate.high.abs()));
            error = corner_error.into_iter().fold(error, f64::max);
            corners.push(corner);
        }
        if !(1e-60..1e60).contains(&size) {
            return None;
        }
        let unit = i64::from(exponent(size)) + 1;
        let scale = ldexp(1.0, -unit);
        corners.iter_mut().flatten().for_each(|coordinate| *coordinate = scaled(*coordinate, scale));
        let [x, y, z, _] = *self.row(plane).coefficients();
        let projection = Projection::of([x, y, z], [0; 3], 0);
        let [_, u, v] = projection.axes;
        let planar = PlanarSums::of(corners.iter(), [u, v], error * scale, false);
        let Bounded { value, error } = planar.area(&projection.factor, self.step_bound());
        certain_area(value, error).map(|area| ldexp(area, 2 * unit))
    }

    /// The relative error of a sum of as many terms as there are faces or corners of a face.
    fn step_bound(&self) -> f64 {
        STEP_BOUND + TERM_BOUND * (self.vertices.len() + 3) as f64
    }
}

/// An area, from twice of it, where its error moves it by less than half a unit in the last place.
fn certain_area(twice: DoubleDouble, error: f64) -> Option<f64> {
    (error <= HALF_UNIT * twice.high).then_some(twice.high / 2.0)
}

/// Bounds of the errors that a face brings into the three kinds of sums: `h` its intercept and `step` the relative error of
/// the sums.
///
/// With `F = 6·∫u` and `G = 24·∫u·v` over the planar polygon and all coordinates at most one, an error `e` of twice the area
/// that comes from moved borders is one of `3·e` and `12·e` there. Through the combinations with `|α|, |β| ≤ 1` this gives
/// `h`, `h·(3h + 6)` and `h·(12h² + 48h + 48)` times `e`; the derivatives by `h` are `1`, `6h + 6` and `36h² + 96h + 48` times
/// `twice`.
fn face_errors(h: &Bounded, planar: &PlanarSums, step: f64) -> [f64; 3] {
    let Bounded { value, error } = h;
    let h = value.high.abs() + error;
    let twice = planar.twice.high.abs() + planar.error;
    let size = [h, h * (3.0 * h + 6.0), h * (12.0 * h * h + 48.0 * h + 48.0)];
    let by_h = [1.0, 6.0 * h + 6.0, 36.0 * h * h + 96.0 * h + 48.0];
    from_fn(|k| size[k] * (planar.error + 8.0 * step * twice) + by_h[k] * twice * error)
}

impl PlanarSums {
    /// The sums over a ring of corners whose coordinates are off by `error` at most.
    fn of<'a>(mut ring: impl Iterator<Item = &'a Corner>, [u, v]: [usize; 2], error: f64, with_moments: bool) -> Self {
        let mut sums = Self::default();
        let (Some(a), Some(b)) = (ring.next(), ring.next()) else { return sums };
        let products = |p: &Corner| [p[u].times_sum(p[u]), p[u].times_sum(p[v]), p[v].times_sum(p[v])];
        let away = |p: &Corner| [p[u].plus(a[u].negated()), p[v].plus(a[v].negated())];
        let length = |[du, dv]: &[DoubleDouble; 2]| du.high.abs() + dv.high.abs();
        let at_a = if with_moments { products(a) } else { Default::default() };
        let (mut b, mut at_b, mut to_b) = (b, if with_moments { products(b) } else { at_a }, away(b));
        sums.error = 2.0 * error * (length(&to_b) + 4.0 * error);
        for c in ring {
            let to_c = away(c);
            let twice = to_b[0].times_sum(to_c[1]).plus(to_b[1].times_sum(to_c[0]).negated());
            sums.twice = sums.twice.plus(twice);
            // Moving a corner moves twice the area by the two edges there; and the products are rounded.
            let edge = (c[u].high - b[u].high).abs() + (c[v].high - b[v].high).abs();
            let (near, far) = (length(&to_b), length(&to_c));
            sums.error += 2.0 * error * (edge + EDGE_ROUNDING + 4.0 * error) + 8.0 * ROUNDING * near * far;
            if with_moments {
                let at_c = products(c);
                let (su, sv) = (a[u].plus(b[u]).plus(c[u]), a[v].plus(b[v]).plus(c[v]));
                let both = [su.times_sum(su), su.times_sum(sv), sv.times_sum(sv)];
                for i in 0..3 {
                    let sum = both[i].plus(at_a[i]).plus(at_b[i]).plus(at_c[i]);
                    sums.second[i] = sums.second[i].plus(twice.times_sum(sum));
                }
                sums.first = [sums.first[0].plus(twice.times_sum(su)), sums.first[1].plus(twice.times_sum(sv))];
                at_b = at_c;
            }
            (b, to_b) = (c, to_c);
        }
        sums.error += 2.0 * error * (length(&to_b) + 4.0 * error);
        sums
    }

    /// Twice the area of the face itself.
    fn area(&self, factor: &DoubleDouble, step: f64) -> Bounded {
        let twice = if self.twice.high < 0.0 { self.twice.negated() } else { self.twice };
        let error = self.error + 4.0 * step * (twice.high + self.error);
        Bounded { value: twice.times_sum(*factor), error: 1.01 * error * factor.high }
    }
}

/// The length of a vector.
fn length(vector: [f64; 3]) -> DoubleDouble {
    let squared = vector.into_iter().fold(DoubleDouble::default(), |sum, n| sum.plus(DoubleDouble::product(n, n)));
    let root = squared.high.sqrt();
    let rest = squared.plus(DoubleDouble::product(root, root).negated());
    DoubleDouble::sum(root, rest.high / (2.0 * root))
}
