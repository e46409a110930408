//! The tier of wide integers: corners rounded to as many bits as it takes, everything after that exact.

use std::array::from_fn;

use dashu_int::{IBig, UBig, ops::BitTest, ops::SquareRoot};
use glam::DVec3;

use super::moments::{PAIRS, Sums};
use crate::arithmetic::{DoubleDouble, big_integers, exponent, ldexp, round_quotient};
use crate::meet::meet;
use crate::polytope::IncrementalPolytope;
use crate::sign::{homogeneous_exactly, integer_row};

/// Corners as integers in units of `2^(exponent − width)` of each axis, counted from the first of them (rounded).
pub(super) struct WideCorners {
    width: usize,
    exponents: [i64; 3],
    corners: Vec<[IBig; 3]>,
    /// Whether no corner was rounded.
    exact: bool,
    reference: DVec3,
}

impl IncrementalPolytope {
    /// The corners with `width` bits behind the point, the body being about as large as one.
    pub(super) fn wide_corners(&self, width: usize) -> WideCorners {
        let rows = |vertex: u32| self.vertices.planes(vertex).map(|plane| self.row(plane));
        let position = |vertex: u32| {
            let [a, b, c] = rows(vertex);
            meet(a, b, c).expect("the normals at a vertex are independent")
        };
        let reference = self.vertices.slots().next().map_or(DVec3::ZERO, position);
        let mut wide = WideCorners {
            width,
            exponents: [0; 3],
            corners: vec![[IBig::ZERO; 3]; self.vertices.slot_count()],
            exact: true,
            reference,
        };
        let [rx, ry, rz, one] = big_integers([reference.x, reference.y, reference.z, 1.0]);
        let from = [rx, ry, rz];
        let differences: Vec<(u32, [IBig; 3], IBig)> = self
            .vertices
            .slots()
            .map(|vertex| {
                let point = homogeneous_exactly(rows(vertex));
                (vertex, from_fn(|k| &point[k] * &one - &from[k] * &point[3]), &point[3] * &one)
            })
            .collect();
        for axis in 0..3 {
            let sizes = differences.iter().map(|(_, d, w)| round_quotient(d[axis].clone(), w).abs());
            let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
            wide.exponents[axis] = i64::from(exponent(largest)) + 1;
        }
        for (vertex, difference, w) in differences {
            wide.corners[vertex as usize] = from_fn(|axis| {
                let shift = width as i64 - wide.exponents[axis];
                let (numerator, denominator) = if shift >= 0 {
                    (&difference[axis] << shift as usize, w.clone())
                } else {
                    (difference[axis].clone(), &w << (-shift) as usize)
                };
                let quotient = &numerator / &denominator;
                wide.exact &= &quotient * &denominator == numerator;
                quotient
            });
        }
        wide
    }
}

/// Bits of the volume when the sums become double-double numbers: the others are at most 20 times as large.
const SUM_BITS: i64 = 120;

/// `6·∫dV`, `24·∫x dV`, `120·∫x·x dV`.
pub(super) type Totals = (IBig, [IBig; 3], [IBig; 6]);

/// The sums over the fans of all faces, `corner` giving the coordinates of a vertex, and the number of triangles.
pub(super) fn fan_sums<'p>(
    polytope: &'p IncrementalPolytope,
    corner: impl Fn(u32) -> &'p [IBig; 3],
) -> (Totals, usize) {
    let (mut six, mut first, mut second): Totals = Default::default();
    let mut triangles = 0;
    for plane in polytope.face_slots() {
        let mut ring = polytope.vertices.face_ring(plane, polytope.planes.face_vertex(plane)).map(&corner);
        let Some(a) = ring.next() else { continue };
        let Some(mut b) = ring.next() else { continue };
        for c in ring {
            let minor = |u: usize, v: usize| &b[u] * &c[v] - &b[v] * &c[u];
            let det = &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
            let sum: [IBig; 3] = from_fn(|k| &a[k] + &b[k] + &c[k]);
            first = from_fn(|k| &first[k] + &det * &sum[k]);
            second = from_fn(|at| {
                let (i, j) = PAIRS[at];
                let corners = &a[i] * &a[j] + &b[i] * &b[j] + &c[i] * &c[j];
                &second[at] + &det * (&sum[i] * &sum[j] + corners)
            });
            six += det;
            triangles += 1;
            b = c;
        }
    }
    ((six, first, second), triangles)
}

