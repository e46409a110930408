//! `clone_from` into a polytope that held something else, and the default.

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::category::Category;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;
use planecut_oracle::settings::first_seed;
use planecut_oracle::structure::Structure;

/// After any script of each of these kinds, one object takes over the state and goes on like the one it came from.
#[test]
fn what_was_there_before_does_not_matter() {
    let mut rng = Rng::new(first_seed());
    let mut reused = IncrementalPolytope::new();
    for category in [Category::Peel, Category::EmptyAndBack, Category::Grid, Category::Unbounded, Category::Prism] {
        for _ in 0..20 {
            let ops = category.script(&mut rng, 20);
            let mut replay = Replay::new(IncrementalPolytope::default());
            let half = ops.len() / 2;
            for (step, op) in ops.iter().enumerate() {
                replay.apply(op).unwrap_or_else(|e| panic!("{category:?}: {e}\n{ops:?}"));
                if step == half {
                    reused.clone_from(&replay.polytope);
                    assert_eq!(reused.check_invariants(), Ok(()));
                    std::mem::swap(&mut replay.polytope, &mut reused);
                }
                let order = replay.order();
                let fresh = Structure::of_fresh_build(&replay.polytope, &order);
                assert_eq!(Structure::of(&replay.polytope, &order), fresh, "{category:?}\n{ops:?}");
            }
        }
    }
}
