//! What is written comes back as it was, and what cannot have been written is refused (feature `serde`).

use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use planecut_oracle::category::Category;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;
use planecut_oracle::settings::first_seed;
use planecut_oracle::structure::Structure;
use planecut_testkit::saved::{refusal, through_data};
use serde_json::{Value, from_value, json, to_value};

/// The structure, the handles and stamps, and the handle that comes next.
#[test]
fn polytopes_come_back_with_their_structure() {
    let mut compared = 0;
    for category in Category::ALL {
        let mut replay = Replay::new(IncrementalPolytope::new());
        for op in category.script(&mut Rng::new(first_seed()), 16) {
            replay.apply(&op).unwrap_or_else(|error| panic!("{category:?}: {error}"));
            let mut copy = through_data(&replay.polytope);
            let order = replay.order();
            assert_eq!(Structure::of(&copy, &order), Structure::of(&replay.polytope, &order), "{category:?}");
            let planes = |polytope: &IncrementalPolytope| -> Vec<(PlaneIdx, HalfSpace, Option<u64>)> {
                polytope.planes().map(|(plane, half_space)| (plane, *half_space, polytope.stamp(plane))).collect()
            };
            assert_eq!(planes(&copy), planes(&replay.polytope), "{category:?}");
            let next = HalfSpace::new([1.0, 2.0, 3.0], 4.0).expect("it is accepted");
            assert_eq!(copy.add_plane(next).plane(), replay.polytope.clone().add_plane(next).plane(), "{category:?}");
            compared += 1;
        }
    }
    assert!(compared > 500, "{compared} polytopes");
}

#[test]
fn half_spaces_are_four_numbers_and_checked() {
    let half_space = HalfSpace::new([0.1, -2.0, 3.0], 1e-9).expect("it is accepted");
    assert_eq!(to_value(half_space).expect("it can be written"), json!([0.1, -2.0, 3.0, 1e-9]));
    assert_eq!(through_data(&half_space), half_space);
    assert!(refusal::<HalfSpace>(json!([0.0, 0.0, 0.0, 1.0])).contains("must not be zero"));
    assert!(refusal::<HalfSpace>(json!([1e200, 0.0, 0.0, 1.0])).contains("outside the accepted range"));
    assert!(refusal::<HalfSpace>(json!([1.0, 0.0, 0.0])).contains("invalid length"));
}

#[test]
fn results_come_back() {
    let mut octant = IncrementalPolytope::new();
    for normal in [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]] {
        octant.add_plane(HalfSpace::new(normal, 0.0).expect("it is accepted"));
    }
    let views = (octant.vertices().collect::<Vec<_>>(), octant.edges().collect::<Vec<_>>(), octant.faces());
    assert_eq!(through_data(&views), views);
    let queries = (octant.recession_cone(), octant.face_polygon(PlaneIdx(0)), octant.closest_point([-1.0; 3]));
    assert_eq!(through_data(&queries), queries);
    octant.add_plane(HalfSpace::new([1.0, 1.0, 1.0], 1.0).expect("it is accepted"));
    let measures = (octant.measures(), octant.bounding_box(), octant.interior_point(), octant.chebyshev_ball());
    assert_eq!(through_data(&measures), measures);
}

#[test]
fn polytopes_that_cannot_be_are_refused() {
    let plane =
        |handle: usize, stamp: u64| json!({"plane": handle, "stamp": stamp, "half_space": [1.0, 0.0, 0.0, 1.0]});
    let polytope = |planes: &[Value], free: &[usize], next_stamp: u64| json!({"epsilon": 0.0, "planes": planes, "free": free, "next_stamp": next_stamp});
    assert!(from_value::<IncrementalPolytope>(polytope(&[plane(1, 4), plane(2, 6)], &[0], 7)).is_ok());
    let refused = |data: Value| refusal::<IncrementalPolytope>(data);
    assert!(
        refused(polytope(&[plane(0, 4), plane(0, 5)], &[], 6)).contains("found handle 0, expected each below 2 once")
    );
    assert!(refused(polytope(&[plane(7, 4)], &[], 6)).contains("found handle 7"));
    assert!(refused(polytope(&[plane(0, 4)], &[0], 6)).contains("found handle 0"));
    assert!(refused(polytope(&[plane(0, 4), plane(1, 4)], &[], 6)).contains("found stamp 4 twice"));
    assert!(refused(polytope(&[plane(0, 3)], &[], 6)).contains("found stamp 3"));
    assert!(refused(polytope(&[plane(0, 6)], &[], 6)).contains("found stamp 6"));
    assert!(refused(polytope(&[], &[], 0)).contains("next stamp"));
    let mut unknown = polytope(&[], &[], 4);
    unknown["more"] = json!(1);
    assert!(refused(unknown).contains("unknown field"));
}
