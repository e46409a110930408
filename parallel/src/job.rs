//! Long work that somebody watches from outside: how far it is, and whether it is to end early.
//!
//! Who begins the work makes a [`Watch`], and sets it for the threads that work with [`watched`]. Long loops call [`check`], which ends the work by unwinding, and tell
//! with [`progress`] how far they are. Where nothing is set, both cost next to nothing.
//!
//! ```
//! use planecut_parallel::job::{Stopped, Watch, check, progress, watched};
//!
//! let watch = Watch::new();
//! let sum = watched(&watch, || {
//!     (0..10_u64).map(|k| { check(); progress(k as usize, 10); k }).sum::<u64>()
//! });
//! assert_eq!((sum, watch.progress()), (45, (9, 10)));
//! watch.stop();
//! let ended = std::panic::catch_unwind(|| watched(&watch, check)).unwrap_err();
//! assert!(ended.is::<Stopped>());
//! ```

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

thread_local! {
    static CURRENT: RefCell<Option<Arc<Watch>>> = const { RefCell::new(None) };
}

/// What is known of work from outside.
#[derive(Debug, Default)]
pub struct Watch {
    is_stopped: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
}

/// What unwinds through work that is ended early: the payload that `std::panic::catch_unwind` gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

impl Watch {
    /// For work that has not begun.
    #[must_use]
    pub fn new() -> Arc<Self> {
        Arc::default()
    }

    /// Asks the work to end. It does so at the next [`check`] of each of its threads.
    pub fn stop(&self) {
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    /// How many steps of how many are done of what is being done now; zero of zero where it does not say.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

/// Sets the watch of the current thread for good: for threads of a pool that does nothing else.
pub fn set_watch(watch: &Arc<Watch>) {
    CURRENT.set(Some(Arc::clone(watch)));
}

/// Does work with a watch set for the current thread.
pub fn watched<T>(watch: &Arc<Watch>, work: impl FnOnce() -> T) -> T {
    /// Gives the thread back the watch that it had, also where the work unwinds.
    struct Before(Option<Arc<Watch>>);
    impl Drop for Before {
        fn drop(&mut self) {
            CURRENT.set(self.0.take());
        }
    }
    let _before = Before(CURRENT.replace(Some(Arc::clone(watch))));
    work()
}

/// The watch of the current thread.
#[cfg(feature = "threads")]
pub(crate) fn current() -> Option<Arc<Watch>> {
    CURRENT.with_borrow(Clone::clone)
}

/// Ends the work by unwinding with [`Stopped`], without a message, where its watch says so.
pub fn check() {
    let is_stopped = |watch: &Arc<Watch>| watch.is_stopped.load(Ordering::Relaxed);
    if CURRENT.with_borrow(|watch| watch.as_ref().is_some_and(is_stopped)) {
        resume_unwind(Box::new(Stopped));
    }
}

/// Tells how many steps of how many are done. What says nothing of it lets the last numbers stand.
pub fn progress(done: usize, total: usize) {
    CURRENT.with_borrow(|watch| {
        if let Some(watch) = watch {
            watch.total.store(total, Ordering::Relaxed);
            watch.done.store(done, Ordering::Relaxed);
        }
    });
}
