//! The planes that are timed, as plain numbers that every library can take.

use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// A half-space `normal·x ≤ offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Any non-zero length.
    pub normal: [f64; 3],
    /// In the scale of the normal.
    pub offset: f64,
}

/// `count` planes tangent to the unit sphere, their normals spread by the golden angle.
///
/// Every plane has a face, and three faces meet at each vertex: by Euler's formula there are `2·count − 4` vertices.
#[must_use]
pub fn fibonacci_sphere(count: usize) -> Vec<Plane> {
    let golden_angle = PI * (3.0 - 5f64.sqrt());
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let radius = (1.0 - z * z).sqrt();
            let (sin, cos) = (golden_angle * i as f64).sin_cos();
            Plane { normal: [radius * cos, radius * sin, z], offset: 1.0 }
        })
        .collect()
}

/// A pyramid with a regular base: first the base `z ≥ 0`, then `sides` planes that all pass exactly through the apex
/// `(0, 0, 1)`.
#[must_use]
pub fn pyramid(sides: usize) -> Vec<Plane> {
    let side = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / sides as f64).sin_cos();
        Plane { normal: [cos, sin, 1.0], offset: 1.0 }
    };
    let base = Plane { normal: [0.0, 0.0, -1.0], offset: 0.0 };
    std::iter::once(base).chain((0..sides).map(side)).collect()
}

/// A roof in general position over a regular base: first the base `z ≥ 0`, then `sides` planes of random slopes, then a floor
/// below that the sides reach when the base is taken away.
#[must_use]
pub fn roof(sides: usize) -> Vec<Plane> {
    let mut rng = StdRng::seed_from_u64(sides as u64);
    let mut planes = pyramid(sides);
    for plane in &mut planes[1..] {
        // All sides are tangent to the unit circle in the base, so each has an edge with it.
        plane.normal[2] = rng.random_range(0.5..1.5);
    }
    planes.push(Plane { normal: [0.0, 0.0, -1.0], offset: 1e-3 });
    planes
}

/// The cube `|x|, |y|, |z| ≤ half`.
#[must_use]
pub fn cube(half: f64) -> Vec<Plane> {
    let axis = |i: usize, sign: f64| {
        let mut normal = [0.0; 3];
        normal[i] = sign;
        Plane { normal, offset: half }
    };
    (0..3).flat_map(|i| [axis(i, 1.0), axis(i, -1.0)]).collect()
}

/// The cube of half-width 1/2 and a plane that touches its corner (paper: `degenerate_cube_corner_incremental`).
#[must_use]
pub fn cube_with_touched_corner() -> Vec<Plane> {
    let mut planes = cube(0.5);
    planes.push(Plane { normal: [1.0; 3], offset: 1.5 });
    planes
}

/// Two cubes of half-width 1, one turned by 45° around z (paper §5.4, "CSG proxy"); the planes `z = ±1` come twice.
#[must_use]
pub fn two_cubes() -> Vec<Plane> {
    let (s, c) = FRAC_PI_4.sin_cos();
    let mut planes = cube(1.0);
    for normal in [[c, s, 0.0], [-c, -s, 0.0], [-s, c, 0.0], [s, -c, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]] {
        planes.push(Plane { normal, offset: 1.0 });
    }
    planes
}

/// 14 random planes at distances 0.8 to 1.2 (paper §5.4, "Voronoi-cell proxy"), by the generator and the seed of the
/// published benchmark.
#[must_use]
pub fn voronoi_proxy() -> Vec<Plane> {
    let mut rng = StdRng::seed_from_u64(42);
    let mut plane = || {
        let normal = std::array::from_fn(|_| rng.random::<f64>() - 0.5);
        let length = dot(normal, normal).sqrt();
        Plane { normal: normal.map(|v| v / length), offset: 0.8 + rng.random::<f64>() * 0.4 }
    };
    (0..14).map(|_| plane()).collect()
}

/// Planes of a sphere far enough from each other that no two have a neighbour in common, so that removing one does not
/// change what removing another takes; chosen greedily in a random order. About a tenth of all.
#[must_use]
pub fn apart(planes: &[Plane], seed: u64) -> Vec<usize> {
    // Three times the mean distance of neighbours: between neighbours it is at most about 1.3 times the mean.
    let least = 3.0 * (4.0 * PI / planes.len() as f64).sqrt();
    let place = |i: usize| planes[i].normal.map(|v| (v / least).floor() as i32);
    let mut taken: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
    let near = |a: usize, b: usize| {
        let apart: [f64; 3] = std::array::from_fn(|k| planes[a].normal[k] - planes[b].normal[k]);
        dot(apart, apart) < least * least
    };
    let mut chosen = Vec::new();
    for i in shuffled(planes.len(), seed) {
        let [x, y, z] = place(i);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        if !around.filter_map(|at| taken.get(&at)).flatten().any(|other| near(i, *other)) {
            taken.entry([x, y, z]).or_default().push(i);
            chosen.push(i);
        }
    }
    chosen
}

/// Planes of a sphere in an order in which each is near the one before: bands of latitude, to and fro.
#[must_use]
pub fn along_path(planes: &[Plane], mut indices: Vec<usize>) -> Vec<usize> {
    let bands = (indices.len() as f64).sqrt().ceil();
    let key = |i: &usize| {
        let [x, y, z] = planes[*i].normal;
        let band = ((z.clamp(-1.0, 1.0).acos() / PI) * bands).floor();
        let turn = if band % 2.0 == 0.0 { 1.0 } else { -1.0 };
        (band, turn * y.atan2(x))
    };
    indices.sort_by(|a, b| key(a).partial_cmp(&key(b)).expect("no coordinate is NaN"));
    indices
}

/// The `count` planes of a sphere nearest to a random one of them: a connected patch of faces.
#[must_use]
pub fn patch(planes: &[Plane], count: usize, seed: u64) -> Vec<usize> {
    let mut rng = StdRng::seed_from_u64(seed);
    let centre = planes[rng.random_range(0..planes.len())].normal;
    let mut indices: Vec<usize> = (0..planes.len()).collect();
    indices.sort_by(|a, b| dot(planes[*b].normal, centre).total_cmp(&dot(planes[*a].normal, centre)));
    indices.truncate(count);
    indices
}

/// All numbers below `count` in a random order.
#[must_use]
pub fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..count).collect();
    indices.shuffle(&mut StdRng::seed_from_u64(seed));
    indices
}

/// The scalar product.
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
