//! Minkowski sums against mixed volumes, support functions and lattices.

use glam::DVec3;
use planecut_csg::{Brush, MaterialId, Transform, Tree};
use planecut_shapes::primitives::{ShapeError, cuboid, half_space, hull_of_points, sphere};
use planecut_shapes::shaping::minkowski;

use super::judge::{assert_near, evaluated, figures, sweep};
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

fn block(low: DVec3, high: DVec3) -> Tree {
    cuboid(low, high, M).expect("a box").into()
}

/// A parallelepiped at the origin and the edges that span it.
fn parallelepiped(rng: &mut Rng) -> (Tree, [DVec3; 3]) {
    let sizes = [0, 1, 2].map(|_| rng.float(0.2, 2.0));
    let turn = if rng.chance(0.5) { glam::DQuat::IDENTITY } else { rng.rotation() };
    let map = glam::DMat3::from_quat(turn) * glam::DMat3::from_diagonal(DVec3::from_array(sizes));
    let tree = block(DVec3::ZERO, DVec3::ONE).transformed(&Transform::new(map, DVec3::ZERO).expect("a map"));
    (tree.expect("in range"), [map.x_axis, map.y_axis, map.z_axis])
}

fn corners(tree: &Tree) -> Vec<DVec3> {
    evaluated(tree).mesh.positions
}

fn reach(points: &[DVec3], direction: DVec3) -> f64 {
    points.iter().map(|p| p.dot(direction)).fold(f64::NEG_INFINITY, f64::max)
}

/// `h(A ⊕ B) = h(A) + h(B)` in random directions.
fn check_reach(a: &Tree, b: &Tree, sum: &Tree, rng: &mut Rng) {
    let (first, second, both) = (corners(a), corners(b), corners(sum));
    for _ in 0..100 {
        let direction = rng.unit();
        let (found, expected) = (reach(&both, direction), reach(&first, direction) + reach(&second, direction));
        assert!(
            (found - expected).abs() < 1e-12 * (1.0 + expected.abs()),
            "{direction}: found {found}, expected {expected}"
        );
    }
}

#[test]
fn boxes_add_their_sizes_exactly() {
    let sum = minkowski(
        &block(DVec3::new(0.0, 1.0, 2.0), DVec3::new(1.0, 3.0, 5.0)),
        &block(DVec3::splat(-0.5), DVec3::splat(0.25)),
        M,
    );
    let expected = cuboid(DVec3::new(-0.5, 0.5, 1.5), DVec3::new(1.25, 3.25, 5.25), M).expect("a box");
    let sum = sum.expect("a sum");
    let planes = |brush: &Brush| {
        let mut planes: Vec<String> = brush.faces.iter().map(|face| format!("{:?}", face.half_space)).collect();
        planes.sort();
        planes
    };
    assert_eq!(planes(&sum.brushes()[0]), planes(&expected));
}

#[test]
fn parallelepipeds_by_mixed_volumes() {
    sweep(60, |rng| {
        let ((a, first), (b, second)) = (parallelepiped(rng), parallelepiped(rng));
        let sum = minkowski(&a, &b, M).expect("a sum");
        let edges: Vec<DVec3> = first.into_iter().chain(second).collect();
        // the volume of a zonotope is the sum over all triples of the edges that span it
        let mut volume = 0.0;
        for (i, j, k) in (0..6).flat_map(|i| (i + 1..6).flat_map(move |j| (j + 1..6).map(move |k| (i, j, k)))) {
            volume += edges[i].dot(edges[j].cross(edges[k])).abs();
        }
        assert_near(figures(&sum).volume, volume, 1e-12, "volume");
        check_reach(&a, &b, &sum, rng);
    });
}

#[test]
fn bodies_in_general_position_against_all_sums_of_corners() {
    sweep(40, |rng| {
        let body = |rng: &mut Rng| {
            let points: Vec<DVec3> = (0..4 + rng.below(20)).map(|_| rng.unit() * rng.float(0.5, 1.0)).collect();
            (Tree::from(hull_of_points(&points, M).expect("a body")), points)
        };
        let ((a, first), (b, second)) = (body(rng), body(rng));
        let sum = minkowski(&a, &b, M).expect("a sum");
        let all: Vec<DVec3> = first.iter().flat_map(|p| second.iter().map(move |q| *p + *q)).collect();
        let (found, expected) = (figures(&sum), figures(&hull_of_points(&all, M).expect("a hull").into()));
        assert_near(found.volume, expected.volume, 1e-12, "volume");
        assert_near(found.area, expected.area, 1e-11, "area");
        assert_eq!(found.faces, expected.faces);
        check_reach(&a, &b, &sum, rng);
    });
}

