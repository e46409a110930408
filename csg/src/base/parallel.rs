//! Work shared out among threads in chunks, with a count of the signs that it asked for.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use planecut_kernel::sign::Counts;
use planecut_parallel::job;
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
    let runs = weighed_runs(items.len(), least, |k| size(&items[k]));
    let chunks: Vec<&[T]> = runs.into_iter().map(|run| &items[run]).collect();
    let stage = Stage::new(chunks.len());
    in_order(planecut_parallel::map_parts(chunks.len(), |k| stage.counted(|| work(chunks[k]))))
}

/// Runs of items of different sizes, for threads to share: each but the last is at least of size `least`, the sizes of its items added.
pub(crate) fn weighed_runs(count: usize, least: usize, size: impl Fn(usize) -> usize) -> Vec<Range<usize>> {
    let all: usize = (0..count).map(&size).sum();
    let enough = (all / (PER_THREAD * planecut_parallel::current_num_threads())).max(least);
    let (mut start, mut sum) = (0, 0);
    let mut runs = Vec::new();
    for k in 0..count {
        sum += size(k);
        if sum >= enough && sum > 0 {
            runs.push(start..k + 1);
            (start, sum) = (k + 1, 0);
        }
    }
    runs.extend((start < count).then_some(start..count));
    runs
}

/// Parts of a slice that follow one another, of some lengths.
pub(crate) fn split_by<T>(mut slice: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let part = |length: usize| {
        let (part, rest) = std::mem::take(&mut slice).split_at_mut(length);
        slice = rest;
        part
    };
    lengths.map(part).collect()
}

/// The elements of some parts one after another, each made from that of the part, in parallel.
pub(crate) fn concat<'a, S: Sync + 'a, T: Copy + Default + Send>(
    parts: usize,
    part: impl Fn(usize) -> &'a [S] + Sync,
    make: impl Fn(usize, &S) -> T + Sync,
) -> Vec<T> {
    let mut all = vec![T::default(); (0..parts).map(|k| part(k).len()).sum()];
    let slices = split_by(&mut all, (0..parts).map(|k| part(k).len()));
    slices.into_par_iter().enumerate().for_each(|(k, slice)| {
        slice.iter_mut().zip(part(k)).for_each(|(to, from)| *to = make(k, from));
    });
    all
}

/// The elements of some parts one after another; each part is dropped when it is copied, as all of them may be much.
pub(crate) fn concat_owned<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|part| all.extend(part));
    all
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
