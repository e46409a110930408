//! Slices and shadows.

use glam::{DVec2, DVec3};
use planecut_csg::{MaterialId, Transform, Tree};
use planecut_shapes::Outline;
use planecut_shapes::primitives::{Extrusion, ShapeError, cuboid, extrude, half_space, prism, sphere, torus};
use planecut_shapes::shaping::{project, slice};

use super::judge::{assert_near, contains, sweep};
use super::polygon::{self, regular_area};

const M: MaterialId = MaterialId(0);

fn block(low: [f64; 3], high: [f64; 3]) -> Tree {
    cuboid(low, high, M).expect("a box").into()
}

fn loops(outline: &Outline) -> Vec<Vec<DVec2>> {
    outline.loops().cloned().collect()
}

#[test]
fn slices_of_a_frame() {
    let frame = block([0.0; 3], [3.0; 3]) - block([1.0, 1.0, -1.0], [2.0, 2.0, 5.0]);
    for (height, area, count) in [(0.0, 0.0, 0), (0.5, 8.0, 2), (3.0, 8.0, 2), (3.5, 0.0, 0)] {
        let found = slice(&frame, height).expect("a slice");
        assert_eq!((found.area(), found.loops().count()), (area, count), "at {height}");
    }
    assert_eq!(project(&frame).expect("a shadow").area(), 8.0);
    assert_eq!(slice(&Tree::empty(), 0.0), Ok(Outline::empty()));
    assert_eq!(project(&Tree::empty()), Ok(Outline::empty()));
}

#[test]
fn slices_of_round_bodies() {
    // between two rings the radius changes linearly
    let (radius, n) = (1.5, 24);
    let ball = sphere(radius, n, M).expect("a sphere").into();
    let ring = |i: u32| (std::f64::consts::PI * (f64::from(i) + 0.5) / f64::from(n / 2)).sin_cos();
    sweep(20, |rng| {
        let (i, t) = (rng.below(n as usize / 2 - 1) as u32, rng.float(0.01, 0.99));
        let ((wide, high), (low_wide, low)) = (ring(i), ring(i + 1));
        let found = slice(&ball, radius * (high + t * (low - high))).expect("a slice");
        assert_near(found.area(), regular_area(n, radius * (wide + t * (low_wide - wide))), 1e-12, "area");
        assert_eq!(found.loops().map(Vec::len).sum::<usize>(), n as usize);
    });
    let ring = torus(2.0, 0.5, 20, 8, M).expect("a torus");
    let found = slice(&ring, 0.0).expect("a slice");
    assert_near(found.area(), regular_area(20, 2.5) - regular_area(20, 1.5), 1e-12, "slice of a torus");
    let shadow = project(&ring).expect("a shadow");
    assert_near(shadow.area(), regular_area(20, 2.5) - regular_area(20, 1.5), 1e-12, "shadow of a torus");
    assert_eq!((found.loops().count(), shadow.loops().count()), (2, 2));
}

#[test]
fn an_outline_comes_back_from_its_extrusion() {
    sweep(40, |rng| {
        let given = polygon::random_region(rng, 16, DVec2::ZERO);
        let outline = Outline::from_loops(&given).expect("an outline");
        let tree = extrude(&outline, &Extrusion::straight(2.0), M).expect("an extrusion");
        for found in [slice(&tree, 1.0), slice(&tree, 2.0), project(&tree)] {
            let found = found.expect("an outline");
            assert_near(found.area(), outline.area(), 1e-12, "area");
            assert_eq!(found.loops().map(Vec::len).sum::<usize>(), given.iter().map(Vec::len).sum::<usize>());
        }
    });
}

#[test]
fn points_of_slices_and_shadows_of_random_trees() {
    sweep(30, |rng| {
        let body = |rng: &mut planecut_testkit::random::Rng| {
            let turn = Transform::rotation(rng.unit(), rng.float(0.0, 360.0)).expect("a turn");
            let shift = Transform::translation(rng.point(-1.0, 1.0)).expect("a shift");
            let brush = prism(2.0, 1.0, 3 + rng.below(4) as u32, M).expect("a prism");
            Tree::from(brush).transformed(&turn.then(&shift).expect("a motion")).expect("in range")
        };
        let tree = (body(rng) | body(rng)) - body(rng);
        let (sliced, shadow) =
            (loops(&slice(&tree, 0.25).expect("a slice")), loops(&project(&tree).expect("a shadow")));
        for _ in 0..200 {
            let at = DVec2::new(rng.float(-3.0, 3.0), rng.float(-3.0, 3.0));
            if let Some(expected) = contains(&tree, at.extend(0.25), 1e-9) {
                assert_eq!(polygon::contains(&sliced, at), expected, "slice at {at}");
            }
            // what a column of points meets lies in the shadow
            let mut column = (0..200).map(|k| at.extend(-4.0 + 0.04 * f64::from(k)));
            if column.any(|point| contains(&tree, point, 1e-9) == Some(true)) {
                assert!(polygon::contains(&shadow, at), "shadow at {at}");
            }
        }
    });
}

#[test]
fn unbounded_solids() {
    let half = |normal: DVec3, offset: f64| Tree::from(half_space(normal, offset, M).expect("a half-space"));
    let column = half(DVec3::X, 1.0) & half(-DVec3::X, 1.0) & half(DVec3::Y, 2.0) & half(-DVec3::Y, 0.5);
    for height in [0.0, 1e12, -3.0] {
        assert_eq!(slice(&column, height).expect("a bounded slice").area(), 5.0, "at {height}");
    }
    assert_eq!(project(&column), Err(ShapeError::Unbounded));
    assert_eq!(slice(&half(DVec3::X, 0.0), 0.0), Err(ShapeError::Unbounded));
    assert_eq!(slice(&column, f64::NAN).expect_err("not a height").parameter(), Some("z"));
}
