//! Runs many scripts; a failing one is shrunk to a few operations before it is reported.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;
use std::time::{Duration, Instant};

use planecut_kernel::IncrementalPolytope;

use crate::category::Category;
use crate::kernel_calls::is_accepted;
use crate::random::Rng;
use crate::replay::{Replay, Tally};
use crate::script::{Op, as_rust};
use crate::settings::first_seed;
use crate::watchdog::watch;

/// A check that is run after every operation.
pub type Check = fn(&Replay) -> Result<(), String>;

/// Shrinking stops after this time with what it has.
const SHRINK_TIME: Duration = Duration::from_secs(20);

/// How one test drives the scripts of a category.
pub struct Campaign {
    /// Lower bound on the number of operations.
    pub operations: usize,
    /// Lower bound on the number of scripts.
    pub cases: usize,
    /// Most planes at one time.
    pub capacity: usize,
    /// The polytope every script starts from.
    pub start: fn() -> IncrementalPolytope,
    /// What is checked after every operation.
    pub check: Check,
}

impl Campaign {
    /// Runs scripts of one category until enough of them and enough operations are done.
    ///
    /// # Panics
    /// With a minimal script on the first failure.
    pub fn run(&self, category: Category) -> Tally {
        let mut total = Tally::default();
        for round in 0.. {
            if total.operations >= self.operations && round as usize >= self.cases {
                break;
            }
            let seed = first_seed().wrapping_add(round << 8);
            let ops = category.script(&mut Rng::new(seed), self.capacity);
            match self.attempt(&ops) {
                Ok(tally) => total.absorb(&tally),
                Err(first) => {
                    panic!("{category:?}, PLANECUT_SEED={seed}: {}", self.report(ops, &first));
                }
            }
        }
        println!("{category:?}: {total:?}");
        total
    }

    /// Runs one script; a panic of the kernel counts as a failure.
    ///
    /// # Errors
    /// The first failure, with the number of operations done.
    pub fn attempt(&self, ops: &[Op]) -> Result<Tally, String> {
        silence_expected_panics();
        let _watch = watch(ops);
        QUIET.set(true);
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let mut replay = Replay::new((self.start)());
            for (step, op) in ops.iter().enumerate() {
                let result = replay.apply(op).and_then(|()| (self.check)(&replay));
                result.map_err(|e| format!("after operation {step}: {e}"))?;
            }
            Ok(replay.tally)
        }));
        QUIET.set(false);
        outcome.unwrap_or_else(|payload| {
            let text = payload.downcast_ref::<String>().map(String::as_str);
            Err(format!("panic: {}", text.or(payload.downcast_ref::<&str>().copied()).unwrap_or("?")))
        })
    }

    /// Shrinks a script that failed with `error` and writes both down, the script as Rust.
    #[must_use]
    pub fn report(&self, ops: Vec<Op>, error: &str) -> String {
        let (ops, last) = self.shrink(ops, error);
        format!("{last}\n(before shrinking: {error})\n{}", as_rust(&ops))
    }

    /// Leaves out operations, in ever smaller pieces, then makes coefficients rounder.
    fn shrink(&self, mut ops: Vec<Op>, error: &str) -> (Vec<Op>, String) {
        let start = Instant::now();
        let mut error = error.to_owned();
        let mut piece = ops.len().div_ceil(2);
        while piece > 0 && start.elapsed() < SHRINK_TIME {
            let mut progress = false;
            let mut from = 0;
            while from < ops.len() && start.elapsed() < SHRINK_TIME {
                let mut candidate = ops.clone();
                candidate.drain(from..(from + piece).min(ops.len()));
                if let Err(e) = self.attempt(&candidate) {
                    (ops, error, progress) = (candidate, e, true);
                } else {
                    from += piece;
                }
            }
            piece = if progress && piece == 1 { 1 } else { piece / 2 };
        }
        for k in 0..ops.len() {
            for digits in [1.0, 10.0, 1000.0] {
                let mut candidate = ops.clone();
                if start.elapsed() < SHRINK_TIME
                    && round(&mut candidate[k], digits)
                    && let Err(e) = self.attempt(&candidate)
                {
                    (ops, error) = (candidate, e);
                    break;
                }
            }
        }
        (ops, error)
    }
}

/// Rounds a plane to multiples of `1 / digits`; false where that changes nothing or is no plane.
fn round(op: &mut Op, digits: f64) -> bool {
    let (Op::Add { plane, .. } | Op::Move { plane, .. }) = op else { return false };
    let rounded = plane.map(|v| (v * digits).round() / digits);
    let changed = rounded != *plane && is_accepted(rounded);
    if changed {
        *plane = rounded;
    }
    changed
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Keeps panics that [`Campaign::attempt`] catches off the screen, on this thread only.
fn silence_expected_panics() {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |info| {
            if !QUIET.get() {
                usual(info);
            }
        }));
    });
}
