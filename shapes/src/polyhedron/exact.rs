//! Planes in whole numbers: coordinates times one power of two.

use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest, Gcd};
use planecut_kernel::DVec3;

/// The power of two by which coordinates are multiplied to be whole numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid(i64);

impl Grid {
    pub(crate) fn of(points: &[DVec3]) -> Self {
        let lowest = points.iter().flat_map(|p| p.to_array()).filter(|v| *v != 0.0).map(|v| mantissa(v).1);
        Self(-lowest.min().unwrap_or(0).min(0))
    }

    fn integer(self, v: f64) -> IBig {
        let (mantissa, exponent) = mantissa(v);
        if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << (exponent + self.0) as usize }
    }

    fn integers(self, p: DVec3) -> [IBig; 3] {
        p.to_array().map(|v| self.integer(v))
    }
}

/// A finite number as an odd mantissa and a power of two.
fn mantissa(v: f64) -> (i64, i64) {
    if v == 0.0 {
        return (0, 0);
    }
    let (bits, negative) = (v.abs().to_bits(), v < 0.0);
    let (exponent, fraction) = ((bits >> 52) as i64, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if negative { -odd } else { odd }, exponent + i64::from(zeros))
}

/// The leading bits of an integer and the power of two that they lack; relative error `2⁻⁵²`.
fn leading(v: &IBig) -> (f64, i64) {
    let surplus = (v.bit_len() as i64 - 62).max(0);
    (i64::try_from(v >> surplus as usize).unwrap_or_default() as f64, surplus)
}

/// `numerator / denominator · 2^power`; relative error `2⁻⁵⁰`.
fn quotient(numerator: &IBig, denominator: &IBig, power: i64) -> f64 {
    let ((a, i), (b, j)) = (leading(numerator), leading(denominator));
    let power = (i - j + power).clamp(-1000, 1000) as i32;
    (a / b) * 2f64.powi(power)
}

/// A plane `normal · x = offset`, in units of a [`Grid`].
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    normal: [IBig; 3],
    offset: IBig,
    /// The normal, scaled to a largest component of 1, and the offset in the same scale, with a relative error of `2⁻⁵⁰` each.
    scaled: (DVec3, f64),
}

impl Plane {
    /// The plane through three points, counter-clockwise seen from outside; `None` where they lie on a line.
    pub(crate) fn through(grid: Grid, corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|p| grid.integers(p));
        let from_a = |p: &[IBig; 3]| -> [IBig; 3] { std::array::from_fn(|k| &p[k] - &a[k]) };
        let normal = cross(&from_a(&b), &from_a(&c));
        let largest = normal.iter().map(|v| v.abs()).max()?;
        if largest == IBig::ZERO {
            return None;
        }
        let offset = dot(&normal, &a);
        let unit = normal.each_ref().map(|v| quotient(v, &largest, 0));
        let scaled = (DVec3::from_array(unit), quotient(&offset, &largest, -grid.0));
        Some(Self { normal, offset, scaled })
    }

    /// The half-space below the plane: exact where the coefficients fit, else with the normal rounded and the offset in the
    /// middle of what the given corners of the face ask for.
    pub(crate) fn half_space(&self, grid: Grid, corners: impl Iterator<Item = DVec3>) -> (DVec3, f64) {
        if let Some(exact) = self.representable(grid) {
            return exact;
        }
        let normal = self.scaled.0;
        let heights = corners.map(|p| normal.dot(p));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        (normal, 0.5 * (low + high))
    }

    fn representable(&self, grid: Grid) -> Option<(DVec3, f64)> {
        // offset · 2^-grid, over the same divisor
        let scale = IBig::ONE << grid.0 as usize;
        let all: [IBig; 4] =
            std::array::from_fn(|k| if k < 3 { &self.normal[k] * &scale } else { self.offset.clone() });
        let mut divisor = IBig::ZERO;
        for v in &all {
            divisor = if divisor == IBig::ZERO { v.abs() } else { IBig::from(divisor.gcd(v)) };
        }
        let fits = all.map(|v| {
            let v = v / &divisor;
            let odd = v.trailing_zeros().unwrap_or(0);
            (v.bit_len() - odd <= 53 && v.bit_len() <= 100).then(|| v.to_f64().value())
        });
        let [x, y, z, d] = fits;
        Some((DVec3::new(x?, y?, z?), d?))
    }
}

fn cross(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}
