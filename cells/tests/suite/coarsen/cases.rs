//! Solids whose figures are known.

use glam::DVec3;
use planecut_cells::coarsen::{CoarsenError, CoarsenOptions, Coarsener, coarsen};
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::HalfSpace;
use planecut_shapes::primitives;

use super::judge::{assert_holds_points, assert_sound, volume};

pub(crate) fn block(min: [f64; 3], max: [f64; 3]) -> Tree {
    Brush::cuboid(min, max, MaterialId(0)).into()
}

pub(crate) fn at_most(cells: usize) -> CoarsenOptions {
    CoarsenOptions { max_cells: Some(cells), ..CoarsenOptions::default() }
}

/// Steps of a stair.
fn stairs(count: usize) -> Tree {
    Tree::union((0..count).map(|k| k as f64).map(|k| block([k, 0.0, 0.0], [k + 1.0, 1.0, k + 1.0])))
}

#[test]
fn the_hull_of_stairs_is_a_ramp() {
    for count in 2..6 {
        let ramp = coarsen(&stairs(count), &[], &at_most(1)).expect("coarsened");
        assert_eq!((ramp.cells.len(), ramp.cells_in), (1, count));
        // a triangle at each step but the last
        let n = count as f64;
        let expected = 0.5 * (n - 1.0) / (0.5 * n * (n + 1.0));
        assert!((ramp.excess() - expected).abs() < 1e-12, "{} {expected}", ramp.excess());
        assert_sound(&stairs(count), &ramp);
    }
}

#[test]
fn stairs_are_merged_in_pairs() {
    // each pair adds half a unit, three of a kind one: no other choice of three cells adds as little as three pairs
    let coarser = coarsen(&stairs(6), &[], &at_most(3)).expect("coarsened");
    assert_eq!(coarser.cells.len(), 3);
    assert!((coarser.volume_out - coarser.volume_in - 1.5).abs() < 1e-12, "{}", coarser.volume_out);
    assert_sound(&stairs(6), &coarser);
}

