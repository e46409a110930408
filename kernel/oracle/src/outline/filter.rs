//! Signs of determinants of plane rows: in floating point where the error bound allows, else by big integers.

use std::array::from_fn;
use std::cell::OnceCell;
use std::collections::BTreeSet;

use dashu_int::{IBig, ops::BitTest};

use super::Points;
use crate::exact::{cross, dot, normal, sign};

/// Relative error of a 4×4 determinant in units of its permanent, both as computed here: no term passes more than 14
/// roundings of `2⁻⁵³`, the permanent's terms neither, and a factor of 4 is left.
const BOUND: f64 = 1.0 / (1u64 << 47) as f64;

/// Where the permanent of integer rows stays below this, every intermediate value is an exact integer.
const EXACT: f64 = (1u64 << 53) as f64;

/// The rows of a list of planes.
pub(super) struct Rows {
    pub(super) exact: Vec<[IBig; 4]>,
    normals: Vec<[IBig; 3]>,
    /// `exact` up to one positive factor per row, without rounding; `None` where that does not fit.
    approximate: Option<Vec<[f64; 4]>>,
    /// All of `approximate` are integers.
    integer: bool,
}

/// The meeting point of three planes, homogeneous with `W > 0`.
struct Point {
    planes: [usize; 3],
    value: [f64; 4],
    permanent: [f64; 4],
    exact: OnceCell<([IBig; 3], IBig)>,
}

impl Rows {
    pub(super) fn new(exact: Vec<[IBig; 4]>) -> Self {
        let normals = exact.iter().map(normal).collect();
        let bits = |row: &[IBig; 4]| row.iter().map(IBig::bit_len).max().unwrap_or(0);
        let integer = exact.iter().all(|row| bits(row) <= 40);
        let approximate = exact.iter().map(|row| if integer { as_floats(row, 0) } else { scaled(row) }).collect();
        Self { exact, normals, approximate, integer }
    }

    pub(super) fn len(&self) -> usize {
        self.exact.len()
    }

