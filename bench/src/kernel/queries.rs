//! Queries beside parry3d, which has convex polyhedra that do not change: where a shape lies farthest in a direction, whether it
//! contains a point, where a ray meets it and how far a point is. It answers in floating point, planecut exactly and
//! rounded once.

use crate::case::{half_spaces, microseconds};
use crate::plan::Case;
use cpu_time::ThreadTime;
use parry3d_f64::math::Vector;
use parry3d_f64::query::{PointQuery, Ray, RayCast};
use parry3d_f64::shape::{ConvexPolyhedron, SupportMap};
use planecut_bench::inputs::{dot, fibonacci_sphere};
use planecut_bench::library::{Library, Planecut};
use planecut_kernel::{DVec3, IncrementalPolytope, Support};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use std::hint::black_box;

/// The name of parry3d in the report.
pub(crate) const PARRY: &str = "parry3d-f64";
const QUERIES: [&str; 4] = ["support point", "contains", "cast a ray", "distance"];
pub(crate) const MEASURES: &str = "volume, centroid, inertia";
pub(crate) const HULL_BALL: &str = "hull of points in a ball";
pub(crate) const HULL_SPHERE: &str = "hull of points on a sphere";
/// All that is held against parry3d, in the order of the report.
pub(crate) const BESIDE_PARRY: [&str; 7] =
    [QUERIES[0], QUERIES[1], QUERIES[2], QUERIES[3], MEASURES, HULL_BALL, HULL_SPHERE];

/// How many different questions take turns.
const QUESTIONS: usize = 256;
/// How far the answers of both may differ: parry's distances are found by iteration.
const TOLERANCE: f64 = 1e-5;

/// A direction or a point.
type Triple = [f64; 3];
/// One library's answer as a number: what is compared.
type Query<P> = fn(&P, Triple) -> f64;

const OURS: [Query<IncrementalPolytope>; 4] = [
    |polytope, direction| match polytope.support(direction) {
        Some(Support::Vertex { position, .. }) => position.dot(direction.into()),
        _ => f64::NAN,
    },
    |polytope, point| f64::from(u8::from(polytope.contains(point))),
    |polytope, origin| polytope.clip_ray(origin, -DVec3::from(origin)).map_or(f64::NAN, |clipped| clipped.from),
    |polytope, point| polytope.distance(point),
];

const THEIRS: [Query<ConvexPolyhedron>; 4] = [
    |shape, direction| dot(shape.local_support_point(direction.into()).into(), direction),
    |shape, point| f64::from(u8::from(shape.contains_local_point(point.into()))),
    |shape, origin| {
        let ray = Ray::new(origin.into(), -Vector::from(origin));
        shape.cast_local_ray(&ray, f64::MAX, true).unwrap_or(f64::NAN)
    },
    |shape, point| shape.distance_to_local_point(point.into(), true),
];

/// Both libraries, all queries.
///
/// # Errors
/// Answers that differ.
pub(crate) fn cases(quick: bool) -> Result<Vec<Case>, String> {
    let sizes: &[usize] = if quick { &[200] } else { &[30, 200, 2000] };
    let mut cases = Vec::new();
    for &size in sizes {
        let mut polytope = Planecut::build(&half_spaces::<Planecut>(&fibonacci_sphere(size)));
        let corners: Vec<Vector> = polytope.mesh().0.into_iter().map(Vector::from).collect();
        let shape = ConvexPolyhedron::from_convex_hull(&corners).ok_or("parry3d finds no hull")?;
        for (k, name) in QUERIES.into_iter().enumerate() {
            let questions = questions(k);
            same_answers(name, &questions, |q| OURS[k](&polytope.0, q), |q| THEIRS[k](&shape, q))?;
            cases.push(case(name, size, Planecut::NAME, polytope.0.clone(), OURS[k], questions.clone()));
            cases.push(case(name, size, PARRY, shape.clone(), THEIRS[k], questions));
        }
    }
    Ok(cases)
}

/// Directions for the support point; points on both sides of the boundary; for rays toward the centre and for distances points
/// well outside.
fn questions(query: usize) -> Vec<Triple> {
    let mut rng = StdRng::seed_from_u64(query as u64);
    let [least, most] = [[1.0, 1.0], [0.5, 1.5], [2.0, 4.0], [1.5, 4.0]][query];
    let mut question = || {
        let v: Triple = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let length = dot(v, v).sqrt();
        let wanted = if least < most { rng.random_range(least..most) } else { least };
        v.map(|x| x / length * wanted)
    };
    (0..QUESTIONS).map(|_| question()).collect()
}

fn same_answers(
    name: &str,
    questions: &[Triple],
    ours: impl Fn(Triple) -> f64,
    theirs: impl Fn(Triple) -> f64,
) -> Result<(), String> {
    for &question in questions {
        let (a, b) = (ours(question), theirs(question));
        let same = (a - b).abs() <= TOLERANCE;
        if !same {
            return Err(format!("{name} at {question:?}: planecut {a}, {PARRY} {b}"));
        }
    }
    Ok(())
}

fn case<P: 'static>(
    name: &str,
    size: usize,
    library: &'static str,
    shape: P,
    query: Query<P>,
    questions: Vec<Triple>,
) -> Case {
    let sampler = move || {
        let start = ThreadTime::now();
        for question in &questions {
            black_box(query(black_box(&shape), *question));
        }
        Ok(vec![microseconds(start.elapsed(), questions.len())])
    };
    Case::new(name, size, library, Box::new(sampler))
}
