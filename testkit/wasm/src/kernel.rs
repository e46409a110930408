//! The kernel: polytopes against what is known of them, and random operations against the oracle.

use planecut_kernel::{AddPlaneResult, HalfSpace, IncrementalPolytope, Location, hull};
use planecut_oracle::category::Category;
use planecut_oracle::check::check_in_layers;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;

/// Most planes of a random script.
const CAPACITY: usize = 12;

pub(crate) fn check() {
    planes_come_and_go();
    an_empty_set_comes_back();
    an_unbounded_set_is_queried();
    a_hull_contains_its_points();
    random_operations_agree_with_the_oracle();
}

fn half_space(coefficients: [f64; 4]) -> HalfSpace {
    HalfSpace::from_array(coefficients).expect("the coefficients are accepted")
}

/// The cube `[-1, 1]³`.
fn cube() -> IncrementalPolytope {
    let mut cube = IncrementalPolytope::new();
    for axis in 0..3 {
        for side in [1.0, -1.0] {
            let mut normal = [0.0; 3];
            normal[axis] = side;
            cube.add_plane(HalfSpace::new(normal, 1.0).expect("a unit normal is accepted"));
        }
    }
    cube
}

fn planes_come_and_go() {
    let mut cube = cube();
    let volume = |polytope: &IncrementalPolytope| polytope.measures().map(|measures| measures.volume);
    assert_eq!(volume(&cube), Some(8.0));
    let corner = cube.add_plane(half_space([1.0, 1.0, 1.0, 2.0])).plane();
    assert_eq!((cube.vertex_count(), cube.edge_count(), volume(&cube)), (10, 15, Some(8.0 - 1.0 / 6.0)));
    assert!(cube.move_plane(corner, half_space([1.0, 1.0, 1.0, 1.0])).is_some());
    assert_eq!(volume(&cube), Some(8.0 - 8.0 / 6.0));
    assert!(cube.remove_plane(corner).is_some());
    assert_eq!((cube.vertex_count(), cube.edge_count(), volume(&cube)), (8, 12, Some(8.0)));
    assert!(cube.validate_topology().is_ok());
}

fn an_empty_set_comes_back() {
    let mut cube = cube();
    let beyond = cube.add_plane(half_space([1.0, 0.0, 0.0, -2.0]));
    assert!(matches!(beyond, AddPlaneResult::Empty { .. }));
    let beyond = beyond.plane();
    assert!(cube.is_empty() && cube.emptiness_witness().is_some_and(|planes| planes.contains(&beyond)));
    assert!(cube.remove_plane(beyond).is_some());
    assert_eq!(cube.vertex_count(), 8);
}

fn an_unbounded_set_is_queried() {
    let mut octant = IncrementalPolytope::new();
    for normal in [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]] {
        octant.add_plane(HalfSpace::new(normal, 0.0).expect("a unit normal is accepted"));
    }
    assert!(!octant.is_bounded() && octant.measures().is_none());
    assert_eq!((octant.recession_cone().rays.len(), octant.distance([-3.0, 0.0, -4.0])), (3, 5.0));
    assert_eq!(octant.to_mesh_clipped([-1.0; 3], [1.0; 3]).0.len(), 8);
}

fn a_hull_contains_its_points() {
    let mut rng = Rng::new(1);
    let points: Vec<[f64; 3]> = (0..200).map(|_| rng.direction()).collect();
    let hull = hull(&points).expect("random points span space");
    assert!(hull.is_bounded() && points.iter().all(|point| hull.classify(*point) != Location::Outside));
}

fn random_operations_agree_with_the_oracle() {
    for category in Category::ALL {
        let mut replay = Replay::new(IncrementalPolytope::with_epsilon(0.0));
        for op in category.script(&mut Rng::new(1), CAPACITY) {
            let result = replay.apply(&op).and_then(|()| check_in_layers(&replay));
            result.unwrap_or_else(|error| panic!("{category:?}: {error}"));
        }
    }
}
