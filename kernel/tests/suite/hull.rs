//! Hulls of points against brute force in exact arithmetic: every plane through three points with all others on one side.
//!
//! `PLANECUT_SEED` sets the first seed; a failing set of points is printed as Rust.

use std::collections::BTreeSet;

use dashu_ratio::RBig;
use planecut_kernel::{DVec3, HullError, IncrementalPolytope, approximate_hull_triangles, hull, hull_triangles};
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

type Vector = [RBig; 3];

fn exactly(p: &DVec3) -> Vector {
    p.to_array().map(|v| RBig::try_from(v).expect("finite"))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| {
        let (u, v) = ((k + 1) % 3, (k + 2) % 3);
        &a[u] * &b[v] - &a[v] * &b[u]
    })
}

fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn is_zero(v: &Vector) -> bool {
    v.iter().all(|c| *c == RBig::ZERO)
}

/// Each facet as the set of all points on it; and the dimension of the hull.
fn brute_force(points: &[Vector]) -> (BTreeSet<Vec<usize>>, usize) {
    let mut facets = BTreeSet::new();
    let mut dimension = 0;
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            if points[i] != points[j] {
                dimension = dimension.max(1);
            }
            for k in j + 1..points.len() {
                let normal = cross(&minus(&points[j], &points[i]), &minus(&points[k], &points[i]));
                if is_zero(&normal) {
                    continue;
                }
                dimension = dimension.max(2);
                let sides: Vec<RBig> = points.iter().map(|p| dot(&normal, &minus(p, &points[i]))).collect();
                let (above, below) = (sides.iter().any(|s| *s > RBig::ZERO), sides.iter().any(|s| *s < RBig::ZERO));
                if above || below {
                    dimension = 3;
                }
                if above != below {
                    facets.insert((0..points.len()).filter(|p| sides[*p] == RBig::ZERO).collect());
                }
            }
        }
    }
    (facets, dimension)
}

/// Points on three facets that share no other distinct point are the vertices; copies count once.
fn vertex_count(points: &[Vector], facets: &BTreeSet<Vec<usize>>) -> usize {
    let mut vertices: Vec<&Vector> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        let around: Vec<&Vec<usize>> = facets.iter().filter(|facet| facet.contains(&i)).collect();
        let shared = (0..points.len()).filter(|p| around.iter().all(|facet| facet.contains(p)));
        if !around.is_empty() && shared.into_iter().all(|p| points[p] == *point) && !vertices.contains(&point) {
            vertices.push(point);
        }
    }
    vertices.len()
}

fn some_points(rng: &mut Rng, kind: u64) -> Vec<DVec3> {
    let count = 1 + rng.below(12);
    let mut points: Vec<DVec3> = (0..count)
        .map(|_| {
            DVec3::from_array(match kind % 6 {
                0 => [rng.whole(0, 2), rng.whole(0, 2), rng.whole(0, 2)],
                1 => [rng.whole(0, 3), rng.whole(0, 1), rng.whole(0, 3)].map(|v| v * 0.1),
                2 => [rng.whole(0, 1), rng.whole(0, 1), 0.5],
                3 => [rng.float(-1.0, 1.0), rng.float(-1.0, 1.0), rng.float(-1.0, 1.0)],
                4 => rng.direction(),
                _ => [1e8 + rng.float(0.0, 1.0), rng.whole(-3, 3), rng.float(-1e-3, 1e-3)],
            })
        })
        .collect();
    match rng.below(4) {
        0 => points.push(points[0]),
        1 if points.len() > 1 => points.push(0.5 * (points[0] + points[1])),
        2 => {
            let plane = points[0].z;
            points.iter_mut().for_each(|p| p.z = if rng.chance(0.7) { plane } else { p.z });
        }
        _ => {}
    }
    rng.shuffle(&mut points);
    points
}

