//! Hulls of points and the measures of a body beside parry3d, which has both in floating point.

use crate::case::{half_spaces, microseconds};
use crate::plan::Case;
use crate::queries::{HULL_BALL, HULL_SPHERE, MEASURES, PARRY};
use cpu_time::ThreadTime;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{ConvexPolyhedron, Shape};
use planecut_bench::inputs::{dot, fibonacci_sphere};
use planecut_bench::library::{Library, Planecut};
use planecut_kernel::{DVec3, hull};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use std::hint::black_box;

/// How far the volumes of both may differ, relative: parry3d leaves out points of a hull that hardly reach out.
const TOLERANCE: f64 = 1e-6;

/// Both libraries, points in a ball and on a sphere; the measures of spheres of planes.
///
/// # Errors
/// Volumes that differ.
pub(crate) fn cases(quick: bool) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    let sizes: &[usize] = if quick { &[1000] } else { &[100, 1000, 10_000] };
    for &size in sizes {
        for (name, on_sphere) in [(HULL_BALL, false), (HULL_SPHERE, true)] {
            let points = points(size, on_sphere);
            let ours = || hull(&points).map_err(|error| error.to_string());
            let theirs = || ConvexPolyhedron::from_convex_hull(&vectors(&points)).ok_or("parry3d finds no hull");
            let volume = ours()?.measures().ok_or("a hull is bounded")?.volume;
            same_volume(name, volume, theirs()?.mass_properties(1.0).mass())?;
            let points_of_ours = points.clone();
            cases.push(case(name, size, Planecut::NAME, move || _ = black_box(hull(&points_of_ours))));
            let points = vectors(&points);
            cases.push(case(name, size, PARRY, move || _ = black_box(ConvexPolyhedron::from_convex_hull(&points))));
        }
    }
    let sizes: &[usize] = if quick { &[200] } else { &[30, 200, 2000] };
    for &size in sizes {
        let mut polytope = Planecut::build(&half_spaces::<Planecut>(&fibonacci_sphere(size)));
        let corners: Vec<Vector> = polytope.mesh().0.into_iter().map(Vector::from).collect();
        let shape = ConvexPolyhedron::from_convex_hull(&corners).ok_or("parry3d finds no hull")?;
        let volume = polytope.0.measures().ok_or("a sphere is bounded")?.volume;
        same_volume(MEASURES, volume, shape.mass_properties(1.0).mass())?;
        cases.push(case(MEASURES, size, Planecut::NAME, move || _ = black_box(polytope.0.measures())));
        cases.push(case(MEASURES, size, PARRY, move || _ = black_box(shape.mass_properties(1.0))));
    }
    Ok(cases)
}

fn vectors(points: &[DVec3]) -> Vec<Vector> {
    points.iter().map(|point| point.to_array().into()).collect()
}

/// Points of the unit ball, or of its surface.
fn points(count: usize, on_sphere: bool) -> Vec<DVec3> {
    let mut rng = StdRng::seed_from_u64(count as u64);
    let mut points = Vec::with_capacity(count);
    while points.len() < count {
        let v: [f64; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let length = dot(v, v).sqrt();
        if (0.1..1.0).contains(&length) {
            points.push(DVec3::from(v) / if on_sphere { length } else { 1.0 });
        }
    }
    points
}

fn same_volume(name: &str, ours: f64, theirs: f64) -> Result<(), String> {
    let same = (ours - theirs).abs() <= TOLERANCE * ours;
    if same { Ok(()) } else { Err(format!("{name}: volume {ours} by planecut, {theirs} by {PARRY}")) }
}

fn case(name: &str, size: usize, library: &'static str, mut run: impl FnMut() + 'static) -> Case {
    let sampler = move || {
        let start = ThreadTime::now();
        run();
        Ok(vec![microseconds(start.elapsed(), 1)])
    };
    Case::new(name, size, library, Box::new(sampler))
}
