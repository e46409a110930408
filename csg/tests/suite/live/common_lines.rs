//! Lines on which bodies have edges that are apart from each other: they come to be the same, or are no longer, as a plane of one body
//! moves and nothing but places changes.

use planecut_csg::Role;

use super::edits::{Edit, Faces, Planes, run};

/// A prism between two heights on a square with one corner on the z axis, and a third side through it.
fn corner(low: f64, high: f64, sides: [[f64; 2]; 2]) -> Planes {
    let mut planes: Planes = vec![([0.0, 0.0, 1.0], high), ([0.0, 0.0, -1.0], -low)];
    planes.extend([([1.0, 0.0, 0.0], 4.0), ([-1.0, 0.0, 0.0], 4.0), ([0.0, 1.0, 0.0], 4.0), ([0.0, -1.0, 0.0], 4.0)]);
    planes.extend(sides.map(|[x, y]| ([x, y, 0.0], 0.0)));
    planes
}

const STRAIGHT: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
const STEEP: [[f64; 2]; 2] = [[1.0, 1.0], [1.0, -1.0]];
const FLAT: [[f64; 2]; 2] = [[2.0, 1.0], [-1.0, 1.0]];

/// The place of the first of the two sides.
const SIDE: usize = 6;

#[test]
fn a_plane_leaves_a_line_that_another_body_has() {
    let edits = [
        Edit::Add(corner(0.0, 1.0, STRAIGHT), 0, Role::Add),
        Edit::Add(corner(2.0, 4.0, STEEP), 1, Role::Add),
        Edit::MovePlane(0, SIDE, 0.125),
        Edit::MovePlane(0, SIDE, 0.25),
        Edit::Add(corner(3.0, 5.0, FLAT), 0, Role::Add),
        Edit::Add(corner(-1.0, 3.0, STEEP), 0, Role::Subtract),
    ];
    let tally = run(&edits, Faces::Same);
    assert!(tally.as_ref().is_ok_and(|tally| tally.compared == edits.len()), "{tally:?}");
}

#[test]
fn a_plane_comes_to_a_line_that_another_body_has() {
    let mut beside = corner(0.0, 1.0, STRAIGHT);
    beside[SIDE].1 = 0.25;
    let mut edits = vec![
        Edit::Add(beside, 0, Role::Add),
        Edit::Add(corner(2.0, 4.0, STEEP), 1, Role::Add),
        Edit::MovePlane(0, SIDE, 0.125),
        Edit::MovePlane(0, SIDE, 0.0),
    ];
    // either another plane moves next, or something is added at once
    for moves in [false, true] {
        if moves {
            edits.extend([Edit::Nudge(1, 0, 0.25), Edit::Nudge(0, SIDE, 0.125), Edit::Nudge(0, SIDE, -0.125)]);
            edits.extend([Edit::Nudge(0, 1, 0.25), Edit::Nudge(0, 1, -0.125)]);
        }
        let mut edits = edits.clone();
        edits.extend([
            Edit::Add(corner(-1.0, 3.0, STEEP), 0, Role::Add),
            Edit::Add(corner(0.5, 5.0, FLAT), 0, Role::Subtract),
        ]);
        let tally = run(&edits, Faces::Same);
        assert!(tally.as_ref().is_ok_and(|tally| tally.compared == edits.len()), "{tally:?}");
    }
}

/// A wedge of the random edits around lines, on a square about the z axis.
fn wedge(bottom: f64, sides: [[f64; 3]; 2]) -> Planes {
    let mut planes: Planes = vec![([0.0, 0.0, 1.0], 1.0), ([0.0, 0.0, -1.0], bottom)];
    planes.extend([([1.0, 0.0, 0.0], 3.0), ([-1.0, 0.0, 0.0], 3.0), ([0.0, 1.0, 0.0], 3.0), ([0.0, -1.0, 0.0], 3.0)]);
    planes.extend(sides.map(|normal| (normal, 0.0)));
    planes
}

/// Seed 346 of the random edits around lines.
#[test]
fn a_line_that_two_bodies_have_is_cut_by_a_third() {
    let tally = run(
        &[
            Edit::Add(wedge(0.0, [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]), 1, Role::Add),
            Edit::Move(369, [0.0, 0.0, 1.0], 90.0, [2.0, 2.0, 2.0]),
            Edit::Add(wedge(1.0, [[1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]), 0, Role::Add),
            Edit::MovePlane(958, 898, 0.0),
            Edit::Add(wedge(0.0, [[-1.0, -0.0, -0.0], [0.0, 1.0, 0.0]]), 0, Role::Add),
            Edit::Add(wedge(1.0, [[1.0, 1.0, 0.0], [1.0, 0.0, 0.0]]), 0, Role::Intersect),
        ],
        Faces::Same,
    );
    assert!(tally.is_ok(), "{tally:?}");
}
