//! The tier of about 100 bits: double-double sums with an error bound.
//!
//! Each axis is scaled by a power of two so that all coordinates, counted from one corner, are at most one. On a face the
//! coordinate `k` along which its (scaled) normal is largest is a combination `h + α·u + β·v` of the two others with
//! `|α|, |β| ≤ 1` and `|h| ≤ 3`, so that only six planar sums run over its corners (Mirtich 1996).

use std::array::from_fn;

use dashu_int::IBig;
use glam::DVec3;

use super::fan::exponent;
use super::moments::Sums;
use crate::double_double::DoubleDouble;
use crate::meet::{ldexp, meet};
use crate::polytope::IncrementalPolytope;
use crate::sign::big_integers;

/// Relative error of a coordinate's double-double evaluation, in units of its permanent: as for meeting points.
const CORNER_BOUND: f64 = f64::from_bits((1023 - 98) << 52);
/// Relative error of a double-double product or sum (`3·2⁻¹⁰⁶`, Joldes, Muller, Popescu 2017), with room for a quotient's.
const ROUNDING: f64 = f64::from_bits((1023 - 103) << 52);
/// The same for a chain of a dozen of them.
const STEP_BOUND: f64 = f64::from_bits((1023 - 99) << 52);
/// Bits behind the point when the sums become integers; below every double-double error above.
const FRACTION: usize = 160;
const HALF_UNIT: f64 = f64::from_bits((1023 - 55) << 52);

type Corner = [DoubleDouble; 3];

/// The sums of all faces with bounds of their errors.
pub(super) struct DoubleSums {
    six_volume: DoubleDouble,
    first: [DoubleDouble; 3],
    second: [DoubleDouble; 6],
    errors: [f64; 3],
    reference: DVec3,
    exponents: [i64; 3],
    /// The area, where it is certain.
    pub(super) area: Option<f64>,
}

/// Scaled corners by slot.
struct Corners {
    corners: Vec<Corner>,
    /// The largest error of a coordinate of each.
    errors: Vec<f64>,
    reference: DVec3,
    exponents: [i64; 3],
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

impl IncrementalPolytope {
    /// The sums, where no number leaves the range in which the bounds hold; only the area unless `with_moments`.
    pub(super) fn double_sums(&self, with_moments: bool) -> Option<DoubleSums> {
        let Corners { corners, errors: corner_errors, reference, exponents } = self.double_corners()?;
        let zero = DoubleDouble::default();
        let (mut six_volume, mut first, mut second) = (zero, [zero; 3], [zero; 6]);
        // a running sum of n terms can lose n roundings
        let step = STEP_BOUND + ROUNDING * 4.0 * self.vertices.len() as f64;
        let mut errors = [0.0; 3];
        let (mut area, mut area_error) = (zero, 0.0);
        let largest = exponents.into_iter().max()?;
        for plane in self.face_slots() {
            let [x, y, z, _] = *self.row(plane).coefficients();
            let normal = [x, y, z];
            let scaled: [f64; 3] = from_fn(|k| normal[k] * ldexp(1.0, exponents[k] - largest));
            let k = (0..3).fold(0, |k, i| if scaled[i].abs() > scaled[k].abs() { i } else { k });
            let (u, v) = ((k + 1) % 3, (k + 2) % 3);
            let start = self.planes.face_vertex(plane);
            let slots = || self.vertices.face_ring(plane, start);
            let error = slots().map(|vertex| corner_errors[vertex as usize]).fold(0.0, f64::max);
            let ring = slots().map(|vertex| &corners[vertex as usize]);
            let planar = PlanarSums::of(ring, [u, v], error, with_moments);

            let length = square_root(normal.into_iter().fold(zero, |sum, n| sum.plus(DoubleDouble::product(n, n))));
            let factor = length.over(DoubleDouble::sum(normal[k].abs(), 0.0));
            let unit = ldexp(1.0, exponents[u] + exponents[v] - 2 * largest);
            let twice = if planar.twice.high < 0.0 { planar.twice.negated() } else { planar.twice };
            area = area.plus(twice.times_sum(factor).times(unit));
            area_error += (planar.error + 4.0 * step * twice.high) * factor.high * unit;
            if !with_moments {
                continue;
            }

            let over_k = |value: DoubleDouble| value.over(DoubleDouble::sum(scaled[k], 0.0));
            let alpha = over_k(DoubleDouble::sum(-scaled[u], 0.0));
            let beta = over_k(DoubleDouble::sum(-scaled[v], 0.0));
            let at = &corners[start as usize];
            let h = at[k].plus(alpha.times_sum(at[u]).negated()).plus(beta.times_sum(at[v]).negated());
            let [fu, fv] = planar.first;
            let [uu, uv, vv] = planar.second;
            let combine = |p: DoubleDouble, q: DoubleDouble| alpha.times_sum(p).plus(beta.times_sum(q));
            let slanted = combine(fu, fv);
            let h_twice = h.times_sum(planar.twice);
            let fk = h_twice.times(3.0).plus(slanted);
            let (slant_u, slant_v) = (combine(uu, uv), combine(uv, vv));
            let uk = h.times_sum(fu).times(4.0).plus(slant_u);
            let vk = h.times_sum(fv).times(4.0).plus(slant_v);
            let kk = h.times_sum(h_twice.times(12.0).plus(slanted.times(8.0))).plus(combine(slant_u, slant_v));
            six_volume = six_volume.plus(h_twice);
            for (axis, value) in [(u, fu), (v, fv), (k, fk)] {
                first[axis] = first[axis].plus(h.times_sum(value));
            }
            for (place, value) in [(u, uu), (v, vv), (k, kk), (3 + u, vk), (3 + v, uk), (3 + k, uv)] {
                second[place] = second[place].plus(h.times_sum(value));
            }
            let of_face = face_errors(h.high.abs(), planar.error, planar.twice.high.abs(), error, step);
            for (sum, error) in errors.iter_mut().zip(of_face) {
                *sum += 1.01 * error;
            }
        }
        let certain = area_error.is_finite() && area_error <= HALF_UNIT * area.high && largest.abs() < 200;
        let area = certain.then(|| ldexp(area.high / 2.0, 2 * largest));
        errors.into_iter().all(f64::is_finite).then_some(DoubleSums {
            six_volume,
            first,
            second,
            errors,
            reference,
            exponents,
            area,
        })
    }