#[test]
fn a_sphere_rounds_a_box() {
    let (ball, needle) =
        (sphere(0.5, 16, M).expect("a sphere").into(), block(DVec3::ZERO, DVec3::new(3.0, 1e-6, 1e-6)));
    let sum = minkowski(&ball, &needle, M).expect("a sum");
    let all: Vec<DVec3> =
        corners(&ball).iter().flat_map(|p| corners(&needle).into_iter().map(move |q| *p + q)).collect();
    let expected = figures(&hull_of_points(&all, M).expect("a hull").into());
    assert_near(figures(&sum).volume, expected.volume, 1e-9, "volume");
    // a box and a sphere: volume + areas · radii + … has faces of both, and strips between them
    let rounded = figures(&minkowski(&ball, &block(DVec3::ZERO, DVec3::ONE), M).expect("a sum"));
    assert_eq!((rounded.genus, rounded.corners), (0, 16 * 8 + 4 * 8));
    // the sum with itself is twice as large
    let twice = figures(&minkowski(&ball, &ball, M).expect("a sum"));
    let once = figures(&ball);
    assert_near(twice.volume, 8.0 * once.volume, 1e-12, "volume");
    assert_eq!((twice.faces, twice.corners), (once.faces, once.corners));
}

/// Edges that are parallel but for rounding: their Gaussian arcs lie on each other, and cross anywhere.
#[test]
fn balls_of_rings_with_parallel_edges() {
    sweep(40, |rng| {
        let ball = |rng: &mut Rng| {
            let (segments, rings) = (3 + rng.below(20), 2 + rng.below(9));
            let radius = rng.float(0.4, 2.0);
            let angle = |k: usize, of: usize| (k as f64 + 0.5) / of as f64 * std::f64::consts::PI;
            let point = |ring: usize, k: usize| {
                let (height, turn) =
                    (angle(ring, rings), 2.0 * angle(k, segments) - std::f64::consts::PI / segments as f64);
                DVec3::new(height.sin() * turn.cos(), height.sin() * turn.sin(), height.cos()) * radius
            };
            let points = (0..rings).flat_map(|ring| (0..segments).map(move |k| point(ring, k)));
            let points: Vec<DVec3> = points.collect();
            (Tree::from(hull_of_points(&points, M).expect("a body")), points)
        };
        let ((a, first), (b, second)) = (ball(rng), ball(rng));
        let sum = minkowski(&a, &b, M).expect("a sum");
        let all: Vec<DVec3> = first.iter().flat_map(|p| second.iter().map(move |q| *p + *q)).collect();
        let expected = figures(&hull_of_points(&all, M).expect("a hull").into());
        assert_near(figures(&sum).volume, expected.volume, 1e-12, "volume");
        check_reach(&a, &b, &sum, rng);
    });
}

#[test]
fn unions_and_cells_are_summed_part_by_part() {
    let l = block(DVec3::ZERO, DVec3::new(3.0, 1.0, 1.0)) | block(DVec3::ZERO, DVec3::new(1.0, 3.0, 1.0));
    let cube = block(DVec3::ZERO, DVec3::ONE);
    // an L of 5 cells and a cube: 3 × 2 × 2 cells along each arm, 4 × 2 × 2 + 2 × 2 × 2 in all
    let found = figures(&minkowski(&l, &cube, M).expect("a sum"));
    assert_eq!((found.volume, found.faces), (f64::from(4 * 2 * 2 + 2 * 2 * 2), 8));
    // a frame about a hole of 3 × 3, filled up to 2 × 2 by a cube of 1
    let frame =
        block(DVec3::ZERO, DVec3::new(5.0, 5.0, 1.0)) - block(DVec3::new(1.0, 1.0, -1.0), DVec3::new(4.0, 4.0, 2.0));
    let found = figures(&minkowski(&frame, &cube, M).expect("a sum"));
    assert_eq!((found.volume, found.genus), (f64::from(6 * 6 * 2 - 2 * 2 * 2), 1));
    let found = figures(&minkowski(&cube, &frame, M).expect("a sum"));
    assert_eq!((found.volume, found.genus), (f64::from(6 * 6 * 2 - 2 * 2 * 2), 1));
}

#[test]
fn nothing_and_what_is_unbounded() {
    let cube = block(DVec3::ZERO, DVec3::ONE);
    let nothing = minkowski(&cube, &Tree::empty(), M).expect("nothing");
    assert!(nothing.brushes().is_empty());
    let half = Tree::from(half_space(DVec3::X, 0.0, M).expect("a half-space"));
    assert_eq!(minkowski(&cube, &half, M), Err(ShapeError::Unbounded));
    assert_eq!(minkowski(&!half, &cube, M), Err(ShapeError::Unbounded));
}
