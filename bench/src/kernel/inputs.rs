//! The planes that are timed, as plain numbers that every library can take.

use std::f64::consts::{PI, TAU};

/// A half-space `normal·x ≤ offset`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    pub(crate) normal: [f64; 3],
    pub(crate) offset: f64,
}

/// `count` planes tangent to the unit sphere, their normals spread by the golden angle.
///
/// Every plane has a face, and three faces meet at each vertex: by Euler's formula there are `2·count − 4` vertices.
pub(crate) fn fibonacci_sphere(count: usize) -> Vec<Plane> {
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
pub(crate) fn pyramid(sides: usize) -> Vec<Plane> {
    let side = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / sides as f64).sin_cos();
        Plane { normal: [cos, sin, 1.0], offset: 1.0 }
    };
    let base = Plane { normal: [0.0, 0.0, -1.0], offset: 0.0 };
    std::iter::once(base).chain((0..sides).map(side)).collect()
}
