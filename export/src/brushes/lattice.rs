//! Planes through points of a decimal grid.
//!
//! A plane whose coefficients are whole numbers, up to a common factor, and not too large ones, holds points of the grid of
//! whole numbers, or of that of tenths, and so on, as far as the offset allows. Three such points say the plane exactly, which
//! its corners, rounded, do not: these seldom are on the grid, even where three planes of whole numbers meet.

use glam::DVec3;
use planecut_kernel::decompose_odd;

/// Largest normal. Below it the products in [`basis`] fit 128 bits: with components up to `2^30` the second vector has some of
/// up to `2^60`, and products of two such, summed, stay below `2^122`.
const MAX_NORMAL: i128 = 1 << 30;
/// Coordinates of fewer digits than this are whole numbers as `f64`, and print as themselves with a point anywhere.
const MAX_COORDINATE: f64 = 1e15;

/// A plane `normal · x = offset` of whole numbers, the normal without a common factor.
pub(super) struct IntegerPlane {
    normal: [i128; 3],
    /// The offset as a fraction.
    offset: [i128; 2],
    /// A basis of the points with `normal · x = 0`, as short as can be, the shorter one first, right-handed about the normal.
    basis: [[i128; 3]; 2],
    /// A point with `normal · x = 1`.
    unit: [i128; 3],
}

/// A plane's points on the grid of `10^-places`.
pub(super) struct Lattice<'a> {
    plane: &'a IntegerPlane,
    /// `10^places`.
    unit: f64,
    /// The offset, in steps of the grid.
    offset: i128,
}

impl IntegerPlane {
    /// `None` where the normal is none of not too large whole numbers.
    pub(super) fn new(normal: DVec3, offset: f64) -> Option<Self> {
        let parts = normal.to_array().map(decompose_odd);
        let lowest = parts.iter().filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| *exponent).min()?;
        let mut integers = [0; 3];
        for (integer, (mantissa, exponent)) in integers.iter_mut().zip(parts) {
            *integer = shifted(mantissa.into(), if mantissa == 0 { 0 } else { exponent - lowest })?;
        }
        let divisor = integers.into_iter().fold(0, gcd);
        let normal = integers.map(|v| v / divisor);
        if normal.iter().any(|v| v.abs() > MAX_NORMAL) {
            return None;
        }
        let (mantissa, exponent) = decompose_odd(offset);
        let shift = if mantissa == 0 { 0 } else { exponent - lowest };
        let offset = [shifted(mantissa.into(), shift.max(0))?, shifted(divisor, (-shift).max(0))?];
        let (basis, unit) = basis(normal);
        Some(Self { normal, offset, basis, unit })
    }

    /// Its points on the grid of `10^-places`; `None` where it has none.
    pub(super) fn lattice(&self, places: u32) -> Option<Lattice<'_>> {
        let unit = 10_i128.pow(places);
        let [over, under] = self.offset;
        let over = over.checked_mul(unit)?;
        (over % under == 0).then(|| Lattice { plane: self, unit: unit as f64, offset: over / under })
    }
}

impl Lattice<'_> {
    /// The grid point that a point is but for noise, where that is on the plane.
    pub(super) fn at(&self, point: DVec3) -> Option<DVec3> {
        const NOISE: f64 = 1e-6;
        let scaled = point * self.unit;
        let nearest = to_grid(scaled)?;
        let is_near = (scaled - scaled.round()).abs().max_element() <= NOISE;
        (is_near && dot(self.plane.normal, nearest) == self.offset).then(|| self.to_point(nearest))
    }

    /// The length of the longer of the two shortest steps in different directions.
    pub(super) fn step(&self) -> f64 {
        length(self.plane.basis[1]) / self.unit
    }

    /// A point near to a given one, and two more, about as far away as asked for in different directions; seen from outside, the
    /// turn from first to last is counter-clockwise. `None` where coordinates have too many digits.
    pub(super) fn points(&self, near: DVec3, apart: f64) -> Option<[DVec3; 3]> {
        let start = to_grid(near * self.unit)?;
        // |n · start| < 3 · 2^80, so that with a unit of at most about 2^60 the product fits
        let missing = self.offset.checked_sub(dot(self.plane.normal, start))?;
        let mut way = [0; 3];
        for (way, unit) in way.iter_mut().zip(self.plane.unit) {
            *way = unit.checked_mul(missing)?;
        }
        let way = reduced(way, &self.plane.basis);
        let first: [i128; 3] = std::array::from_fn(|k| start[k] + way[k]);
        let [second, third] = self.plane.basis.map(|step| {
            let times = (apart * self.unit / length(step)).round().clamp(1.0, 1e9) as i128;
            std::array::from_fn(|k| first[k] + times * step[k])
        });
        let fits = |point: &[i128; 3]| point.iter().all(|v| (v.abs() as f64) < MAX_COORDINATE);
        [first, second, third].iter().all(fits).then(|| [first, second, third].map(|point| self.to_point(point)))
    }

    /// Each quotient is rounded once, to the `f64` that prints as this very decimal.
    fn to_point(&self, grid: [i128; 3]) -> DVec3 {
        DVec3::from_array(grid.map(|v| v as f64)) / self.unit
    }
}

