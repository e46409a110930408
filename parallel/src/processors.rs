//! On which processors the threads of the pool run at first.
//!
//! Linux wakes a thread on an idle processor where it knows of one. In virtual machines a processor that has slept for a while seems to be taken
//! (`vcpu_is_preempted` may be why), so that all threads of the pool awake on the processor of the thread that wakes them and share it, for as long as 50 ms: work
//! that is shorter is done as fast as by one thread. So after a pause each thread is kept on a processor of its own for that long.

use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use rustix::thread::{CpuSet, Pid, gettid, sched_getaffinity, sched_setaffinity};

use crate::awake::MOST_THREADS;

/// Threads that have slept for less time are where they were.
const PAUSE: Duration = Duration::from_millis(10);

/// How long threads are kept where they are put.
pub(crate) const KEPT: Duration = Duration::from_millis(50);

/// Of how many callers the pool does the work, and when the last of them was done.
static CALLERS: Mutex<(usize, Option<Instant>)> = Mutex::new((0, None));

/// Stands for a caller of the pool.
pub(crate) struct Caller(());

impl Caller {
    /// Begins; also tells whether the pool has slept.
    pub(crate) fn begin() -> (Self, bool) {
        let mut callers = CALLERS.lock().unwrap_or_else(PoisonError::into_inner);
        let (count, last) = &mut *callers;
        let has_slept = *count == 0 && last.is_none_or(|last| last.elapsed() > PAUSE);
        *count += 1;
        (Self(()), has_slept)
    }
}

impl Drop for Caller {
    fn drop(&mut self) {
        let mut callers = CALLERS.lock().unwrap_or_else(PoisonError::into_inner);
        *callers = (callers.0 - 1, Some(Instant::now()));
    }
}

/// The threads of the pool, each kept on a processor of its own until this is dropped. They are left as they are where there are not as many as processors that
/// they may run on: then the user wants something else.
pub(crate) struct Spread(Vec<(Pid, CpuSet)>);

impl Spread {
    pub(crate) fn new() -> Self {
        static THREADS: OnceLock<Vec<Pid>> = OnceLock::new();
        let mut spread = Self(Vec::new());
        let count = rayon::current_num_threads();
        if !(2..=MOST_THREADS).contains(&count) {
            return spread;
        }
        let threads = THREADS.get_or_init(|| rayon::broadcast(|_| gettid()));
        let allowed = threads.iter().map(|thread| Some((*thread, sched_getaffinity(Some(*thread)).ok()?)));
        let Some(allowed) = allowed.collect::<Option<Vec<_>>>() else { return spread };
        if allowed.iter().any(|(_, allowed)| allowed.count() as usize != count) {
            return spread;
        }
        for (number, (thread, allowed)) in allowed.into_iter().enumerate() {
            let mut processors = (0..CpuSet::MAX_CPU).filter(|processor| allowed.is_set(*processor));
            let mut own = CpuSet::new();
            processors.nth(number).into_iter().for_each(|processor| own.set(processor));
            if sched_setaffinity(Some(thread), &own).is_ok() {
                spread.0.push((thread, allowed));
            }
        }
        spread
    }
}

impl Drop for Spread {
    fn drop(&mut self) {
        for (thread, allowed) in &self.0 {
            // a thread that is gone needs nothing
            let _ = sched_setaffinity(Some(*thread), allowed);
        }
    }
}
