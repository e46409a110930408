//! Cells within the solid.

use planecut_cells::Solid;
use planecut_cells::coarsen::{CoarsenOptions, Coarsener, Side, coarsen};
use planecut_csg::Tree;

use super::cases::{at_most, block};
use super::judge::volume;

fn inner(options: CoarsenOptions) -> CoarsenOptions {
    CoarsenOptions { side: Side::Inner, ..options }
}

/// Two bars that cross.
fn cross() -> Tree {
    block([0.0, 2.0, 0.0], [6.0, 3.0, 1.0]) | block([1.0, 0.0, 0.0], [3.0, 6.0, 1.0])
}

#[test]
fn the_largest_body_stays_alone() {
    let one = coarsen(&cross(), &[], &inner(at_most(1))).expect("coarsened");
    assert_eq!((one.cells.len(), one.volume_out, one.volume_in), (1, 12.0, 16.0));
    assert_eq!(one.excess(), -0.25);
}

#[test]
fn parts_grow_through_walls_between_them() {
    // as disjoint cells: one bar is cut in three by the other
    let cells = Tree::difference([
        block([0.0; 3], [6.0, 6.0, 1.0]),
        block([0.0; 3], [1.0, 2.0, 1.0]),
        block([3.0, 0.0, 0.0], [6.0, 2.0, 1.0]),
        block([0.0, 3.0, 0.0], [1.0, 6.0, 1.0]),
        block([3.0, 3.0, 0.0], [6.0, 6.0, 1.0]),
    ]);
    let two = coarsen(&cells, &[], &inner(CoarsenOptions::default())).expect("coarsened");
    assert_eq!((two.cells.len(), two.volume_out), (2, 16.0));
    let mut volumes: Vec<f64> = two.cells.iter().map(volume).collect();
    volumes.sort_by(f64::total_cmp);
    assert_eq!(volumes, [6.0, 12.0]);
}

#[test]
fn no_more_is_lost_than_was_allowed() {
    let comb = Tree::union((0..8).map(|k| {
        let k = f64::from(k);
        block([2.0 * k, 0.0, 0.0], [2.0 * k + 1.0, 1.0 + k, 1.0])
    }));
    let coarsener = Coarsener::new(&comb, &[], &inner(CoarsenOptions::default())).expect("a solid");
    let mut counts = Vec::new();
    for percent in [0, 5, 10, 30, 70] {
        let lost = f64::from(percent) / 100.0;
        let found = coarsener.to_excess(lost, 1).expect("coarsened");
        assert!((-lost..=0.0).contains(&found.excess()), "{percent}: {}", found.excess());
        let outside = Tree::union_of(found.cells.clone()) - comb.clone();
        assert!(Solid::from_tree(&outside).is_empty());
        counts.push(found.cells.len());
    }
    assert!(counts.is_sorted_by(|a, b| a >= b) && counts[0] == 8 && counts[4] < 4, "{counts:?}");
}
