//! Hulls of random lattice points, which overlap, touch and lie apart, at every cap.

use glam::DVec3;
use planecut_cells::coarsen::{CoarsenOptions, Coarsener};
use planecut_csg::{MaterialId, Tree};
use planecut_shapes::primitives;

use super::judge::{assert_holds_points, assert_sound};
use planecut_testkit::random::Rng;

const CASES: u64 = 24;

/// Bodies of a few lattice points each, on a lattice so coarse that faces, edges and corners coincide.
fn bodies(seed: u64) -> Vec<Vec<DVec3>> {
    let mut rng = Rng::spread(seed);
    let (count, size) = (2 + rng.below(8), rng.integer(1, 4));
    let mut bodies = Vec::new();
    while bodies.len() < count {
        let base = [0, 1, 2].map(|_| rng.integer(-4, 4));
        let points = 4 + rng.below(8);
        let point = |rng: &mut Rng| DVec3::from_array(base.map(|v| (v + rng.integer(0, size)) as f64));
        let body: Vec<DVec3> = (0..points).map(|_| point(&mut rng)).collect();
        if primitives::hull_of_points(&body, MaterialId(0)).is_ok() {
            bodies.push(body);
        }
    }
    bodies
}

#[test]
fn every_cap_gives_convex_cells_that_enclose_everything() {
    for seed in 0..CASES {
        let bodies = bodies(seed);
        let pasteable = || format!("seed {seed}: {bodies:?}");
        let brush = |points: &Vec<DVec3>| primitives::hull_of_points(points, MaterialId(0)).expect("a hull");
        let tree = Tree::union_of(bodies.iter().map(brush).collect());
        let points: Vec<DVec3> = bodies.iter().flatten().copied().collect();
        let coarsener = Coarsener::new(&tree, &points, &CoarsenOptions::default()).expect("a solid");
        for cells in 1..=bodies.len() + 1 {
            let coarser = coarsener.to_cells(cells).expect("coarsened");
            assert!(coarser.cells.len() <= cells, "{cells}: {}", pasteable());
            assert!(coarser.excess() >= -1e-12, "{cells}: {}", pasteable());
            if cells >= bodies.len() {
                assert!(coarser.excess().abs() <= 1e-12, "{cells}: {}", pasteable());
            }
            eprintln!("{}, at most {cells}", pasteable());
            assert_holds_points(&coarser.cells, &points);
            assert_sound(&tree, &coarser);
        }
    }
}

#[test]
fn a_cap_of_one_is_the_hull() {
    for seed in 100..100 + CASES {
        let bodies = bodies(seed);
        let brush = |points: &Vec<DVec3>| primitives::hull_of_points(points, MaterialId(0)).expect("a hull");
        let tree = Tree::union_of(bodies.iter().map(brush).collect());
        let points: Vec<DVec3> = bodies.iter().flatten().copied().collect();
        let coarsener = Coarsener::new(&tree, &points, &CoarsenOptions::default()).expect("a solid");
        let one = coarsener.to_cells(1).expect("coarsened");
        let hull = planecut_kernel::hull(&points).expect("a hull").measures().expect("bounded").volume;
        assert!((one.volume_out - hull).abs() <= 1e-12 * hull, "seed {seed}: {bodies:?}");
    }
}
