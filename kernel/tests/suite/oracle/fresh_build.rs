//! The structure is a function of the planes and their order alone: whatever was added and removed
//! before, it equals a fresh build of what is left.

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::campaign::Campaign;
use planecut_oracle::category::Category;
use planecut_oracle::check::compare_with_fresh_build;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;
use planecut_oracle::settings::{cases, first_seed, operations};
use planecut_oracle::structure::Structure;
use planecut_oracle::test_each_category;

/// Operations per category unless `PLANECUT_OPS` says otherwise.
const OPERATIONS: usize = 12_000;

test_each_category!(equals_a_fresh_build);

fn equals_a_fresh_build(category: Category) {
    let campaign = Campaign {
        operations: operations(OPERATIONS),
        cases: cases(1),
        capacity: 24,
        start: IncrementalPolytope::new,
        check: compare_with_fresh_build,
    };
    let tally = campaign.run(category);
    assert!(tally.removals * 10 > tally.operations, "{category:?} hardly removes: {tally:?}");
    if category.hides_planes() {
        assert!(tally.removed_redundant > 0 && tally.added_redundant > 0, "{category:?} hides nothing: {tally:?}");
        assert!(tally.revealed > 0, "{category:?} reveals nothing: {tally:?}");
    }
    if matches!(category, Category::EmptyAndBack | Category::Thin | Category::Duplicates) {
        assert!(tally.emptied > 0 && tally.revived > 0, "{category:?} is never empty: {tally:?}");
    }
    if matches!(category, Category::Unbounded | Category::Prism) {
        assert!(tally.unbounded > 0, "{category:?} is always bounded: {tally:?}");
    }
}

/// A clone and its original go separate ways.
#[test]
fn a_clone_is_independent() {
    let mut rng = Rng::new(first_seed());
    let mut compared = 0;
    for category in [Category::Peel, Category::EmptyAndBack, Category::Grid] {
        let ops = category.script(&mut rng, 20);
        let mut replay = Replay::new(IncrementalPolytope::new());
        for op in &ops {
            replay.apply(op).unwrap_or_else(|e| panic!("{category:?}: {e}\n{ops:?}"));
            let order = replay.order();
            let before = Structure::of(&replay.polytope, &order).expect("consistent");
            let mut copy = replay.polytope.clone();
            assert_eq!(Structure::of(&copy, &order).as_ref(), Ok(&before));
            for &index in &order {
                assert!(copy.remove_plane(index).is_some());
            }
            assert_eq!(Structure::of(&replay.polytope, &order).as_ref(), Ok(&before));
            assert!(!copy.is_empty() && !copy.is_bounded() && copy.planes().next().is_none());
            compared += 1;
        }
    }
    assert!(compared > 60, "only {compared} steps");
}

/// After `clear` handles, stamps and structure are those of a new polytope.
#[test]
fn a_cleared_polytope_is_like_a_new_one() {
    let mut rng = Rng::new(first_seed());
    let categories = [Category::EmptyAndBack, Category::Grid, Category::Peel, Category::Prism, Category::Wedge];
    let mut used = IncrementalPolytope::new();
    for round in 0..100 {
        let category = rng.pick(&categories);
        let ops = category.script(&mut rng, 20);
        used.clear();
        let (mut cleared, mut new) = (Replay::new(used), Replay::new(IncrementalPolytope::new()));
        for op in &ops[..rng.below(ops.len()).max(5)] {
            for replay in [&mut cleared, &mut new] {
                replay.apply(op).unwrap_or_else(|e| panic!("round {round}, {category:?}: {e}\n{ops:?}"));
            }
            let (order, polytope) = (new.order(), &cleared.polytope);
            assert_eq!(cleared.order(), order);
            assert_eq!(polytope.check_invariants(), Ok(()));
            assert_eq!(Structure::of(polytope, &order), Structure::of(&new.polytope, &order), "{category:?}\n{ops:?}");
            let stamps = |p: &IncrementalPolytope| order.iter().map(|&i| p.stamp(i)).collect::<Vec<_>>();
            assert_eq!(stamps(polytope), stamps(&new.polytope));
        }
        used = cleared.polytope;
    }
}
