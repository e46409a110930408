//! What threads could gain within one removal (the paper's §8, "parallel line search"): how long removing a face takes that
//! has very many neighbours, and what handing half of a task to another thread costs.

use crate::case::{Sampler, microseconds, remove_first};
use crate::plan::Case;
use planecut_bench::inputs::{Plane, pyramid, roof};
use planecut_bench::library::{Library, Planecut};
use std::hint::{black_box, spin_loop};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Removing the base of a pyramid, whose sides all meet in one point: nothing closes the set below.
pub(crate) const RING: &str = "remove a pyramid's base";
/// Removing the base of a roof in general position above a floor.
pub(crate) const ROOF: &str = "remove a roof's base";
/// A fork whose second half the same thread does: nothing is gained.
pub(crate) const FORK_ALONE: &str = "rayon::join on one thread";
/// A fork whose second half another thread has begun.
pub(crate) const FORK_SHARED: &str = "rayon::join until the second thread has begun";

const FORKS: usize = 200;

/// The rings, and the two forks.
pub(crate) fn cases(quick: bool) -> Vec<Case> {
    let sides: &[usize] = if quick { &[200] } else { &[6, 20, 50, 200, 500, 1000, 3000] };
    let batch = |sides: usize| (2000 / sides).clamp(1, 100);
    let case = |name, sides: usize, planes: &[Plane]| {
        Case::new(name, sides, Planecut::NAME, remove_first::<Planecut>(planes, batch(sides)))
    };
    let mut cases: Vec<Case> = sides.iter().map(|sides| case(ROOF, *sides, &roof(*sides))).collect();
    cases.extend(sides.iter().map(|sides| case(RING, *sides, &pyramid(*sides))));
    cases.push(Case::new(FORK_ALONE, 1, "rayon", fork_alone()));
    if std::thread::available_parallelism().is_ok_and(|threads| threads.get() > 1) {
        cases.push(Case::new(FORK_SHARED, 2, "rayon", fork_shared()));
    }
    cases
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

/// Wall time here: two threads take part in the other.
fn fork_alone() -> Sampler {
    let pool = pool(1);
    Box::new(move || {
        let time = pool.install(|| {
            let start = Instant::now();
            for _ in 0..FORKS {
                rayon::join(|| black_box(()), || black_box(()));
            }
            start.elapsed()
        });
        Ok(vec![microseconds(time, FORKS)])
    })
}

fn fork_shared() -> Sampler {
    let pool = pool(2);
    Box::new(move || {
        let time = pool.install(|| {
            // One by one, and their median: where the machine is busy, the second thread may have to wait for a processor.
            let mut times: Vec<Duration> = (0..FORKS).map(|_| fork_until_begun()).collect();
            times.sort();
            times[FORKS / 2]
        });
        Ok(vec![microseconds(time, 1)])
    })
}

fn fork_until_begun() -> Duration {
    let start = Instant::now();
    let begun = AtomicBool::new(false);
    let wait = || {
        while !begun.load(Ordering::Acquire) {
            spin_loop();
        }
    };
    rayon::join(wait, || begun.store(true, Ordering::Release));
    start.elapsed()
}
