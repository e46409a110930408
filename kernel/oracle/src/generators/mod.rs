//! Planes, alone and in families, most of them leaning toward degeneracy.

pub mod solids;

use std::f64::consts::TAU;

use crate::exact::Coefficients;
use crate::random::Rng;

/// `[nx, ny, nz, d]`.
#[must_use]
pub fn plane(n: [f64; 3], d: f64) -> Coefficients {
    [n[0], n[1], n[2], d]
}

/// `a · b`, rounded.
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The other side of the same plane.
#[must_use]
pub fn flipped(c: Coefficients) -> Coefficients {
    c.map(|v| -v)
}

/// No symmetry, no coincidence.
pub fn generic(rng: &mut Rng) -> Coefficients {
    plane(rng.direction(), rng.float(-0.02, 1.0))
}

/// Tangent to the unit sphere at point `k` of `n` of a Fibonacci spiral.
#[must_use]
pub fn fibonacci(k: usize, n: usize) -> Coefficients {
    let z = 1.0 - (2 * k + 1) as f64 / n as f64;
    let radius = (1.0 - z * z).sqrt();
    let angle = k as f64 * TAU * 0.618_033_988_749_894_9;
    plane([radius * angle.cos(), radius * angle.sin(), z], 1.0)
}

/// Small integers; the origin is nearly always inside.
pub fn grid(rng: &mut Rng, reach: i64) -> Coefficients {
    let low = if rng.chance(0.05) { -1 } else { 1 };
    plane(rng.lattice(reach), rng.whole(low, 2 * reach))
}

/// The six planes of the box `[-half, half]³`, in random order.
pub fn cube(rng: &mut Rng, half: f64) -> Vec<Coefficients> {
    let mut planes: Vec<Coefficients> = (0..6)
        .map(|k| {
            let mut c = [0.0, 0.0, 0.0, half];
            c[k / 2] = if k % 2 == 0 { 1.0 } else { -1.0 };
            c
        })
        .collect();
    rng.shuffle(&mut planes);
    planes
}

/// Four planes around the origin, with small integers.
pub fn simplex(rng: &mut Rng, half: f64) -> Vec<Coefficients> {
    let mut planes: Vec<Coefficients> =
        [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]].map(|n| plane(n, half)).to_vec();
    rng.shuffle(&mut planes);
    planes
}

/// A box, or where there is little room a simplex.
pub fn container(rng: &mut Rng, capacity: usize, half: f64) -> Vec<Coefficients> {
    if capacity < 12 || rng.chance(0.3) { simplex(rng, half) } else { cube(rng, half) }
}

/// All normals in one plane: spanned by two integer vectors, or by `x` and `y` with floats.
pub fn prism_side(rng: &mut Rng, span: Option<[[f64; 3]; 2]>) -> Coefficients {
    let Some([a, b]) = span else {
        let angle = rng.float(0.0, TAU);
        return plane([angle.cos(), angle.sin(), 0.0], 1.0);
    };
    loop {
        let (s, t) = (rng.whole(-3, 3), rng.whole(-3, 3));
        let n: [f64; 3] = std::array::from_fn(|i| s * a[i] + t * b[i]);
        if n != [0.0; 3] {
            let low = if rng.chance(0.1) { -1 } else { 1 };
            return plane(n, rng.whole(low, 6));
        }
    }
}

/// Through an integer point, exactly; nearly always with `point - axis` inside.
pub fn through(rng: &mut Rng, point: [f64; 3], axis: [f64; 3]) -> Coefficients {
    let n = rng.lattice(3);
    let n = if dot(n, axis) < 0.0 && rng.chance(0.98) { n.map(|v| -v) } else { n };
    plane(n, dot(n, point))
}

/// A plane or its opposite from a few directions: slabs without thickness, touching sets.
pub fn thin(rng: &mut Rng) -> Coefficients {
    let n = rng.pick(&[
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [1.0, 1.0, 1.0],
        [2.0, -1.0, 0.0],
    ]);
    let d = if rng.chance(0.1) { rng.whole(-1, 0) } else { rng.whole(1, 2) };
    let n = if rng.chance(0.5) { n } else { n.map(|v| -v) };
    if rng.chance(0.05) { plane(n, -1.0) } else { plane(n, d) }
}

/// Copies, scaled copies and opposites of a small pool.
pub fn copy_of(rng: &mut Rng, pool: &[Coefficients]) -> Coefficients {
    let c = rng.pick(pool);
    match rng.below(40) {
        0..=14 => c,
        15..=28 => c.map(|v| v * 2.0),
        29..=33 => c.map(|v| v * 0.1),
        34..=38 => plane([c[0], c[1], c[2]], rng.nudge(c[3], 1)),
        _ => flipped(c),
    }
}

/// Normals within `width` of the z axis, tangent to nearly the same point.
pub fn near_parallel(rng: &mut Rng, width: f64) -> Coefficients {
    let tilt = rng.direction();
    plane([width * tilt[0], width * tilt[1], 1.0], 1.0 + width * rng.float(-1.0, 1.0))
}

/// Shape of a ring of `n` sides around the z axis.
#[derive(Debug, Clone, Copy)]
pub struct Ring {
    /// Number of sides.
    pub sides: usize,
    /// z component of the side normals: 0 a prism, positive a pyramid that closes upward.
    pub slope: f64,
    /// Random change of each offset; with 0 the sides of a pyramid meet in one point exactly.
    pub jitter: f64,
    /// Side normals with small integers instead of sines and cosines.
    pub whole: bool,
}

impl Ring {
    /// The sides in random order.
    pub fn planes(self, rng: &mut Rng) -> Vec<Coefficients> {
        let mut sides: Vec<Coefficients> = (0..self.sides)
            .map(|k| {
                let angle = TAU * k as f64 / self.sides as f64;
                let size = if self.whole { 12.0 } else { 1.0 };
                let exact = |v: f64| if self.whole { (size * v).round() } else { v };
                let n = [exact(angle.cos()), exact(angle.sin()), size * self.slope];
                // At slope s the sides meet in (0, 0, 1 / s).
                plane(n, size * (1.0 + self.jitter * rng.float(-1.0, 1.0)))
            })
            .collect();
        rng.shuffle(&mut sides);
        sides
    }
}

/// Each coefficient with an exponent of its own, up to where products still fit the accepted range.
pub fn mixed_exponents(rng: &mut Rng) -> Coefficients {
    let scale = rng.integer(-300, 300);
    let mut part = |low: i64, high: i64| {
        let mantissa = if rng.chance(0.5) { 1.0 } else { rng.float(1.0, 2.0) };
        rng.pick(&[1.0, -1.0]) * mantissa * 2f64.powi(rng.integer(low, high) as i32)
    };
    let mut n: [f64; 3] = std::array::from_fn(|_| part(-90, 0));
    let d = part(-90, 90).abs();
    n[rng.below(3)] = rng.pick(&[1.0, -1.0]);
    plane(n, d).map(|v| v * 2f64.powi(scale as i32))
}
