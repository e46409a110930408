//! Threads of the pool that do not fall asleep between the loops of one piece of work.
//!
//! A thread of rayon's that finds nothing to do falls asleep after some thirty looks, and has to be woken when there is work again: both it and the thread that wakes it lose time. Work of many short loops, between which one thread
//! goes on alone, wakes the others again and again: an evaluation of 4 ms on two threads fourteen times. Here they go on looking.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{available_parallelism, yield_now};

use rayon::Yield;

/// How often a thread looks for work without finding any before it is let sleep.
const LOOKS: usize = 500;

/// Threads of larger pools are let sleep: to wake all of them at the beginning takes longer than short work gains.
const MOST_THREADS: usize = 16;

/// Whether the threads of the pool are to stay awake: not where they are more than the processors that they may run on, as there they would keep one another from work. To be asked by a thread that is not itself
/// kept on one processor.
pub(crate) fn is_worthwhile() -> bool {
    static PROCESSORS: OnceLock<usize> = OnceLock::new();
    let processors = *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from));
    (2..=MOST_THREADS.min(processors)).contains(&rayon::current_num_threads())
}

/// Stands for work, for as long as which the other threads of the pool stay awake, unless they find nothing to do for long.
pub(crate) struct Awake(Arc<AtomicBool>);

impl Awake {
    /// Begins, on a thread of the pool.
    pub(crate) fn begin() -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let awake = Self(Arc::clone(&is_over));
        let own = rayon::current_thread_index();
        rayon::spawn_broadcast(move |context| {
            if Some(context.index()) != own {
                look_for_work(&is_over);
            }
        });
        awake
    }
}

impl Drop for Awake {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does what there is to do for other threads, until it is over, or there has been nothing for a while. Other programs have their turn between two looks.
pub(crate) fn look_for_work(is_over: &AtomicBool) {
    let mut left = LOOKS;
    while left > 0 && !is_over.load(Ordering::Relaxed) {
        if rayon::yield_now() == Some(Yield::Executed) {
            left = LOOKS;
        } else {
            left -= 1;
            yield_now();
        }
    }
}
