//! Removals from Fibonacci spheres: the paper's unit test, its stress test and its range of tolerances.

use planecut_kernel::DVec3;
use planecut_oracle::exact::Coefficients;
use planecut_oracle::generators::fibonacci;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;
use planecut_oracle::structure::Structure;

use super::bodies::{build, counts, euler_characteristic, true_counts, without};

/// The paper's sizes (§3.7): each round removes every plane of each once.
const SIZES: [usize; 4] = [20, 30, 40, 50];
/// Rounds of the stress test.
const ROUNDS: usize = 100;
/// The paper's tolerances (§3.7.1).
const TOLERANCES: [f64; 6] = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

fn sphere(n: usize) -> Vec<Coefficients> {
    (0..n).map(|k| fibonacci(k, n)).collect()
}

#[test]
fn test_validate_topology_after_removal() {
    let planes = sphere(20);
    let (mut polytope, handles) = build(&planes, 0.0);
    assert_eq!(polytope.validate_topology(), Ok(()));
    assert!(polytope.remove_plane(handles[5]).is_some());
    assert_eq!(polytope.validate_topology(), Ok(()));
    assert_eq!(counts(&polytope), true_counts(&without(&planes, 5)));
}

/// 14,000 removals, each from a whole sphere; every round has the planes in another order. The exact outline is asked
/// in the first round, Euler's formula always.
#[test]
fn validation_stress_test() {
    let mut rng = Rng::new(first_seed());
    let mut removals = 0;
    for round in 0..ROUNDS {
        for n in SIZES {
            let mut planes = sphere(n);
            rng.shuffle(&mut planes);
            let (whole, handles) = build(&planes, planecut_kernel::DEFAULT_EPSILON);
            for (k, &handle) in handles.iter().enumerate() {
                let mut polytope = whole.clone();
                assert!(polytope.remove_plane(handle).is_some());
                assert_eq!(euler_characteristic(&polytope), 2, "plane {k} of {planes:?}");
                assert_eq!(polytope.validate_topology(), Ok(()), "plane {k} of {planes:?}");
                if round == 0 {
                    assert_eq!(counts(&polytope), true_counts(&without(&planes, k)), "plane {k} of {planes:?}");
                }
                removals += 1;
            }
        }
    }
    assert_eq!(removals, 14_000);
}

/// The tolerance decides nothing inside, and nothing outside where no edge is as short as it.
#[test]
fn epsilon_sensitivity_analysis() {
    let mut removals = 0;
    for n in SIZES {
        let planes = sphere(n);
        for k in 0..n {
            let expected = true_counts(&without(&planes, k));
            for epsilon in TOLERANCES {
                let (mut polytope, mut order) = build(&planes, epsilon);
                assert!(polytope.remove_plane(order.remove(k)).is_some());
                assert_eq!(counts(&polytope), expected, "tolerance {epsilon:e}, plane {k} of {n}");
                assert_eq!(euler_characteristic(&polytope), 2);
                removals += 1;
            }
        }
    }
    assert_eq!(removals, TOLERANCES.len() * SIZES.iter().sum::<usize>());
}

/// A chamfer of width 2e-8 is seen by the tolerances below it, contracted by those above, and there for all of them.
#[test]
fn edges_between_two_tolerances() {
    let cut = DVec3::new(1.0, 1.0, 0.0);
    let width = 2e-8;
    let mut planes = super::bodies::CUBE.to_vec();
    planes.push([cut.x, cut.y, cut.z, 2.0 - width]);
    let reference = Structure::of_planes(&planes);
    let mut seen = Vec::new();
    for epsilon in TOLERANCES {
        let (polytope, order) = build(&planes, epsilon);
        assert_eq!(Structure::of(&polytope, &order).as_ref(), Ok(&reference), "tolerance {epsilon:e}");
        assert_eq!(euler_characteristic(&polytope), 2, "tolerance {epsilon:e}");
        assert_eq!(polytope.check_invariants(), Ok(()));
        assert_eq!(polytope.validate_topology(), Ok(()), "tolerance {epsilon:e}");
        seen.push(counts(&polytope));
    }
    let (contracted, whole) = ([8, 12, 6], true_counts(&planes));
    let expected = TOLERANCES.map(|epsilon| if epsilon > width { contracted } else { whole });
    assert_eq!(seen, expected);
    assert_ne!(contracted, whole);
}
