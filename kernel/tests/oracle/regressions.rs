//! Scripts that once failed, as the shrinker printed them, and small ones that are easy to get wrong.

use planecut_kernel::IncrementalPolytope;

use crate::brute_force::compare_with_truth;
use crate::script::Op;
use crate::shrink::Campaign;

/// Replays a script against brute force after every operation.
fn replay(ops: &[Op]) {
    let start = || IncrementalPolytope::with_epsilon(0.0);
    let campaign = Campaign { operations: ops.len(), capacity: usize::MAX, start, check: compare_with_truth };
    campaign.attempt(ops).unwrap_or_else(|e| panic!("{e}"));
}

fn add(name: usize, plane: [f64; 4]) -> Op {
    Op::Add { name, plane }
}

fn remove(name: usize) -> Op {
    Op::Remove { name }
}

#[test]
fn nothing_at_all() {
    replay(&[add(0, [0.0, 0.0, 1.0, 0.0]), remove(0), add(2, [0.0, 0.0, -1.0, 0.0]), remove(2)]);
}

#[test]
fn the_older_of_two_equal_planes_goes_and_the_younger_takes_over() {
    replay(&[
        add(0, [1.0, 2.0, 3.0, 4.0]),
        add(1, [2.0, 4.0, 6.0, 8.0]),
        remove(0),
        add(3, [1.0, 2.0, 3.0, 4.0]),
        remove(3),
    ]);
}

#[test]
fn a_slab_without_thickness_comes_back_from_either_side() {
    let (up, down) = ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, -1.0, -1.0]);
    replay(&[add(0, up), add(1, down), remove(0), add(3, up), remove(1)]);
}

#[test]
fn planes_added_to_an_empty_set_count_after_it_comes_back() {
    replay(&[
        add(0, [1.0, 0.0, 0.0, -1.0]),
        add(1, [-1.0, 0.0, 0.0, -1.0]),
        add(2, [0.0, 1.0, 0.0, 1.0]),
        add(3, [0.0, 2.0, 0.0, 5.0]),
        remove(0),
        remove(2),
    ]);
}