#[test]
fn as_many_cells_as_there_are_change_nothing() {
    let tree = stairs(4);
    for cells in [4, 5, 1000] {
        let same = coarsen(&tree, &[], &at_most(cells)).expect("coarsened");
        assert_eq!((same.cells.len(), same.exact_merges, same.excess()), (4, 0, 0.0));
        for (cell, brush) in same.cells.iter().zip(tree.brushes()) {
            assert_eq!(volume(cell), volume(brush));
        }
    }
    // though it would be free
    let halves = block([0.0; 3], [1.0; 3]) | block([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    assert_eq!(coarsen(&halves, &[], &at_most(2)).expect("coarsened").cells.len(), 2);
}

#[test]
fn convex_unions_are_merged_for_nothing() {
    let octants = (0..8).map(|k| {
        let corner = [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
        block(corner, corner.map(|v| v + 1.0))
    });
    let cube = coarsen(&Tree::union(octants), &[], &CoarsenOptions::default()).expect("coarsened");
    assert_eq!((cube.cells.len(), cube.exact_merges, cube.volume_out), (1, 7, 8.0));
}

#[test]
fn a_pinwheel_is_merged_although_no_two_of_its_parts_are_convex() {
    let vanes =
        [([0.0, 0.0], [2.0, 1.0]), ([2.0, 0.0], [3.0, 2.0]), ([1.0, 2.0], [3.0, 3.0]), ([0.0, 1.0], [1.0, 3.0])];
    let middle = ([1.0, 1.0], [2.0, 2.0]);
    let parts = vanes.into_iter().chain([middle]).map(|(min, max)| block([min[0], min[1], 0.0], [max[0], max[1], 1.0]));
    let square = coarsen(&Tree::union(parts), &[], &CoarsenOptions::default()).expect("coarsened");
    assert_eq!((square.cells.len(), square.exact_merges), (1, 4));
    assert!((square.volume_out - 9.0).abs() < 1e-12);
}

#[test]
fn what_is_not_convex_is_not_merged_for_nothing() {
    let corner = block([0.0; 3], [2.0, 1.0, 1.0]) | block([0.0, 1.0, 0.0], [1.0, 2.0, 1.0]);
    let kept = coarsen(&corner, &[], &CoarsenOptions::default()).expect("coarsened");
    assert_eq!((kept.cells.len(), kept.exact_merges, kept.excess()), (2, 0, 0.0));
}

#[test]
fn a_ring_keeps_its_hole_as_long_as_it_has_cells() {
    let ring = block([0.0; 3], [3.0, 3.0, 1.0]) - block([1.0, 1.0, -1.0], [2.0, 2.0, 2.0]);
    let four = coarsen(&ring, &[], &at_most(4)).expect("coarsened");
    assert_eq!((four.cells.len(), four.excess()), (4, 0.0));
    let one = coarsen(&ring, &[], &at_most(1)).expect("coarsened");
    assert!((one.excess() - 0.125).abs() < 1e-12);
}

#[test]
fn no_more_is_added_than_was_allowed() {
    let tree = stairs(12);
    let coarsener = Coarsener::new(&tree, &[], &CoarsenOptions::default()).expect("a solid");
    let mut counts = Vec::new();
    for percent in [0, 1, 2, 3, 5, 8, 20] {
        let excess = f64::from(percent) / 100.0;
        let found = coarsener.to_excess(excess, 1).expect("coarsened");
        assert!(found.excess() <= excess, "{percent}: {}", found.excess());
        assert_sound(&tree, &found);
        counts.push(found.cells.len());
    }
    assert!(counts.is_sorted_by(|a, b| a >= b) && counts[0] == 12 && counts[6] == 1, "{counts:?}");
}

#[test]
fn the_excess_goes_before_the_number_of_cells() {
    let options =
        |cells| CoarsenOptions { max_cells: Some(cells), max_excess: Some(0.03), ..CoarsenOptions::default() };
    let bounded = coarsen(&stairs(8), &[], &options(1)).expect("coarsened");
    assert!(bounded.excess() <= 0.03 && bounded.cells.len() > 1);
    let enough = coarsen(&stairs(8), &[], &options(7)).expect("coarsened");
    assert!(enough.cells.len() <= 7 && enough.excess() <= 0.03);
}

#[test]
fn cells_that_lie_apart_can_become_one() {
    let far = |k: f64| block([1000.0 * k, 0.0, 0.0], [1000.0 * k + 1.0, 1.0, 1.0]);
    // more than the neighbours that each knows, in two places
    let tree = Tree::union((0..40).map(|k| far(if k < 20 { 0.0 } else { 50.0 } + f64::from(k % 20) * 0.01)));
    for cells in [2, 1] {
        let coarser = coarsen(&tree, &[], &at_most(cells)).expect("coarsened");
        assert_eq!(coarser.cells.len(), cells);
        assert_sound(&tree, &coarser);
    }
}

#[test]
fn turned_and_far_away_bodies_are_enclosed_exactly() {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    for shift in [0.0, 1e6] {
        let corners = |min: DVec3, max: DVec3| {
            (0..8).map(move |k| {
                DVec3::new(
                    if k & 1 == 0 { min.x } else { max.x },
                    if k & 2 == 0 { min.y } else { max.y },
                    if k & 4 == 0 { min.z } else { max.z },
                )
            })
        };
        let bodies: Vec<Vec<DVec3>> = (0..6)
            .map(|k| {
                corners(
                    DVec3::new(f64::from(k), 0.0, f64::from(k)),
                    DVec3::new(f64::from(k) + 1.0, 4.0, f64::from(k) + 2.0),
                )
            })
            .map(|corners| corners.map(|corner| turn * corner + shift).collect())
            .collect();
        let brush = |points: &Vec<DVec3>| primitives::hull_of_points(points, MaterialId(0)).expect("a hull");
        let tree = Tree::union_of(bodies.iter().map(brush).collect());
        let points: Vec<DVec3> = bodies.into_iter().flatten().collect();
        for cells in 1..=6 {
            let coarser = coarsen(&tree, &points, &at_most(cells)).expect("coarsened");
            assert!(coarser.cells.len() <= cells);
            assert_holds_points(&coarser.cells, &points);
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let tree = primitives::sphere(2.0, 16, MaterialId(0)).expect("a sphere").into();
    let tree = Tree::difference([
        tree,
        block([-3.0, -0.5, -0.5], [3.0, 0.5, 0.5]),
        block([-0.5, -3.0, -0.5], [0.5, 3.0, 0.5]),
    ]);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| coarsen(&tree, &[], &at_most(6)).expect("coarsened"))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_cannot_be_coarsened_is_refused() {
    let half = HalfSpace::new(DVec3::X, 1.0).expect("a half-space");
    let unbounded = Tree::from(Brush::from_half_spaces([half], MaterialId(0)));
    assert_eq!(coarsen(&unbounded, &[], &at_most(1)), Err(CoarsenError::Unbounded));
    assert_eq!(coarsen(&Tree::empty(), &[], &at_most(1)), Err(CoarsenError::Empty));
    let options = [
        CoarsenOptions { max_cells: Some(0), ..CoarsenOptions::default() },
        CoarsenOptions { max_excess: Some(-0.5), ..CoarsenOptions::default() },
        CoarsenOptions { max_excess: Some(f64::NAN), ..CoarsenOptions::default() },
        CoarsenOptions { max_faces: Some(5), ..CoarsenOptions::default() },
        CoarsenOptions { max_vertices: Some(7), ..CoarsenOptions::default() },
        CoarsenOptions { min_thickness: Some(f64::INFINITY), ..CoarsenOptions::default() },
    ];
    for options in options {
        let refused = coarsen(&stairs(2), &[], &options);
        assert!(matches!(refused, Err(CoarsenError::Option { .. })), "{options:?}");
    }
}