fn to_grid(scaled: DVec3) -> Option<[i128; 3]> {
    (scaled.abs().max_element() < MAX_COORDINATE).then(|| scaled.to_array().map(|v| v.round() as i128))
}

/// A basis of the whole points of the plane through the origin, right-handed about its normal and reduced, the shorter vector
/// first, and a whole point with `normal · x = 1`.
fn basis(normal: [i128; 3]) -> ([[i128; 3]; 2], [i128; 3]) {
    let [a, b, c] = normal;
    let (g, s, t) = extended_gcd(a, b);
    let (mut u, mut v) = if g == 0 { ([1, 0, 0], [0, 1, 0]) } else { ([b / g, -a / g, 0], [-s * c, -t * c, g]) };
    // Gauss: take from the longer one what it has of the shorter one
    loop {
        if dot(u, u) > dot(v, v) {
            (u, v) = (v, u);
        }
        let (along, square) = (dot(u, v), dot(u, u));
        let times = (2 * along + square).div_euclid(2 * square);
        if times == 0 {
            break;
        }
        v = std::array::from_fn(|k| v[k] - times * u[k]);
    }
    let across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    if dot(across, normal) < 0 {
        v = v.map(|value| -value);
    }
    let (one, p, q) = extended_gcd(g, c);
    debug_assert_eq!(one, 1, "the normal has no common factor");
    let unit = reduced([s * p, t * p, q], &[u, v]);
    ([u, v], unit)
}

/// What is left of a vector when whole multiples of a reduced basis are taken away so that it is nearly across them.
fn reduced(mut vector: [i128; 3], [u, v]: &[[i128; 3]; 2]) -> [i128; 3] {
    let [uf, vf] = [u, v].map(|w| DVec3::from_array(w.map(|v| v as f64)));
    let (uu, uv, vv) = (uf.dot(uf), uf.dot(vf), vf.dot(vf));
    let determinant = uu * vv - uv * uv;
    // Each round is exact but for the choice of the multiples, which leaves some 2^-40 of the vector.
    for _ in 0..8 {
        let w = DVec3::from_array(vector.map(|v| v as f64));
        let (wu, wv) = (w.dot(uf), w.dot(vf));
        let (i, j) = (((wu * vv - wv * uv) / determinant).round(), ((wv * uu - wu * uv) / determinant).round());
        if i == 0.0 && j == 0.0 {
            break;
        }
        vector = std::array::from_fn(|k| vector[k] - i as i128 * u[k] - j as i128 * v[k]);
    }
    vector
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(vector: [i128; 3]) -> f64 {
    DVec3::from_array(vector.map(|v| v as f64)).length()
}

/// The greatest common divisor, not negative; that of 0 and `v` is `|v|`.
fn gcd(a: i128, b: i128) -> i128 {
    extended_gcd(a, b).0
}

/// The greatest common divisor `g ≥ 0` and two numbers, as `a s + b t = g`.
fn extended_gcd(a: i128, b: i128) -> (i128, i128, i128) {
    let (mut r, mut s, mut t) = ((a, b), (1, 0), (0, 1));
    while r.1 != 0 {
        let quotient = r.0 / r.1;
        r = (r.1, r.0 - quotient * r.1);
        s = (s.1, s.0 - quotient * s.1);
        t = (t.1, t.0 - quotient * t.1);
    }
    if r.0 < 0 { (-r.0, -s.0, -t.0) } else { (r.0, s.0, t.0) }
}

/// `mantissa · 2^shift`, where that has at most 100 bits: then it can be multiplied by a million.
fn shifted(mantissa: i128, shift: i32) -> Option<i128> {
    let bits = i128::BITS - mantissa.unsigned_abs().leading_zeros();
    let shift = u32::try_from(shift).ok()?;
    (bits.checked_add(shift)? <= 100).then(|| mantissa << shift)
}
