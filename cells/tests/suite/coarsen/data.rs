//! Decompositions that V-HACD and CoACD made, and how they fare beside plain greedy merging.

use glam::DVec3;
use planecut_cells::Solid;
use planecut_cells::coarsen::{CoarsenOptions, Coarsener};
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::hull;
use planecut_shapes::primitives;
use planecut_testkit::data::data;

use super::judge::assert_holds_points;

planecut_testkit::tests_on_data!(
    all_points_of_decompositions_are_enclosed_exactly,
    never_is_more_added_than_by_plain_greedy_merging
);

/// The points of each object.
fn decomposition(name: &str) -> Vec<Vec<DVec3>> {
    let text = std::fs::read_to_string(data("convex").join(name)).expect(name);
    let mut objects: Vec<Vec<DVec3>> = Vec::new();
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("o" | "g", _)) => objects.push(Vec::new()),
            Some(("v", numbers)) => {
                let numbers: Vec<f64> = numbers.split_whitespace().map(|v| v.parse().expect("a number")).collect();
                objects.last_mut().expect("an object").push(DVec3::from_slice(&numbers));
            }
            _ => {}
        }
    }
    objects
}

fn brush(points: &[DVec3]) -> Brush {
    primitives::hull_of_points(points, MaterialId(0)).expect("a hull")
}

fn union_volume(bodies: &[Vec<DVec3>]) -> f64 {
    let tree = Tree::union_of(bodies.iter().map(|points| brush(points)).collect());
    Solid::from_tree(&tree).volume().expect("bounded")
}

/// The volume of the union for each number of cells, when always the pair is merged whose hull is least larger than both.
fn greedily(mut bodies: Vec<Vec<DVec3>>) -> Vec<(usize, f64)> {
    let volume = |points: &[DVec3]| hull(points).expect("a hull").measures().expect("bounded").volume;
    let mut found = vec![(bodies.len(), union_volume(&bodies))];
    while bodies.len() > 1 {
        let pairs = (0..bodies.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let cost = |(a, b): (usize, usize)| {
            volume(&[&bodies[a][..], &bodies[b]].concat()) - volume(&bodies[a]) - volume(&bodies[b])
        };
        let (_, (a, b)) = pairs.map(|pair| (cost(pair), pair)).min_by(|x, y| x.0.total_cmp(&y.0)).expect("a pair");
        let other = bodies.remove(b);
        bodies[a].extend(other);
        found.push((bodies.len(), union_volume(&bodies)));
    }
    found
}

fn all_points_of_decompositions_are_enclosed_exactly() {
    for name in
        ["bullet3/cup_vhacd.obj", "bullet3/duck_vhacd.obj", "bullet3/link2_vhacd.obj", "coacd/SnowFlake_coacd.obj"]
    {
        let bodies = decomposition(name);
        let points = bodies.concat();
        let tree = Tree::union_of(bodies.iter().map(|points| brush(points)).collect());
        let coarsener = Coarsener::new(&tree, &points, &CoarsenOptions::default()).expect("a solid");
        for cells in [1, 2, 5, bodies.len() / 2, bodies.len()] {
            let coarser = coarsener.to_cells(cells).expect("coarsened");
            assert!(coarser.cells.len() <= cells, "{name} at {cells}: {}", coarser.cells.len());
            assert_holds_points(&coarser.cells, &points);
        }
    }
}

fn never_is_more_added_than_by_plain_greedy_merging() {
    for name in ["bullet3/cup_vhacd.obj", "bullet3/duck_vhacd.obj"] {
        let bodies = decomposition(name);
        let tree = Tree::union_of(bodies.iter().map(|points| brush(points)).collect());
        let coarsener = Coarsener::new(&tree, &bodies.concat(), &CoarsenOptions::default()).expect("a solid");
        for (cells, greedy) in greedily(bodies) {
            let found = coarsener.to_cells(cells).expect("coarsened");
            assert!(found.volume_out <= greedy * (1.0 + 1e-9), "{name} at {cells}: {} {greedy}", found.volume_out);
        }
    }
}
