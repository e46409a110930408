//! The three examples of degeneracy in the paper's §3.5.

use planecut_oracle::exact::Coefficients;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

use super::bodies::{CUBE, build, check_history, counts, euler_characteristic, true_counts, without};

/// The corner of the cube all planes below pass through or cut.
const CORNER: [f64; 3] = [1.0, 1.0, 1.0];

/// A plane with this normal at the distance `depth` (in units of the normal) inside the corner.
fn at_corner(n: [f64; 3], depth: f64) -> Coefficients {
    [n[0], n[1], n[2], (0..3).map(|i| n[i] * CORNER[i]).sum::<f64>() - depth]
}

/// All planes in 20 orders: counts, Euler's formula, and each plane removed and added again.
fn check_orders(planes: &[Coefficients]) {
    let mut rng = Rng::new(first_seed());
    let mut planes = planes.to_vec();
    let expected = true_counts(&planes);
    for _ in 0..20 {
        check_history(&planes);
        let (polytope, handles) = build(&planes, 0.0);
        assert_eq!(counts(&polytope), expected, "{planes:?}");
        for (k, &handle) in handles.iter().enumerate() {
            let mut less = polytope.clone();
            assert!(less.remove_plane(handle).is_some());
            if less.is_bounded() {
                assert_eq!(counts(&less), true_counts(&without(&planes, k)), "without {k}: {planes:?}");
                assert_eq!(euler_characteristic(&less), 2, "without {k}: {planes:?}");
            }
        }
        rng.shuffle(&mut planes);
    }
}

/// Example 1: a diagonal plane through a corner of the cube, a fourth plane at that vertex.
#[test]
fn degenerate_cube_corner_incremental() {
    let mut planes = CUBE.to_vec();
    planes.push(at_corner(CORNER, 0.0));
    let (polytope, handles) = build(&planes, 0.0);
    assert_eq!(counts(&polytope), [8, 12, 6], "the diagonal only touches");
    check_orders(&planes);
    // without one side the diagonal is no longer hidden
    let mut open = polytope.clone();
    open.remove_plane(handles[0]);
    assert!(open.is_bounded() && !open.is_redundant(handles[6]));
}

/// Many planes through one corner: touching it, along its edges, and tilted.
#[test]
fn a_cube_corner_with_four_to_nine_planes() {
    let through =
        [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 3.0, 1.0], [1.0, 0.0, 1.0]];
    let mut planes = CUBE.to_vec();
    for n in through {
        planes.push(at_corner(n, 0.0));
        assert_eq!(true_counts(&planes), [8, 12, 6], "planes through a corner from outside only touch");
        check_orders(&planes);
    }
}

/// A pyramid on the cube's corner region: four and more faces that really meet in one vertex.
#[test]
fn a_vertex_of_four_and_more_faces() {
    // all pass through (1/2, 1/2, 1/2), which they cut off the cube's corner
    let bevels = [[3.0, 1.0, 1.0], [1.0, 3.0, 1.0], [1.0, 1.0, 3.0], [3.0, 3.0, 1.0], [1.0, 3.0, 3.0], [3.0, 1.0, 3.0]];
    let mut planes = CUBE.to_vec();
    let mut most = 0;
    for n in bevels {
        planes.push([n[0], n[1], n[2], (n[0] + n[1] + n[2]) / 2.0]);
        check_orders(&planes);
        let (polytope, _) = build(&planes, 0.0);
        most = polytope.vertices().map(|(_, vertex)| vertex.planes.len()).fold(most, usize::max);
    }
    assert!(most >= 5, "at most {most} faces meet");
}

/// Example 3: a corner cut off by one plane, by a second, and by planes that meet in its new edges and corners.
#[test]
fn truncated_cube_corner() {
    let mut planes = CUBE.to_vec();
    let cut = at_corner(CORNER, 1.0);
    planes.push(cut);
    assert_eq!(true_counts(&planes), [10, 15, 7]);
    check_orders(&planes);
    // through the new corners (0, 1, 1), (1, 0, 1), (1, 1, 0) of the cut, two, then three at a time
    for n in [[1.0, 1.0, 2.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]] {
        let mut bevelled = planes.clone();
        bevelled.push(at_corner(n, 1.0));
        check_orders(&bevelled);
        bevelled.push(at_corner(n, 1.5));
        check_orders(&bevelled);
        planes.push(at_corner(n, 1.0));
    }
    check_orders(&planes);
}

/// Example 2: pairs of planes at angles from a hundredth to the last bit, on a cube.
#[test]
fn near_parallel_planes() {
    for power in 2..=15 {
        let tilt = 10f64.powi(-power);
        let mut planes = CUBE.to_vec();
        planes.extend([[tilt, 0.0, 1.0, 0.75], [-tilt, tilt, 1.0, 0.75], [0.0, -tilt, 1.0, 0.75]]);
        planes.extend([[1.0, tilt, 0.0, 1.0], [1.0, 0.0, tilt, 1.0 + tilt]]);
        check_history(&planes);
        let (polytope, _) = build(&planes, 0.0);
        assert_eq!(counts(&polytope), true_counts(&planes), "tilt {tilt:e}");
        assert_eq!(euler_characteristic(&polytope), 2, "tilt {tilt:e}");
    }
}
