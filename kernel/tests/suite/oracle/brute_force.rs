//! Small polytopes against the definition: all triples of planes, in exact arithmetic, with the
//! symbolic perturbation for the structure and without it for the mesh.

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::campaign::Campaign;
use planecut_oracle::category::Category;
use planecut_oracle::check::compare_with_truth;
use planecut_oracle::settings::{cases, operations};
use planecut_oracle::test_each_category;

/// Operations per category unless `PLANECUT_OPS` says otherwise.
const OPERATIONS: usize = 1_000;
/// Most planes at one time: the oracle takes O(n⁴).
const PLANES: usize = 9;

test_each_category!(equals_the_definition);

fn equals_the_definition(category: Category) {
    let campaign = Campaign {
        operations: operations(OPERATIONS),
        cases: cases(1),
        capacity: PLANES,
        // Without contraction: coincident vertices are merged because they are equal, not because they are near.
        start: || IncrementalPolytope::with_epsilon(0.0),
        check: compare_with_truth,
    };
    let tally = campaign.run(category);
    let reveals = tally.revealed > 0 || !category.hides_planes();
    assert!(tally.removals > 0 && reveals, "{category:?} reveals nothing: {tally:?}");
}
