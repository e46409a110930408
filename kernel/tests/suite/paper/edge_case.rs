//! `test_edge_case_polytope`: eleven planes of which earlier clipping found 11 of 18 vertices (paper, Appendix C).

use planecut_kernel::{IncrementalPolytope, PlaneIdx};
use planecut_oracle::exact::Coefficients;
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

use super::bodies::{build, check_history, counts, euler_characteristic, true_counts};

/// The planes as the paper's code publishes them: two slabs a few hundredths thick, cut by others.
const PLANES: [Coefficients; 11] = [
    [-0.2840365469455719, -0.9563649892807007, -0.0684785395860672, -4.3069167137146],
    [-0.4269607663154602, -0.9034146666526794, 0.039323657751083374, -4.109272480010986],
    [0.4125642478466034, 0.9070128798484802, -0.08437052369117737, 4.1034626960754395],
    [-0.28315502405166626, 0.8755069375038147, 0.3915492296218872, 3.8051040172576904],
    [-0.958615243434906, 0.28470486402511597, 0.0, 0.425659716129303],
    [-0.019496172666549683, -0.06564456969499588, 0.9976526498794556, 0.5745928287506104],
    [0.958615243434906, -0.28470486402511597, 0.0, -0.39629310369491577],
    [0.019496172666549683, 0.06564456969499588, -0.9976526498794556, -0.5452262163162231],
    [0.28315502405166626, -0.8755069375038147, -0.3915492296218872, -3.7757372856140137],
    [0.9590741395950317, 0.25848281383514404, 0.11560016870498657, 1.9914697408676147],
    [-0.9590741395950317, -0.25848281383514404, -0.11560016870498657, -1.962103009223938],
];

#[test]
fn test_edge_case_polytope() {
    let (polytope, _) = build(&PLANES, 0.0);
    assert!(polytope.is_bounded());
    assert_eq!(counts(&polytope), true_counts(&PLANES));
    assert_eq!(polytope.vertex_count(), 18);
    assert_eq!(euler_characteristic(&polytope), 2);
    assert_eq!(polytope.validate_topology(), Ok(()));
}

/// Every order gives the same polytope, and on the way faces lose all their corners in one cut and stay.
#[test]
fn orphaned_faces_of_the_edge_case_find_their_corners() {
    let mut rng = Rng::new(first_seed());
    let mut planes = PLANES;
    let mut orphaned = 0;
    for _ in 0..100 {
        rng.shuffle(&mut planes);
        orphaned += orphans_while_building(&planes);
        let (polytope, _) = build(&planes, 0.0);
        assert_eq!(counts(&polytope), true_counts(&PLANES), "{planes:?}");
    }
    assert!(orphaned > 100, "only {orphaned} faces lost all their corners");
}

#[test]
fn the_edge_case_with_each_plane_taken_back() {
    check_history(&PLANES);
}

/// How often a cut took all finite corners of a face that is still there after it.
fn orphans_while_building(planes: &[Coefficients]) -> usize {
    let mut polytope = IncrementalPolytope::new();
    let mut count = 0;
    for &plane in planes {
        let before: Vec<(PlaneIdx, Vec<Corner>)> = corners_by_plane(&polytope);
        polytope.add_plane(half_space(plane));
        let after: Vec<Corner> = corners(&polytope);
        count += before
            .iter()
            .filter(|(face, old)| {
                !polytope.is_redundant(*face) && !old.is_empty() && !old.iter().any(|corner| after.contains(corner))
            })
            .count();
    }
    count
}

type Corner = [Option<PlaneIdx>; 3];

/// The finite corners of the simple structure.
fn corners(polytope: &IncrementalPolytope) -> Vec<Corner> {
    polytope
        .simple_vertices()
        .filter(|corner| corner.iter().all(Option::is_some))
        .map(|mut corner| {
            corner.sort_unstable();
            corner
        })
        .collect()
}

fn corners_by_plane(polytope: &IncrementalPolytope) -> Vec<(PlaneIdx, Vec<Corner>)> {
    let all = corners(polytope);
    let on = |plane: PlaneIdx| all.iter().filter(|corner| corner.contains(&Some(plane))).copied().collect();
    polytope.planes().map(|(plane, _)| (plane, on(plane))).collect()
}
