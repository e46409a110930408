//! Threads of the pool that do not fall asleep between the loops of one piece of work.
//!
//! A thread of rayon's that finds nothing to do falls asleep after some thirty looks, and has to be woken when there is work again: both it and the thread that wakes it lose time. Work of many short loops, between which one thread
//! goes on alone, wakes the others again and again: an evaluation of 4 ms on two threads fourteen times. Here they go on looking, and so does the thread that waits for the last parts of a loop.

use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{available_parallelism, yield_now};

use rayon::Yield;

/// How often a thread looks for work without finding any before it is let sleep.
const LOOKS: usize = 500;

/// Threads of larger pools are left as they are: to wake or to move all of them takes longer than short work gains.
pub(crate) const MOST_THREADS: usize = 16;

/// How many pieces of work are being done for which threads stay awake.
static WORKS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static IS_LOOKING: Cell<bool> = const { Cell::new(false) };
}

/// Whether the threads of the pool are to stay awake: not where they are more than the processors that they may run on, as there they would keep one another from work. To be asked by a thread that is not itself
/// kept on one processor.
pub(crate) fn is_worthwhile() -> bool {
    static PROCESSORS: OnceLock<usize> = OnceLock::new();
    let threads = rayon::current_num_threads();
    (2..=MOST_THREADS).contains(&threads)
        && threads <= *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from))
}

/// Keeps the other threads of the pool awake until it is dropped, unless they find nothing to do for long.
pub(crate) struct Awake(());

impl Awake {
    /// Begins, on a thread of the pool.
    pub(crate) fn begin() -> Self {
        WORKS.fetch_add(1, Ordering::Relaxed);
        let own = rayon::current_thread_index();
        rayon::spawn_broadcast(move |context| {
            if Some(context.index()) != own {
                look_for_work(&WORKS);
            }
        });
        Self(())
    }
}

impl Drop for Awake {
    fn drop(&mut self) {
        WORKS.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Does what there is to do for other threads, until none of some works is going on, or there has been nothing for a while. Other programs have their turn between two looks.
///
/// A thread that looks already, and has found that it is to look for another work as well, goes on where it was: works that overlap without end would fill its stack.
pub(crate) fn look_for_work(works: &AtomicUsize) {
    if IS_LOOKING.replace(true) {
        return;
    }
    look_while(|| works.load(Ordering::Relaxed) > 0);
    IS_LOOKING.set(false);
}

/// Does what there is to do for other threads while a condition holds, unless there has been nothing for a while.
fn look_while(condition: impl Fn() -> bool) {
    let mut left = LOOKS;
    while left > 0 && condition() {
        if rayon::yield_now() == Some(Yield::Executed) {
            left = LOOKS;
        } else {
            left -= 1;
            yield_now();
        }
    }
}

/// What other threads do of a loop or join, so that the one that has begun it can wait for them without falling asleep.
pub(crate) struct Helpers {
    under_way: AtomicUsize,
}

impl Helpers {
    pub(crate) const fn new() -> Self {
        Self { under_way: AtomicUsize::new(0) }
    }

    /// Does a part, on another thread.
    pub(crate) fn help<R>(&self, work: impl FnOnce() -> R) -> R {
        struct Ending<'a>(&'a AtomicUsize);
        impl Drop for Ending<'_> {
            // where the work panics as well
            fn drop(&mut self) {
                self.0.fetch_sub(1, Ordering::Release);
            }
        }
        self.under_way.fetch_add(1, Ordering::Relaxed);
        let _ending = Ending(&self.under_way);
        work()
    }

    /// Waits for parts that have been begun, as long as the threads of the pool stay awake at all. What has not been begun, the calling thread finds itself when it goes on to wait as rayon does.
    pub(crate) fn wait(&self) {
        look_while(|| self.under_way.load(Ordering::Acquire) > 0 && WORKS.load(Ordering::Relaxed) > 0);
    }
}