    fn double_corners(&self) -> Option<Corners> {
        let first = self.vertices.slots().next()?;
        let [a, b, c] = self.vertices.planes(first).map(|plane| self.row(plane));
        let reference = meet(a, b, c)?;
        let mut corners = vec![Corner::default(); self.vertices.slot_count()];
        let mut errors = vec![[0.0f64; 3]; self.vertices.slot_count()];
        let mut size = [0.0f64; 3];
        for vertex in self.vertices.slots() {
            let (corner, corner_error) = self.double_corner(vertex, reference)?;
            for axis in 0..3 {
                size[axis] = size[axis].max(corner[axis].high.abs());
            }
            corners[vertex as usize] = corner;
            errors[vertex as usize] = corner_error;
        }
        if size.into_iter().any(|s| !(1e-60..1e60).contains(&s)) {
            return None;
        }
        let exponents = size.map(|s| i64::from(exponent(s)) + 1);
        let scale = exponents.map(|e| ldexp(1.0, -e));
        for corner in &mut corners {
            for (axis, coordinate) in corner.iter_mut().enumerate() {
                (coordinate.high, coordinate.low) = (coordinate.high * scale[axis], coordinate.low * scale[axis]);
            }
        }
        let errors = errors.into_iter().map(|e| (0..3).map(|axis| e[axis] * scale[axis]).fold(0.0, f64::max)).collect();
        Some(Corners { corners, errors, reference, exponents })
    }

    /// A vertex counted from the reference, with bounds of the errors.
    fn double_corner(&self, vertex: u32, reference: DVec3) -> Option<(Corner, [f64; 3])> {
        let permanent = &self.vertices.point(vertex).permanent;
        if permanent.iter().any(|p| *p != 0.0 && !(1e-150..=1e150).contains(p)) {
            return None;
        }
        let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane).coefficients());
        let minor = |p: &[f64; 4], q: &[f64; 4], u: usize, v: usize| {
            DoubleDouble::product(p[u], q[v]).plus(DoubleDouble::product(p[v], q[u]).negated())
        };
        let mut w = DoubleDouble::default();
        let mut numerators = Corner::default();
        for (axis, numerator) in numerators.iter_mut().enumerate() {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let (bc, ca, ab) = (minor(b, c, u, v), minor(c, a, u, v), minor(a, b, u, v));
            *numerator = bc.times(a[3]).plus(ca.times(b[3])).plus(ab.times(c[3]));
            w = w.plus(bc.times(a[axis]));
        }
        let w_error = CORNER_BOUND * permanent[3] / w.high.abs();
        if w_error.is_nan() || w_error > 1e-3 {
            return None;
        }
        let mut error = [0.0; 3];
        let corner = from_fn(|axis| {
            let quotient = numerators[axis].over(w);
            let relative = 2.0 * (w_error + STEP_BOUND);
            error[axis] = relative * (quotient.high.abs() + reference[axis].abs())
                + 2.0 * CORNER_BOUND * permanent[axis] / w.high.abs();
            quotient.plus(DoubleDouble::sum(-reference[axis], 0.0))
        });
        Some((corner, error))
    }
}

