//! What works on one part of something after another: buffers that it has grown are there for the next part.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Workers of one kind, of which each thread has one as long as it works on a part. What a worker has done before must not change what it does.
pub(crate) struct Workers<W, N> {
    new: N,
    idle: Mutex<Vec<W>>,
}

impl<W, N: Fn() -> W> Workers<W, N> {
    /// None yet; `new` makes one where all are at work.
    pub(crate) fn new(new: N) -> Self {
        Self { new, idle: Mutex::default() }
    }

    /// Lets one of them do some work. Where that panics, the worker is not used again.
    pub(crate) fn with<R>(&self, work: impl FnOnce(&mut W) -> R) -> R {
        let idle = self.idle().pop();
        let mut worker = idle.unwrap_or_else(&self.new);
        let outcome = work(&mut worker);
        self.idle().push(worker);
        outcome
    }

    fn idle(&self) -> MutexGuard<'_, Vec<W>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