    /// The vertices with the planes through them; `None` where no three normals are independent.
    pub(super) fn vertices(&self) -> Option<Points> {
        let n = self.len();
        let (mut found, mut full_rank) = (Points::new(), false);
        // the plane that cut off the last candidate is asked first
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            for j in 0..k {
                for i in 0..j {
                    let Some(point) = self.point([i, j, k]) else { continue };
                    full_rank = true;
                    if let Some(planes) = self.planes_through(&point, &mut order) {
                        found.entry(planes).or_insert_with(|| self.exact_point(&point).clone());
                    }
                }
            }
        }
        full_rank.then_some(found)
    }

    /// The planes along each extreme direction of the recession cone; the rank of the normals must be 3.
    pub(super) fn directions(&self) -> BTreeSet<Vec<usize>> {
        let n = self.len();
        let mut found = BTreeSet::new();
        for i in 0..n {
            for j in (0..n).filter(|j| *j != i) {
                let signs: Vec<i32> = (0..n).map(|h| self.orientation([h, i, j])).collect();
                // where the direction is not zero, some normal leaves the plane of the two
                if signs.contains(&-1) && !signs.contains(&1) {
                    found.insert((0..n).filter(|h| signs[*h] == 0).collect());
                }
            }
        }
        found
    }

    /// The planes through a point that violates none.
    fn planes_through(&self, point: &Point, order: &mut [usize]) -> Option<Vec<usize>> {
        let mut through = point.planes.to_vec();
        for at in 0..order.len() {
            let h = order[at];
            if point.planes.contains(&h) {
                continue;
            }
            match self.side(point, h) {
                1 => {
                    order[..=at].rotate_right(1);
                    return None;
                }
                0 => through.push(h),
                _ => {}
            }
        }
        through.sort_unstable();
        Some(through)
    }

    /// Sign of the determinant of three normals.
    fn orientation(&self, [a, b, c]: [usize; 3]) -> i32 {
        let filtered = self.approximate.as_ref().and_then(|rows| {
            let (bc, size) = cross_with_permanent(&rows[b], &rows[c]);
            let value: f64 = (0..3).map(|i| rows[a][i] * bc[i]).sum();
            let permanent: f64 = (0..3).map(|i| rows[a][i].abs() * size[i]).sum();
            self.certain(value, permanent)
        });
        filtered.unwrap_or_else(|| sign(&dot(&self.normals[a], &cross(&self.normals[b], &self.normals[c]))))
    }

    /// Where three planes meet in one point.
    fn point(&self, planes: [usize; 3]) -> Option<Point> {
        let orientation = f64::from(self.orientation(planes));
        if orientation == 0.0 {
            return None;
        }
        let (mut value, mut permanent) = ([0.0; 4], [0.0; 4]);
        if let Some(rows) = &self.approximate {
            let [a, b, c] = planes.map(|p| &rows[p]);
            for (first, second, offset, row) in [(b, c, a[3], Some(a)), (c, a, b[3], None), (a, b, c[3], None)] {
                let (v, size) = cross_with_permanent(first, second);
                for i in 0..3 {
                    value[i] += offset * v[i];
                    permanent[i] += offset.abs() * size[i];
                    if let Some(row) = row {
                        value[3] += row[i] * v[i];
                        permanent[3] += row[i].abs() * size[i];
                    }
                }
            }
        }
        Some(Point { planes, value: value.map(|v| v * orientation), permanent, exact: OnceCell::new() })
    }

    /// On which side of plane `h` a point lies: 1 is outside.
    fn side(&self, point: &Point, h: usize) -> i32 {
        let filtered = self.approximate.as_ref().and_then(|rows| {
            let row = &rows[h];
            let signed = |i: usize| if i == 3 { -row[3] } else { row[i] };
            let value: f64 = (0..4).map(|i| signed(i) * point.value[i]).sum();
            let permanent: f64 = (0..4).map(|i| row[i].abs() * point.permanent[i]).sum();
            self.certain(value, permanent)
        });
        filtered.unwrap_or_else(|| {
            let (position, w) = self.exact_point(point);
            sign(&(dot(&self.normals[h], position) - &self.exact[h][3] * w))
        })
    }

    fn exact_point<'a>(&self, point: &'a Point) -> &'a ([IBig; 3], IBig) {
        point.exact.get_or_init(|| {
            let [a, b, c] = point.planes.map(|p| &self.normals[p]);
            let [da, db, dc] = point.planes.map(|p| &self.exact[p][3]);
            let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
            let w = dot(a, &bc);
            let orientation = sign(&w);
            (from_fn(|i| (da * &bc[i] + db * &ca[i] + dc * &ab[i]) * orientation), w * orientation)
        })
    }

    /// The sign of a value with this permanent, where it is certain.
    fn certain(&self, value: f64, permanent: f64) -> Option<i32> {
        if value.abs() > BOUND * permanent || self.integer && permanent < EXACT {
            return Some(if value > 0.0 { 1 } else { -i32::from(value < 0.0) });
        }
        None
    }
}

/// `a × b` of two rows' normals, and the same with all signs positive.
fn cross_with_permanent(a: &[f64; 4], b: &[f64; 4]) -> ([f64; 3], [f64; 3]) {
    let pairs = [(1, 2), (2, 0), (0, 1)];
    (pairs.map(|(j, k)| a[j] * b[k] - a[k] * b[j]), pairs.map(|(j, k)| (a[j] * b[k]).abs() + (a[k] * b[j]).abs()))
}

/// The row times a power of two that brings the largest component of its normal between 1/2 and 1. `None` where a
/// coefficient has more than 53 bits or lies outside `2^±201`, so that products of five could leave the normal range.
fn scaled(row: &[IBig; 4]) -> Option<[f64; 4]> {
    let size = row[..3].iter().map(IBig::bit_len).max().unwrap_or(0);
    as_floats(row, -(size as i32))
        .filter(|floats| floats.iter().all(|v| *v == 0.0 || (-201.0..=201.0).contains(&v.abs().log2())))
}

/// The row times `2^power`, exactly.
fn as_floats(row: &[IBig; 4], power: i32) -> Option<[f64; 4]> {
    let mut floats = [0.0; 4];
    for (float, value) in floats.iter_mut().zip(row) {
        let zeros = value.trailing_zeros().unwrap_or(0);
        let odd = i64::try_from(value >> zeros).ok().filter(|odd| odd.unsigned_abs() < 1 << 53)?;
        *float = odd as f64 * 2f64.powi(zeros as i32 + power);
    }
    Some(floats)
}