/// Every point is inside exactly, every plane touches one, and every facet has a plane that passes it within a few roundings.
fn check_planes(
    polytope: &IncrementalPolytope,
    points: &[DVec3],
    facets: &BTreeSet<Vec<usize>>,
    whole: bool,
) -> Result<(), String> {
    let exact: Vec<Vector> = points.iter().map(exactly).collect();
    let largest = points.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    if polytope.planes().count() < facets.len() || (whole && polytope.planes().count() > facets.len()) {
        return Err(format!("{} planes, {} facets", polytope.planes().count(), facets.len()));
    }
    let mut held = BTreeSet::new();
    for (plane, half_space) in polytope.planes() {
        let normal = exactly(&half_space.normal());
        let offset = RBig::try_from(half_space.offset()).expect("finite");
        let room: Vec<RBig> = exact.iter().map(|p| &offset - dot(&normal, p)).collect();
        if room.iter().any(|room| *room < RBig::ZERO) {
            return Err(format!("{plane:?} cuts a point off"));
        }
        let bound = 2f64.powi(-51) * largest * half_space.normal().abs().max_element();
        let bound = if whole { RBig::ZERO } else { RBig::try_from(bound).expect("finite") };
        held.extend(facets.iter().filter(|facet| facet.iter().all(|p| room[*p] <= bound)));
        let farthest = room.iter().min().expect("there are points");
        let ulp = half_space.offset().abs().next_up() - half_space.offset().abs();
        if *farthest > RBig::try_from(ulp).expect("finite") {
            return Err(format!("{plane:?} touches no point"));
        }
    }
    if held.len() != facets.len() { Err("a facet without a plane".into()) } else { Ok(()) }
}

/// Triangles lie in facets, face outward, close, and leave no facet out.
fn check_triangles(triangles: &[[u32; 3]], points: &[Vector], facets: &BTreeSet<Vec<usize>>) -> Result<(), String> {
    let mut edges = BTreeSet::new();
    let mut held = BTreeSet::new();
    for triangle in triangles {
        let corners = triangle.map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| &points[corner]);
        let normal = cross(&minus(b, a), &minus(c, a));
        if is_zero(&normal) || points.iter().any(|p| dot(&normal, &minus(p, a)) > RBig::ZERO) {
            return Err(format!("{triangle:?} is no triangle of the hull seen from outside"));
        }
        held.extend(facets.iter().filter(|facet| corners.iter().all(|corner| facet.contains(corner))));
        for k in 0..3 {
            if !edges.insert((corners[k], corners[(k + 1) % 3])) {
                return Err(format!("{triangle:?} has an edge that another one has"));
            }
        }
    }
    if edges.iter().any(|(a, b)| !edges.contains(&(*b, *a))) {
        return Err("the triangles do not close".into());
    }
    if held.len() != facets.len() { Err("a facet without a triangle".into()) } else { Ok(()) }
}

#[test]
fn small_sets_of_points() {
    let mut by_dimension = [0usize; 4];
    for k in 0..900 {
        let seed = first_seed() + k;
        let mut rng = Rng::new(seed);
        let points = some_points(&mut rng, k);
        let exact: Vec<Vector> = points.iter().map(exactly).collect();
        let (facets, dimension) = brute_force(&exact);
        let list: Vec<[f64; 3]> = points.iter().map(|p| p.to_array()).collect();
        let report = |what: &str| format!("{what}\nseed {seed}, points:\nlet points: Vec<[f64; 3]> = vec!{list:?};");
        by_dimension[dimension] += 1;
        match hull(&points) {
            Err(error) => assert_eq!(error, HullError::NoInterior { dimension }, "{}", report("error")),
            Ok(polytope) => {
                assert_eq!(dimension, 3, "{}", report("dimension"));
                let whole = points.iter().all(|p| *p == p.trunc() && p.abs().max_element() < 1e3);
                if let Err(error) = check_planes(&polytope, &points, &facets, whole) {
                    panic!("{}", report(&error));
                }
                let triangles =
                    hull_triangles(&points).unwrap_or_else(|error| panic!("{}", report(&error.to_string())));
                if let Err(error) = check_triangles(&triangles, &exact, &facets) {
                    panic!("{}", report(&error));
                }
                check_approximation(&points, &triangles).unwrap_or_else(|error| panic!("{}", report(&error)));
                assert!(polytope.is_bounded(), "{}", report("unbounded"));
                // where facets are nearly coplanar, rounded planes meet anywhere along them: count where all is exact
                if matches!(k % 6, 0 | 2) {
                    assert_eq!(polytope.vertex_count(), vertex_count(&exact, &facets), "{}", report("vertices"));
                }
            }
        }
    }
    assert!(by_dimension.iter().all(|n| *n > 20), "sets by dimension: {by_dimension:?}");
}

