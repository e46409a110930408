//! Scripts that once failed, as the shrinker printed them, and small ones that are easy to get wrong.

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::campaign::Campaign;
use planecut_oracle::check::compare_with_truth;
use planecut_oracle::script::Op;

/// Replays a script against brute force after every operation.
fn replay(ops: &[Op]) {
    let start = || IncrementalPolytope::with_epsilon(0.0);
    let campaign = Campaign { operations: ops.len(), cases: 1, capacity: usize::MAX, start, check: compare_with_truth };
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

#[test]
fn the_direction_of_a_line_of_two_nearly_equal_planes() {
    // The second plane is ten times the first up to rounding: products in floating point cancel to zero.
    replay(&[
        add(0, [-0.08127368939572548, 0.03935550273364962, -0.04296198105987248, 0.07977481186384042]),
        add(1, [-0.8127368939572547, 0.39355502733649617, -0.4296198105987247, 0.7977481186384042]),
    ]);
}

#[test]
fn the_volume_of_a_needle() {
    // Three sides all but parallel to one line: the tip is 10¹⁶ times as far away as the base is wide.
    replay(&[
        add(0, [0.8337102308727241, 0.5303382051907015, 0.15384615384615385, 1.0]),
        add(1, [-0.25960430490149, -0.9657150743757779, 0.0, 1.0]),
        add(2, [0.9, -0.3, -0.3, 1.0]),
        add(3, [-0.45541984073721575, 0.8768831904020253, -0.15384615384615374, 1.0]),
    ]);
}

#[test]
fn an_older_plane_is_moved_so_that_nothing_is_left() {
    replay(&[
        add(13, [1.0, 1.0, 1.0, 2.0]),
        add(14, [1.0, 0.0, 1.0, -0.0]),
        add(15, [1.0, -1.0, 0.0, 0.0]),
        add(16, [-0.6, 0.6, -0.5, -8.4]),
        Op::Move { name: 14, plane: [-1.0, -1.0, 0.0, -6.0] },
    ]);
}

#[test]
fn two_faces_leave_whose_hidden_planes_kept_an_infinity_plane_hidden() {
    replay(&[
        add(0, [0.0, 1.0, 0.0, 4.0]),
        add(1, [-0.4, -0.5, -0.6, 1.0]),
        add(2, [0.336, 0.941, 0.161, 1.0]),
        // nothing, but what lost its face until now gets its certificate
        Op::RemoveMany { names: vec![] },
        add(3, [-1.0, 0.0, 0.0, 1.0]),
        add(4, [0.2, -0.8, -0.4, 1.0]),
        Op::RemoveMany { names: vec![2, 3] },
    ]);
}

/// Most faces are removed at once, so that the rest is rebuilt, and the rest is empty as before.
#[test]
fn an_empty_set_is_rebuilt_and_stays_empty() {
    let cube = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut ops = vec![add(0, [0.0, 0.0, -1.0, 1.0])];
    ops.extend(cube.iter().zip(1..).map(|([x, y, z], name)| add(name, [*x, *y, *z, 1.0])));
    ops.extend([add(6, [0.0, 0.0, 1.0, -5.0]), add(7, [1.0, 0.0, 0.0, 0.5])]);
    ops.extend([Op::RemoveMany { names: vec![1, 2, 3, 4, 5] }, remove(6)]);
    replay(&ops);
}
