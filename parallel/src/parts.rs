//! Parts of work that the calling thread takes up at once, and others as soon as they are awake.
//!
//! A loop or join of rayon's that is begun by a thread outside of the pool is handed over to it: that thread waits until another one is awake, which takes longer than short work does. Here it works itself from the start, and the
//! threads of the pool take what is left when they come. It waits for them to come, though, also where nothing is left: some 50 µs.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::awake::{Awake, Helpers, is_worthwhile};
use crate::job;
#[cfg(target_os = "linux")]
use crate::processors::{Caller, KEPT, Spread};

/// The result of work that is done by a thread of the pool, so that its loops and joins begin without waiting for one to awake; where the calling thread is one,
/// it does the work itself. What watches the calling thread watches the work.
///
/// The other threads look for work for as long as it lasts, unless there is none for some tenths of a millisecond: they do not fall asleep between its loops. Those of pools of more threads than 16, or than there are
/// processors to run on, do.
///
/// On Linux the threads of a pool that has slept are kept on processors of their own for the first 50 ms at most, where there are as many as processors that they
/// may run on, and not more than 16: in virtual machines they would share one.
pub fn in_pool<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    if rayon::current_thread_index().is_some() {
        return work();
    }
    let (watch, stay_awake) = (job::current(), is_worthwhile());
    let work = || {
        let _awake = stay_awake.then(Awake::begin);
        match watch {
            Some(watch) => job::watched(&watch, work),
            None => work(),
        }
    };
    #[cfg(target_os = "linux")]
    let (_caller, has_slept) = Caller::begin();
    #[cfg(target_os = "linux")]
    if has_slept {
        return in_pool_that_slept(work);
    }
    rayon::scope(|_| work())
}

/// The same for a pool whose threads have slept.
#[cfg(target_os = "linux")]
fn in_pool_that_slept<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let spread = Spread::new();
    let (is_done, done) = std::sync::mpsc::sync_channel::<()>(1);
    let mut result = None;
    rayon::in_place_scope(|scope| {
        let result = &mut result;
        scope.spawn(move |_| {
            // its end is told also where the work panics
            let _is_done = is_done;
            *result = Some(work());
        });
        let _ = done.recv_timeout(KEPT);
        drop(spread);
    });
    result.expect("the scope waits for the work, and panics where that does")
}

/// The results of two functions, of which the calling thread does the first one.
pub fn join<A, B: Send>(first: impl FnOnce() -> A, second: impl FnOnce() -> B + Send) -> (A, B) {
    if rayon::current_num_threads() == 1 {
        let first = first();
        return (first, second());
    }
    let (mut of_first, mut of_second) = (None, None);
    let (mut first, mut second) = (Some(first), Some(second));
    with_another_thread(&mut || of_first = first.take().map(|work| work()), &mut || {
        of_second = second.take().map(|work| work());
    });
    let expected = "both have been called, or one of them has panicked";
    (of_first.expect(expected), of_second.expect(expected))
}

/// Does some work while another thread drops what that does not need; outside of the pool, and where there is one thread, it is dropped first.
pub fn drop_beside<T: Send, R>(dropped: T, work: impl FnOnce() -> R) -> R {
    if rayon::current_num_threads() == 1 || rayon::current_thread_index().is_none() {
        drop(dropped);
        return work();
    }
    join(work, || drop(dropped)).0
}

/// Calls two functions, the first one on the calling thread. They are trait objects, as in [`on_threads`], so that rayon's functions around them are compiled once.
fn with_another_thread(first: &mut dyn FnMut(), second: &mut (dyn FnMut() + Send)) {
    let helpers = Helpers::new();
    rayon::in_place_scope(|scope| {
        scope.spawn(|_| helpers.help(second));
        first();
        helpers.wait();
    });
}

/// Calls a function on the calling thread and on some others at once.
fn on_threads(others: usize, work: &(dyn Fn() + Sync)) {
    let helpers = Helpers::new();
    rayon::in_place_scope(|scope| {
        for _ in 0..others {
            scope.spawn(|_| helpers.help(work));
        }
        work();
        helpers.wait();
    });
}

/// The results of `work` for the parts `0..count`, in their order.
pub fn map_parts<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let others = rayon::current_num_threads().min(count).saturating_sub(1);
    if others == 0 {
        return (0..count).map(work).collect();
    }
    let next = AtomicUsize::new(0);
    let all = Mutex::new(Vec::with_capacity(count));
    on_threads(others, &|| {
        let mut part = next.fetch_add(1, Ordering::Relaxed);
        if part >= count {
            return;
        }
        let mut done = Vec::with_capacity(count - part);
        while part < count {
            done.push((part, work(part)));
            part = next.fetch_add(1, Ordering::Relaxed);
        }
        all.lock().unwrap_or_else(PoisonError::into_inner).append(&mut done);
    });
    let mut all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    all.sort_unstable_by_key(|(part, _)| *part);
    all.into_iter().map(|(_, result)| result).collect()
}
