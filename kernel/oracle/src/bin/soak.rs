//! Runs random operations of all kinds on all cores, each compared with the oracle, until there are enough.
//!
//! `PLANECUT_OPS` is the least number of operations (ten million unless set), `PLANECUT_SEED` the first seed. After
//! every operation the invariants are checked and the structure is compared with a fresh build; samples are compared
//! with the exact outline and with the whole definition. Ends with status 1 and a minimal script on a difference.

use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::thread;
use std::time::Instant;

use planecut_kernel::IncrementalPolytope;
use planecut_oracle::campaign::Campaign;
use planecut_oracle::category::Category;
use planecut_oracle::check::{compare_with_fresh_build, compare_with_outline, compare_with_truth};
use planecut_oracle::random::Rng;
use planecut_oracle::replay::{Replay, Tally};
use planecut_oracle::settings::{first_seed, operations};

/// Most planes at one time, script by script.
const CAPACITIES: [usize; 8] = [6, 8, 10, 12, 16, 24, 48, 128];
/// One operation in this many is compared with the outline, where there are few enough planes.
const OUTLINE_EVERY: usize = 7;
const OUTLINE_PLANES: usize = 16;
/// One operation in this many is compared with the definition, where there are few enough planes.
const TRUTH_EVERY: usize = 29;
const TRUTH_PLANES: usize = 10;

static OPERATIONS: AtomicUsize = AtomicUsize::new(0);
static OUTLINES: AtomicUsize = AtomicUsize::new(0);
static TRUTHS: AtomicUsize = AtomicUsize::new(0);

fn main() -> ExitCode {
    let (goal, start) = (operations(10_000_000), Instant::now());
    let (round, failed) = (AtomicU64::new(0), AtomicBool::new(false));
    let totals = Mutex::new([(0usize, Tally::default()); Category::ALL.len()]);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while OPERATIONS.load(Relaxed) < goal && !failed.load(Relaxed) {
                    let round = round.fetch_add(1, Relaxed);
                    let kind = (round % Category::ALL.len() as u64) as usize;
                    if let Some(tally) = run(Category::ALL[kind], round) {
                        let mut totals = totals.lock().expect("no thread panics");
                        totals[kind].0 += 1;
                        totals[kind].1.absorb(&tally);
                    } else {
                        failed.store(true, Relaxed);
                    }
                }
            });
        }
    });
    let totals = totals.into_inner().expect("no thread panics");
    for (category, (cases, tally)) in Category::ALL.iter().zip(&totals) {
        println!("{:<22}{cases:>8} cases{:>10} operations", format!("{category:?}"), tally.operations);
    }
    let sum = totals.iter().map(|(_, tally)| tally.operations).sum::<usize>();
    let (outlines, truths) = (OUTLINES.load(Relaxed), TRUTHS.load(Relaxed));
    println!("{sum} operations in {:.0} s, each compared with a fresh build;", start.elapsed().as_secs_f64());
    println!("{outlines} compared with the exact outline, {truths} with the whole definition");
    if failed.into_inner() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Runs one script; on a failure prints it and returns `None`.
fn run(category: Category, round: u64) -> Option<Tally> {
    let seed = first_seed().wrapping_add(round.wrapping_mul(0x100));
    let capacity = CAPACITIES[(round / Category::ALL.len() as u64) as usize % CAPACITIES.len()];
    let campaign = Campaign {
        operations: 1,
        cases: 1,
        capacity,
        // without contraction: vertices are merged because they are equal, not because they are near
        start: || IncrementalPolytope::with_epsilon(0.0),
        check,
    };
    let ops = category.script(&mut Rng::new(seed), capacity);
    match campaign.attempt(&ops) {
        Ok(tally) => Some(tally),
        Err(error) => {
            println!("{category:?}, seed {seed}, capacity {capacity}: {}", campaign.report(ops, &error));
            None
        }
    }
}

fn check(replay: &Replay) -> Result<(), String> {
    compare_with_fresh_build(replay)?;
    let operation = OPERATIONS.fetch_add(1, Relaxed);
    let planes = replay.order().len();
    if operation.is_multiple_of(OUTLINE_EVERY) && planes <= OUTLINE_PLANES {
        OUTLINES.fetch_add(1, Relaxed);
        compare_with_outline(replay)?;
    }
    if operation.is_multiple_of(TRUTH_EVERY) && planes <= TRUTH_PLANES {
        TRUTHS.fetch_add(1, Relaxed);
        compare_with_truth(replay)?;
    }
    Ok(())
}
