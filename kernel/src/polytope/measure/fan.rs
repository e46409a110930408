//! Sums over tetrahedra in integers, and the tier of small integers.

use std::array::from_fn;
use std::ops::{Add, Mul, Sub};

use dashu_int::{IBig, ops::BitTest};

use super::moments::{PAIRS, Sums};
use crate::double_double::DoubleDouble;
use crate::meet::meet;
use crate::polytope::IncrementalPolytope;
use crate::sign::{big_integers, exact_product};

/// Coordinates in units of at most this many bits keep all sums below 2¹²⁷: products of five, at most 144 of them for each
/// triangle, of at most 2¹⁵ triangles.
const SMALL_BITS: i32 = 20;
const SMALL_TRIANGLES: usize = 1 << 15;

/// `6·∫dV`, `24·∫x dV`, `120·∫x·x dV`.
pub(super) type Totals<I> = (I, [I; 3], [I; 6]);

/// The sums over the fans of all faces, those for `second` only where asked for, `corner` giving the coordinates of a vertex, and the number of triangles.
pub(super) fn fan_sums<'p, I>(
    polytope: &'p IncrementalPolytope,
    with_second: bool,
    corner: impl Fn(u32) -> &'p [I; 3],
) -> (Totals<I>, usize)
where
    I: Default + 'p,
    for<'a> &'a I: Add<&'a I, Output = I> + Sub<&'a I, Output = I> + Mul<&'a I, Output = I>,
{
    let (mut six, mut first, mut second) = (I::default(), from_fn(|_| I::default()), from_fn(|_| I::default()));
    let mut triangles = 0;
    for plane in polytope.face_slots() {
        let mut ring = polytope.vertices.face_ring(plane, polytope.planes.face_vertex(plane)).map(&corner);
        let Some(a) = ring.next() else { continue };
        let Some(mut b) = ring.next() else { continue };
        for c in ring {
            let minor = |u: usize, v: usize| &(&b[u] * &c[v]) - &(&b[v] * &c[u]);
            let det = &(&(&a[0] * &minor(1, 2)) + &(&a[1] * &minor(2, 0))) + &(&a[2] * &minor(0, 1));
            let sum: [I; 3] = from_fn(|k| &(&a[k] + &b[k]) + &c[k]);
            first = from_fn(|k| &first[k] + &(&det * &sum[k]));
            if with_second {
                second = from_fn(|at| {
                    let (i, j) = PAIRS[at];
                    let corners = &(&(&a[i] * &a[j]) + &(&b[i] * &b[j])) + &(&c[i] * &c[j]);
                    &second[at] + &(&det * &(&(&sum[i] * &sum[j]) + &corners))
                });
            }
            six = &six + &det;
            triangles += 1;
            b = c;
        }
    }
    ((six, first, second), triangles)
}

impl IncrementalPolytope {
    /// The exact sums where all corners are small integers in a unit of each axis; a box always is that, where its corners
    /// are numbers at all.
    pub(super) fn small_sums(&self) -> Option<Sums> {
        if 2 * self.vertices.len() > SMALL_TRIANGLES {
            return None;
        }
        let mut corners = vec![[DoubleDouble::default(); 3]; self.vertices.slot_count()];
        let mut reference = None;
        for vertex in self.vertices.slots() {
            let position = self.exact_position(vertex)?;
            let reference: [f64; 3] = *reference.get_or_insert(position);
            corners[vertex as usize] = from_fn(|axis| DoubleDouble::sum(position[axis], -reference[axis]));
        }
        let mut whole = vec![[0i128; 3]; corners.len()];
        let mut unit = from_fn(|_| (IBig::ONE, 0));
        for (axis, unit) in unit.iter_mut().enumerate() {
            *unit = count_in_unit(&corners, axis, &mut whole)?;
        }
        let ((six, first, second), _) = fan_sums(self, true, |vertex| &whole[vertex as usize]);
        Some(Sums {
            six_volume: IBig::from(six),
            first: first.map(IBig::from),
            second: Some(second.map(IBig::from)),
            errors: [IBig::ZERO; 3],
            fraction: 0,
            reference: reference?.into(),
            unit,
        })
    }

    /// The position of a vertex where it can be seen at once that its coordinates are exact.
    fn exact_position(&self, vertex: u32) -> Option<[f64; 3]> {
        let rows = self.vertices.planes(vertex).map(|plane| self.row(plane));
        let point = meet(rows[0], rows[1], rows[2])?.to_array();
        let on_plane = |coefficients: &[f64; 4]| {
            let terms: [(f64, f64); 3] = from_fn(|k| exact_product(coefficients[k], point[k]));
            // two sums of exact terms that are both exact leave no doubt
            let sum = DoubleDouble::sum(terms[0].0, terms[1].0);
            let all = DoubleDouble::sum(sum.high, terms[2].0);
            terms.iter().all(|(_, low)| *low == 0.0) && sum.low == 0.0 && all.low == 0.0 && all.high == coefficients[3]
        };
        rows.into_iter().all(|row| on_plane(row.coefficients())).then_some(point)
    }
}

/// Counts the coordinates of an axis in a positive unit of which all are small multiples: the only one there is besides
/// zero, else a power of two. The unit as `mantissa·2^exponent`.
fn count_in_unit(corners: &[[DoubleDouble; 3]], axis: usize, whole: &mut [[i128; 3]]) -> Option<(IBig, i64)> {
    let values = || corners.iter().map(|corner| corner[axis]);
    let one = values().find(|v| v.high != 0.0)?;
    let is_same = |v: &DoubleDouble| v.high == one.high && v.low == one.low;
    if values().all(|v| v.high == 0.0 || is_same(&v)) {
        let sign = if one.high < 0.0 { -1 } else { 1 };
        for (whole, v) in whole.iter_mut().zip(values()) {
            whole[axis] = if v.high == 0.0 { 0 } else { sign };
        }
        let [high, low] = big_integers([one.high, one.low]);
        // the scale of the two integers, read off the first
        let scale = exponent(one.high) as i64 + 1 - high.bit_len() as i64;
        return (-900..900).contains(&scale).then(|| ((high + low) * IBig::from(sign), scale));
    }
    let (mut largest, mut lowest) = (0.0, i32::MAX);
    for v in values().filter(|v| v.high != 0.0) {
        let mantissa = (v.high.to_bits() & ((1 << 52) - 1)) | (1 << 52);
        (largest, lowest) =
            (f64::max(largest, v.high.abs()), lowest.min(exponent(v.high) - 52 + mantissa.trailing_zeros() as i32));
    }
    let fits = exponent(largest) - lowest < SMALL_BITS && (-900..900).contains(&lowest);
    if !fits || values().any(|v| v.low != 0.0) {
        return None;
    }
    let unit = f64::from_bits(((1023 + lowest) as u64) << 52);
    for (whole, v) in whole.iter_mut().zip(values()) {
        whole[axis] = (v.high / unit) as i128;
    }
    Some((IBig::ONE, i64::from(lowest)))
}

/// `⌊log₂|v|⌋` of a normal number.
pub(super) fn exponent(v: f64) -> i32 {
    ((v.to_bits() >> 52) & 0x7ff) as i32 - 1023
}
