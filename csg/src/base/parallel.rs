//! Work shared out among threads in chunks, with a count of the signs that it asked for.

use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;

/// Chunks for each thread, so that none waits long for the last one.
const PER_THREAD: usize = 8;

/// The outcome of `work` for each chunk of some items, at least `least` in each, in their order. What a chunk holds depends on
/// the number of threads: outcomes must not.
pub(crate) fn map_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let chunk = (items.len() / (PER_THREAD * planecut_parallel::current_num_threads())).max(least);
    let counted: Vec<(R, Counts)> = items.par_chunks(chunk.max(1)).map(|chunk| counted(|| work(chunk))).collect();
    let mut counts = Counts::default();
    let outcomes = counted.into_iter().map(|(outcome, part)| {
        counts += part;
        outcome
    });
    (outcomes.collect(), counts)
}

/// The outcome of work on one thread, and the signs that it asked for.
pub(crate) fn counted<R>(work: impl FnOnce() -> R) -> (R, Counts) {
    let before = Counts::now();
    let outcome = work();
    (outcome, Counts::since(before))
}
