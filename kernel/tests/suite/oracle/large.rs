//! Polytopes of hundreds of planes, where climbs start from the cells of a cube map: their planes come and go, and others take
//! their slots. Now and then the structure is compared with a fresh build.

use planecut_kernel::{IncrementalPolytope, PlaneIdx};
use planecut_oracle::check::compare_with_fresh_build;
use planecut_oracle::exact::Coefficients;
use planecut_oracle::generators::{cube, fibonacci, plane};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;
use planecut_oracle::script::Op;
use planecut_oracle::settings::{first_seed, operations};

/// Planes at the beginning: the table of starts has grown several times by then.
const PLANES: usize = 900;
/// Operations after that, unless `PLANECUT_OPS` says otherwise.
const OPERATIONS: usize = 1_500;
/// Operations between two comparisons.
const BETWEEN: usize = 60;

/// Runs operations on planes made by `new_plane`, one script from the seed.
fn stays_equal_to_a_fresh_build(mut new_plane: impl FnMut(&mut Rng) -> Coefficients) {
    let seed = first_seed();
    let mut rng = Rng::new(seed);
    let mut replay = Replay::new(IncrementalPolytope::new());
    let mut names: Vec<usize> = Vec::new();
    let mut comparisons = 0;
    let planes: Vec<Coefficients> =
        cube(&mut rng, 8.0).into_iter().chain((0..PLANES).map(|_| new_plane(&mut rng))).collect();
    let mut ops: Vec<Op> = planes.into_iter().enumerate().map(|(name, plane)| Op::Add { name, plane }).collect();
    names.extend(6..ops.len());
    for name in ops.len()..ops.len() + operations(OPERATIONS) {
        let mut take = |rng: &mut Rng| names.swap_remove(rng.below(names.len()));
        // as many come as go
        match rng.below(10) {
            0..3 => ops.push(Op::Remove { name: take(&mut rng) }),
            3 => ops.push(Op::RemoveMany { names: (0..rng.below(5)).map(|_| take(&mut rng)).collect() }),
            4 => ops.push(Op::Move { name: rng.pick(&names), plane: new_plane(&mut rng) }),
            _ => {
                ops.push(Op::Add { name, plane: new_plane(&mut rng) });
                names.push(name);
            }
        }
    }
    for (k, op) in ops.iter().enumerate() {
        replay.apply(op).unwrap_or_else(|e| panic!("seed {seed}, operation {k}, {op:?}: {e}"));
        if k >= PLANES && k % BETWEEN == 0 {
            compare_with_fresh_build(&replay)
                .unwrap_or_else(|e| panic!("seed {seed}, after operation {k}, {op:?}: {e}"));
            comparisons += 1;
        }
    }
    let tally = &replay.tally;
    assert!(comparisons >= 20 && tally.removals > 100 && tally.moved > 50, "{comparisons} comparisons, {tally:?}");
    assert!(replay.polytope.planes().count() > PLANES / 2, "hardly a large polytope");
}

#[test]
fn directions_everywhere() {
    stays_equal_to_a_fresh_build(|rng| plane(rng.direction(), 1.0 + rng.float(0.0, 0.01)));
}

/// All in one cell, and most of them redundant.
#[test]
fn directions_in_a_narrow_cone() {
    stays_equal_to_a_fresh_build(|rng| {
        let [x, y] = [rng.float(-0.01, 0.01), rng.float(-0.01, 0.01)];
        plane([x, y, 1.0], 1.0 + 0.5 * (x * x + y * y) + rng.float(0.0, 1e-5))
    });
}

/// On the borders of the cells and on their corners, with planes through one point.
#[test]
fn directions_of_a_lattice() {
    stays_equal_to_a_fresh_build(|rng| {
        let [x, y, z] = rng.lattice(4);
        let n = if [x, y, z] == [0.0; 3] { [1.0, 1.0, -1.0] } else { [x, y, z] };
        plane(n, n.map(f64::abs).iter().sum::<f64>() + rng.whole(0, 3))
    });
}

/// Small beside its distance from the origin: every plane is met from the same side.
#[test]
fn a_ball_far_from_the_origin() {
    stays_equal_to_a_fresh_build(|rng| {
        let n = rng.direction();
        plane(n, 3.0 * n[0] - 2.0 * n[1] + n[2] + 0.125)
    });
}

/// More vertices than the caches near the processor hold: faces are then fetched before they are removed.
#[test]
fn a_ball_of_many_planes() {
    const COUNT: usize = 26_000;
    let mut ball = IncrementalPolytope::new();
    for k in 0..COUNT {
        ball.add_plane(half_space(fibonacci(k, COUNT)));
    }
    // a simple polytope, by Euler
    let vertices = 2 * COUNT - 4;
    let seed = first_seed();
    let mut rng = Rng::new(seed);
    for _ in 0..6 {
        let k = rng.below(COUNT);
        assert!(ball.remove_plane(PlaneIdx(k)).is_some(), "seed {seed}: plane {k}");
        assert_eq!(ball.simple_vertices().count(), vertices - 2, "seed {seed}: without plane {k}");
        assert_eq!(ball.check_invariants(), Ok(()), "seed {seed}: without plane {k}");
        assert_eq!(ball.add_plane(half_space(fibonacci(k, COUNT))).plane(), PlaneIdx(k));
    }
    assert_eq!(ball.simple_vertices().count(), vertices, "seed {seed}");
}