/// That a hull in floating point closes and has the volume of the exact one.
fn check_approximation(points: &[DVec3], exact: &[[u32; 3]]) -> Result<(), String> {
    let size = points.iter().flat_map(|p| points.iter().map(|q| p.distance(*q))).fold(0.0, f64::max);
    let tolerance = 1e-9 * size;
    let triangles = approximate_hull_triangles(points, tolerance).map_err(|error| error.to_string())?;
    let edges: Vec<(u32, u32)> = triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
    for (k, (a, b)) in edges.iter().enumerate() {
        if edges[..k].contains(&(*a, *b)) || !edges.contains(&(*b, *a)) {
            return Err(format!("the edge from {a} to {b} does not close in {triangles:?}"));
        }
    }
    let volume = |triangles: &[[u32; 3]]| {
        let of = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c)) / 6.0;
        triangles.iter().map(|corners| of(corners.map(|p| points[p as usize] - points[0]))).sum::<f64>()
    };
    let (found, expected) = (volume(&triangles), volume(exact));
    // no larger than a sphere of that radius has
    let layer = 4.0 * std::f64::consts::PI * size * size * tolerance;
    if (found - expected).abs() > layer {
        return Err(format!("found a volume of {found}, expected {expected}"));
    }
    Ok(())
}

#[test]
fn many_points() {
    let mut rng = Rng::new(first_seed());
    let on_sphere: Vec<DVec3> = (0..2000).map(|_| DVec3::from_array(rng.direction())).collect();
    let polytope = hull(&on_sphere).expect("points on a sphere span space");
    assert_eq!(polytope.planes().count(), 2 * on_sphere.len() - 4);
    assert_eq!((polytope.vertex_count(), polytope.edge_count()), (on_sphere.len(), 3 * on_sphere.len() - 6));
    assert!(on_sphere.iter().all(|p| polytope.contains(*p)));
    let grid: Vec<DVec3> =
        (0..20 * 20 * 20).map(|k| DVec3::new((k % 20) as f64, (k / 20 % 20) as f64, (k / 400) as f64)).collect();
    let cube = hull(&grid).expect("a grid spans space");
    assert_eq!((cube.planes().count(), cube.vertex_count()), (6, 8));
}

/// Points in general position on planes whose normals are small whole numbers: each facet's plane is exact.
#[test]
fn planes_with_whole_normals_are_exact() {
    const STEP: f64 = 1.0 / (1u64 << 40) as f64;
    for k in 0..20 {
        let seed = first_seed() + k;
        let mut rng = Rng::new(seed);
        let (p, q) = (rng.whole(2, 9), rng.whole(-9, -2));
        // x + p·y + q·z is 0 on one side and 3 on the other, both exactly
        let corners: Vec<[f64; 2]> =
            (0..3 + rng.below(4)).map(|_| [(); 2].map(|()| rng.whole(0, 1 << 40) * STEP)).collect();
        let at = |sum: f64| corners.iter().map(move |[y, z]| DVec3::new(sum - p * y - q * z, *y, *z));
        let points: Vec<DVec3> = at(0.0).chain(at(3.0)).collect();
        let polytope = hull(&points).unwrap_or_else(|error| panic!("{error}, seed {seed}, {points:?}"));
        let has = |sign: f64, offset: f64| {
            polytope.planes().any(|(_, half_space)| {
                let n = half_space.normal() * sign;
                n.y == p * n.x && n.z == q * n.x && n.x > 0.0 && half_space.offset() == offset * n.x
            })
        };
        assert!(has(1.0, 3.0) && has(-1.0, 0.0), "seed {seed}, points {points:?}");
    }
}

/// The tips have more neighbours than are looked at one by one.
#[test]
fn a_bipyramid_over_many_points() {
    let mut points: Vec<DVec3> = (0..3000)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 3000.0)
        .map(|angle| DVec3::new(angle.cos(), angle.sin(), 0.0))
        .collect();
    points.extend([DVec3::new(0.1, 0.2, 1.3), DVec3::new(0.1, -0.2, -0.7)]);
    let polytope = hull(&points).expect("the points span space");
    assert_eq!(polytope.planes().count(), 6000);
    assert!(points.iter().all(|p| polytope.contains(*p)));
}

#[test]
fn what_is_not_accepted() {
    assert_eq!(hull::<DVec3>(&[]).unwrap_err(), HullError::NoInterior { dimension: 0 });
    let simplex = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    assert_eq!(hull(&simplex).map(|p| p.vertex_count()).ok(), Some(4));
    for (bad, finite) in [(f64::NAN, false), (f64::INFINITY, false), (1e300, true), (1e-300, true)] {
        let mut points = simplex.to_vec();
        points.push(DVec3::new(0.0, bad, 0.0));
        match hull(&points).unwrap_err() {
            HullError::NotFinite { index, .. } => assert!(index == 4 && !finite),
            HullError::OutOfRange { index, .. } => assert!(index == 4 && finite),
            error => panic!("{error}"),
        }
    }
}
