//! Hulls against their definition.

use glam::DVec3;
use planecut_csg::{MaterialId, Transform, Tree};
use planecut_shapes::primitives::{ShapeError, cuboid, half_space, hull_of_points, sphere, torus};
use planecut_shapes::shaping::hull;

use super::judge::{assert_near, evaluated, figures, sweep};
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

fn block(low: DVec3, high: DVec3) -> Tree {
    cuboid(low, high, M).expect("a box").into()
}

fn moved(tree: Tree, rng: &mut Rng) -> Tree {
    let turn = Transform::rotation(rng.unit(), rng.float(0.0, 360.0)).expect("a turn");
    let shift = Transform::translation(rng.point(-3.0, 3.0)).expect("a shift");
    tree.transformed(&turn.then(&shift).expect("a motion")).expect("in range")
}

/// The volume of the hull of points, from all planes through three of them that have the others on one side.
fn by_brute_force(points: &[DVec3]) -> f64 {
    let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let center = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut volume = 0.0;
    let n = points.len();
    for (i, j, k) in (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k)))) {
        if i < j && i < k && j != k {
            let (a, b, c) = (points[i], points[j], points[k]);
            let normal = (b - a).cross(c - a);
            let outside = points.iter().map(|p| normal.dot(*p - a)).fold(f64::NEG_INFINITY, f64::max);
            if normal.length() > 1e-9 && outside <= 1e-12 * size * normal.length() {
                volume += (a - center).cross(b - center).dot(c - center) / 6.0;
            }
        }
    }
    volume
}

#[test]
fn a_single_body_is_its_own_hull() {
    sweep(10, |rng| {
        let ball = moved(sphere(1.0, 9, MaterialId(7)).expect("a sphere").into(), rng);
        let found = hull(&[Tree::union([ball.clone(), Tree::empty()])], M).expect("a hull");
        assert_eq!(found.brushes(), ball.brushes());
    });
}

#[test]
fn two_bodies_in_general_position() {
    sweep(30, |rng| {
        let some = |rng: &mut Rng| -> Vec<DVec3> { (0..4 + rng.below(8)).map(|_| rng.point(-2.0, 2.0)).collect() };
        let (first, second) = (some(rng), some(rng));
        let trees = [&first, &second].map(|points| Tree::from(hull_of_points(points, M).expect("a body")));
        let all: Vec<DVec3> = first.into_iter().chain(second).collect();
        let together = hull(&trees, M).expect("a hull");
        assert_eq!(together.brushes().len(), 1);
        assert_near(figures(&together).volume, by_brute_force(&all), 1e-12, "volume");
        // as one union, or with one of them written as a difference
        let joined = trees[0].clone() | trees[1].clone();
        let union = figures(&hull(std::slice::from_ref(&joined), M).expect("a hull"));
        let far = block(DVec3::splat(50.0), DVec3::splat(51.0));
        let rest = figures(&hull(&[joined - far], M).expect("a hull"));
        assert_near(union.volume, by_brute_force(&all), 1e-12, "volume of the hull of the union");
        assert_near(rest.volume, by_brute_force(&all), 1e-11, "volume of the hull of the mesh");
        assert_near(union.area, rest.area, 1e-11, "area");
    });
}

#[test]
fn faces_of_operands_are_kept_as_they_are() {
    sweep(10, |rng| {
        let two = block(DVec3::ZERO, DVec3::ONE) | block(DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 1.0, 3.0));
        let two = moved(two, rng);
        let found = hull(std::slice::from_ref(&two), M).expect("a hull");
        assert_eq!(found.brushes()[0].faces.len(), 6);
        let given: Vec<_> = two.brushes().iter().flat_map(|brush| &brush.faces).collect();
        assert!(found.brushes()[0].faces.iter().all(|face| given.contains(&face)));
        // quads of a sphere are not split where the hull keeps them
        let balls = [0.0, 3.0].map(|x| {
            let shift = Transform::translation(DVec3::new(x, 0.0, 0.0)).expect("a shift");
            Tree::from(sphere(1.0, 16, M).expect("a sphere")).transformed(&shift).expect("in range")
        });
        // halves of a sphere of 16 × 8, the middle stretched
        let found = figures(&hull(&balls, M).expect("a hull"));
        assert_eq!(found.corners, 16 * 8 + 2 * 8);
    });
}

#[test]
fn hulls_of_what_is_not_convex() {
    let shell = block(DVec3::ZERO, DVec3::splat(3.0)) - block(DVec3::splat(1.0), DVec3::new(2.0, 2.0, 5.0));
    let found = figures(&hull(&[shell], M).expect("a hull"));
    assert_eq!((found.volume, found.faces, found.corners), (27.0, 6, 8));
    // the hull of a torus is that of its outer half: rings of n corners
    let ring = torus(2.0, 0.5, 12, 8, M).expect("a torus");
    let found = hull(std::slice::from_ref(&ring), M).expect("a hull");
    let (outer, inner) = (figures(&found), figures(&ring));
    assert_eq!((outer.genus, outer.corners), (0, 12 * 5));
    assert!(outer.volume > inner.volume);
    assert_near(figures(&Tree::union([found, ring])).volume, outer.volume, 1e-12, "the hull holds the torus");
}

#[test]
fn nothing_and_what_is_unbounded() {
    assert_eq!(hull(&[], M), Ok(Tree::empty()));
    let cube = block(DVec3::ZERO, DVec3::ONE);
    assert_eq!(hull(&[cube.clone() - cube.clone()], M), Ok(Tree::empty()));
    let half = Tree::from(half_space(DVec3::X, 0.0, M).expect("a half-space"));
    assert_eq!(hull(&[cube.clone(), half.clone()], M), Err(ShapeError::Unbounded));
    assert_eq!(hull(&[!cube.clone()], M), Err(ShapeError::Unbounded));
    let left = hull(
        &[cube & half.transformed(&Transform::translation(DVec3::X * 0.5).expect("a shift")).expect("in range")],
        M,
    );
    assert_eq!(figures(&left.expect("a hull")).volume, 0.5);
    assert!(evaluated(&Tree::empty()).mesh.triangles.is_empty());
}