/// Bounds of the errors that a face brings into the three kinds of sums: `h` its intercept, `twice` its planar area with
/// error `planar`, `corner` the error of its corners and `step` the relative one of the sums.
///
/// With `F = 6·∫u` and `G = 24·∫u·v` over the planar polygon and all coordinates at most one, an error `e` of twice the area
/// that comes from moved borders is one of `3·e` and `12·e` there. Through the combinations with `|α|, |β| ≤ 1` this gives
/// `h`, `h·(3h + 6)` and `h·(12h² + 48h + 48)` times `e`; the derivatives by `h`, which is off by at most three errors of a
/// corner, are `1`, `6h + 6` and `36h² + 96h + 48` times `twice`.
fn face_errors(h: f64, planar: f64, twice: f64, corner: f64, step: f64) -> [f64; 3] {
    let size = [h, h * (3.0 * h + 6.0), h * (12.0 * h * h + 48.0 * h + 48.0)];
    let by_h = [1.0, 6.0 * h + 6.0, 36.0 * h * h + 96.0 * h + 48.0];
    from_fn(|k| size[k] * (planar + 8.0 * step * twice) + by_h[k] * twice * (3.0 * corner + 4.0 * step))
}

impl PlanarSums {
    /// The sums over a ring of corners whose coordinates are off by `error` at most.
    fn of<'a>(mut ring: impl Iterator<Item = &'a Corner>, [u, v]: [usize; 2], error: f64, with_moments: bool) -> Self {
        let mut sums = Self::default();
        let (Some(a), Some(b)) = (ring.next(), ring.next()) else { return sums };
        let products = |p: &Corner| [p[u].times_sum(p[u]), p[u].times_sum(p[v]), p[v].times_sum(p[v])];
        let away = |p: &Corner| [p[u].plus(a[u].negated()), p[v].plus(a[v].negated())];
        let length = |[du, dv]: &[DoubleDouble; 2]| du.high.abs() + dv.high.abs();
        let at_a = products(a);
        let (mut b, mut at_b, mut to_b) = (b, products(b), away(b));
        sums.error = 2.0 * error * (length(&to_b) + 4.0 * error);
        for c in ring {
            let to_c = away(c);
            let twice = to_b[0].times_sum(to_c[1]).plus(to_b[1].times_sum(to_c[0]).negated());
            sums.twice = sums.twice.plus(twice);
            // Moving a corner moves twice the area by the two edges there; and the products are rounded.
            let edge = length(&[c[u].plus(b[u].negated()), c[v].plus(b[v].negated())]);
            let (near, far) = (length(&to_b), length(&to_c));
            sums.error += 2.0 * error * (edge + 4.0 * error) + 8.0 * ROUNDING * near * far;
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
}

impl DoubleSums {
    /// The same as integers.
    pub(super) fn sums(&self) -> Sums {
        let whole = |v: &DoubleDouble| {
            let [high, low, one] = big_integers([v.high, v.low, 1.0]);
            ((high + low) << FRACTION) / one
        };
        let error = |v: f64| {
            let [error, one] = big_integers([v, 1.0]);
            (error << FRACTION) / one + IBig::from(2)
        };
        Sums {
            six_volume: whole(&self.six_volume),
            first: self.first.each_ref().map(whole),
            second: Some(self.second.each_ref().map(whole)),
            errors: self.errors.map(error),
            fraction: FRACTION,
            reference: self.reference,
            unit: self.exponents.map(|e| (IBig::ONE, e)),
        }
    }
}

/// The square root of a positive value.
fn square_root(value: DoubleDouble) -> DoubleDouble {
    let root = value.high.sqrt();
    let rest = value.plus(DoubleDouble::product(root, root).negated());
    DoubleDouble::sum(root, rest.high / (2.0 * root))
}