impl WideCorners {
    /// The sums over the tetrahedra, `None` where the volume may be zero for all that these bits tell.
    ///
    /// A coordinate, below `R = 2^width`, is off by less than one. By the product rule a determinant is then off by at most
    /// `18·R²`, its product with the sum of three coordinates by `72·R³`, that with products of two by `360·R⁴`; the bounds
    /// used are twice as large at least.
    pub(super) fn sums(&self, polytope: &IncrementalPolytope) -> Option<Sums> {
        let width = self.width;
        let ((six, first, second), triangles) = fan_sums(polytope, |vertex| &self.corners[vertex as usize]);
        // brought to a volume of SUM_BITS bits with five times `width` bits behind the point
        let six = six << (2 * width);
        let surplus = six.bit_len() as i64 - SUM_BITS;
        let brought = |value: IBig| if surplus >= 0 { value >> surplus as usize } else { value << (-surplus) as usize };
        let error = |factor: usize, power: usize| {
            let error = if self.exact { IBig::ZERO } else { IBig::from(factor * triangles) << (power * width) };
            whole(&(brought(error) + IBig::from(2))).map(|error| error.high)
        };
        let number = |value: IBig| whole(&brought(value));
        let [x, y, z] = first.map(|v| number(v << width));
        let [xx, yy, zz, yz, zx, xy] = second.map(number);
        Some(Sums {
            six_volume: number(six)?,
            first: [x?, y?, z?],
            second: [xx?, yy?, zz?, yz?, zx?, xy?],
            errors: [error(64, 4)?, error(256, 4)?, error(1024, 4)?],
            exponent: surplus - 5 * width as i64,
            reference: self.reference,
            units: self.exponents,
        })
    }

    /// The area of one face, or of all; `None` where it is not certain to within half a unit in its last place.
    pub(super) fn area(&self, polytope: &IncrementalPolytope, only: Option<u32>) -> Option<f64> {
        let width = self.width;
        let largest = self.exponents.into_iter().max().unwrap_or(0);
        let (mut total, mut total_error) = (IBig::ZERO, IBig::ZERO);
        for plane in polytope.face_slots().filter(|plane| only.is_none_or(|only| only == *plane)) {
            let row = integer_row(polytope.row(plane));
            // the projection along the normal's largest component, in the units of the axes
            let lowest = self.exponents.into_iter().min().unwrap_or(0);
            let sizes: [UBig; 3] = from_fn(|k| row[k].clone().into_parts().1 << (self.exponents[k] - lowest) as usize);
            let k = (0..3).max_by(|a, b| sizes[*a].cmp(&sizes[*b])).unwrap_or(0);
            let (u, v) = ((k + 1) % 3, (k + 2) % 3);
            let (twice, error) = self.projected(polytope, plane, u, v);
            let square = &row[0] * &row[0] + &row[1] * &row[1] + &row[2] * &row[2];
            let (square, along): (UBig, UBig) = (square.into_parts().1, row[k].clone().into_parts().1);
            // |n| / |n_k| with `width` bits behind the point
            let factor = IBig::from(((square << (2 * width)) / (&along * &along)).sqrt());
            let shift = (2 * largest - self.exponents[u] - self.exponents[v]) as usize + width;
            total_error += (((error + IBig::ONE) * (&factor + IBig::ONE) + &twice) >> shift) + IBig::from(3);
            total += (twice * factor) >> shift;
        }
        if (total_error << 55usize) > total {
            return None;
        }
        // brought into the range of numbers: these bits are more than enough for one rounding
        let surplus = total.bit_len().saturating_sub(SUM_BITS as usize);
        let twice = round_quotient(total >> surplus, &IBig::ONE);
        Some(ldexp(twice, 2 * largest - 2 * width as i64 + surplus as i64 - 1))
    }

    /// Twice the area of a face's projection onto the axes `u`, `v`, and a bound of its error.
    fn projected(&self, polytope: &IncrementalPolytope, plane: u32, u: usize, v: usize) -> (IBig, IBig) {
        let corner = |vertex: u32| &self.corners[vertex as usize];
        let mut ring = polytope.vertices.face_ring(plane, polytope.planes.face_vertex(plane)).map(corner);
        let (mut twice, mut triangles) = (IBig::ZERO, 0usize);
        if let (Some(a), Some(mut b)) = (ring.next(), ring.next()) {
            for c in ring {
                twice += (&b[u] - &a[u]) * (&c[v] - &a[v]) - (&b[v] - &a[v]) * (&c[u] - &a[u]);
                triangles += 1;
                b = c;
            }
        }
        let error = if self.exact { IBig::ZERO } else { IBig::from(32 * triangles) << self.width };
        (IBig::from(twice.into_parts().1), error)
    }
}

/// An integer of at most 127 bits, off by less than `2⁻¹⁰⁴` of itself.
fn whole(value: &IBig) -> Option<DoubleDouble> {
    let value = i128::try_from(value).ok()?;
    let high = value as f64;
    Some(DoubleDouble::sum(high, (value - high as i128) as f64))
}
