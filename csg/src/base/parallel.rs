//! Work shared out among threads in chunks, with a count of the signs that it asked for.

use std::sync::atomic::{AtomicUsize, Ordering};

use planecut_kernel::sign::Counts;
use planecut_parallel::job;

/// Chunks for each thread, so that none waits long for the last one.
const PER_THREAD: usize = 8;

/// The outcome of `work` for each chunk of some items, at least `least` in each, in their order. What a chunk holds depends on
/// the number of threads: outcomes must not.
pub(crate) fn map_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let chunk = (items.len() / (PER_THREAD * planecut_parallel::current_num_threads())).max(least).max(1);
    let count = items.len().div_ceil(chunk);
    let stage = Stage::new(count);
    let chunk_of = |k: usize| &items[k * chunk..items.len().min((k + 1) * chunk)];
    in_order(planecut_parallel::map_parts(count, |k| stage.counted(|| work(chunk_of(k)))))
}

/// The same for items of different sizes: each chunk but the last is at least of size `least`, the sizes of its items added.
pub(crate) fn map_weighed_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    size: impl Fn(&T) -> usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let all: usize = items.iter().map(&size).sum();
    let enough = (all / (PER_THREAD * planecut_parallel::current_num_threads())).max(least);
    let mut sum = 0;
    // a chunk ends where the sum of sizes passes what is enough
    let ends = (1..=items.len()).filter(|end| {
        sum += size(&items[end - 1]);
        sum >= enough && std::mem::take(&mut sum) > 0
    });
    let mut chunks = Vec::new();
    let mut start = 0;
    for end in ends {
        chunks.push(&items[start..end]);
        start = end;
    }
    chunks.extend(Some(&items[start..]).filter(|rest| !rest.is_empty()));
    let stage = Stage::new(chunks.len());
    in_order(planecut_parallel::map_parts(chunks.len(), |k| stage.counted(|| work(chunks[k]))))
}

/// Chunks that are worked on, for whoever watches.
struct Stage {
    done: AtomicUsize,
    chunks: usize,
}

impl Stage {
    fn new(chunks: usize) -> Self {
        Self { done: AtomicUsize::new(0), chunks }
    }

    /// The outcome of a chunk, with the signs that it asked for; nothing more where the work is to end.
    fn counted<R>(&self, work: impl FnOnce() -> R) -> (R, Counts) {
        job::check();
        let outcome = counted(work);
        if self.chunks > 1 {
            job::progress(self.done.fetch_add(1, Ordering::Relaxed) + 1, self.chunks);
        }
        outcome
    }
}

/// The outcomes of chunks, and all signs that were asked for.
fn in_order<R>(counted: Vec<(R, Counts)>) -> (Vec<R>, Counts) {
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
