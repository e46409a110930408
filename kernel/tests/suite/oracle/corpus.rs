//! The fuzzing corpus without the fuzzer; an input that fails is shrunk operation by operation.

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::campaign::Campaign;
use planecut_oracle::check::check_in_layers;
use planecut_oracle::decode;
use planecut_oracle::replay::Tally;
use planecut_testkit::corpus::fuzz_corpus;

#[test]
fn corpus_of_the_fuzzer() {
    let start = || IncrementalPolytope::with_epsilon(0.0);
    let campaign = Campaign { operations: 1, cases: 1, capacity: decode::CAPACITY, start, check: check_in_layers };
    let mut total = Tally::default();
    for (path, bytes) in fuzz_corpus("operations") {
        let ops = decode::script(&bytes);
        match campaign.attempt(&ops) {
            Ok(tally) => total.absorb(&tally),
            Err(error) => panic!("{}: {}", path.display(), campaign.report(ops, &error)),
        }
    }
    println!("{total:?}");
    let happened = [total.removals, total.moved, total.revealed, total.emptied, total.revived, total.unbounded];
    assert!(happened.iter().all(|&n| n > 0), "the corpus is too tame: {total:?}");
}
