//! Work shared out among threads in chunks, with a count of the signs that it asked for.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use planecut_kernel::sign::Counts;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::memory::{takes_much_memory, with_room};

/// Into how many parts, for each thread, what is left to do is divided when a thread takes the next one. Parts become smaller towards the end,
/// so that no thread waits long for the last one (guided self-scheduling: Polychronopoulos and Kuck 1987).
const PARTS_OF_REST: usize = 3;

/// Into how many parts of the smallest size all that there is to do would be divided, for each thread.
const SMALLEST_PARTS: usize = 48;

/// Number of chunks where it is not to depend on the number of threads.
const FIXED_CHUNKS: usize = 64;

/// Elements that a thread copies in a row, at least.
const COPIED_OF_CHUNK: usize = 2048;

/// Bytes of equal elements that a thread writes in a row, at least.
const REPEATED_OF_CHUNK: usize = 1 << 14;

/// Shares of a long list, about, that are copied by all threads before the parts copied are dropped.
const SHARES_OF_COPY: usize = 16;

/// The outcome of `work` for each chunk of some items, at least `least` in each, in their order. What a chunk holds depends on
/// the number of threads: outcomes must not.
pub(crate) fn map_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    map_ranges(items.len(), least, |range| work(&items[range]))
}

/// The same for the numbers from zero to a count.
pub(crate) fn map_ranges<R: Send>(
    count: usize,
    least: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> (Vec<R>, Counts) {
    let starts = starts_of(Shares::new(count, least).lengths(count));
    map_numbers(starts.len() - 1, |k| work(starts[k]..starts[k + 1]))
}

/// What is made of each item and its number, in a list of its own; `blank` is what its places hold before. Of many items this takes less memory than lists that are
/// joined.
pub(crate) fn map_items<T: Sync, R: Copy + Send + Sync>(
    items: &[T],
    least: usize,
    blank: R,
    make: impl Fn(usize, &T) -> R + Sync,
) -> (Vec<R>, Counts) {
    let mut made = repeated(items.len(), || blank);
    let starts = starts_of(Shares::new(items.len(), least).lengths(items.len()));
    let places = split_by(&mut made, starts.windows(2).map(|ends| ends[1] - ends[0]));
    let (_, counts) = map_owned(starts.into_iter().zip(places).collect(), |(start, places)| {
        let numbered = (start..).zip(&items[start..]);
        places.iter_mut().zip(numbered).for_each(|(place, (number, item))| *place = make(number, item));
    });
    (made, counts)
}

/// The outcome of `work` for each of some parts, in their order; each part is dropped when its work is done.
pub(crate) fn map_owned<P: Send, R: Send>(parts: Vec<P>, work: impl Fn(P) -> R + Sync) -> (Vec<R>, Counts) {
    let parts: Vec<Mutex<Option<P>>> = parts.into_iter().map(|part| Mutex::new(Some(part))).collect();
    let take = |k: usize| parts[k].lock().unwrap_or_else(PoisonError::into_inner).take();
    map_numbers(parts.len(), |k| work(take(k).expect("each part is taken once")))
}

/// The same in chunks that do not depend on the number of threads, for work that asks for other signs where it follows other items of a chunk.
pub(crate) fn map_fixed_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let size = (items.len() / FIXED_CHUNKS).max(least).max(1);
    let chunks: Vec<&[T]> = items.chunks(size).collect();
    map_numbers(chunks.len(), |k| work(chunks[k]))
}

/// The same for items of different sizes: each chunk but the last is at least of size `least`, the sizes of its items added.
pub(crate) fn map_weighed_chunks<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    size: impl Fn(&T) -> usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let runs = weighed_runs(items.len(), least, |k| size(&items[k]));
    map_numbers(runs.len(), |k| work(&items[runs[k].clone()]))
}

/// The outcome of `work` for each number below a count, in their order.
fn map_numbers<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync) -> (Vec<R>, Counts) {
    let stage = Stage::new(count);
    in_order(planecut_parallel::map_parts(count, |k| stage.counted(|| work(k))))
}

/// The same as `map_weighed_chunks`, where of a list each item fills as many elements as its size is, one after another: `work` is given the part of a chunk.
pub(crate) fn map_weighed_chunks_into<T: Sync, S: Send, R: Send>(
    items: &[T],
    least: usize,
    size: impl Fn(&T) -> usize,
    list: &mut [S],
    work: impl Fn(&[T], &mut [S]) -> R + Sync,
) -> (Vec<R>, Counts) {
    let runs = weighed_runs(items.len(), least, |k| size(&items[k]));
    let parts = split_by(list, runs.iter().map(|run| items[run.clone()].iter().map(&size).sum()));
    map_owned(runs.into_iter().zip(parts).collect(), |(run, part)| work(&items[run], part))
}

/// How much of some work threads do in a row.
struct Shares {
    threads: usize,
    least: usize,
}

impl Shares {
    /// Shares of work of a size, each at least of size `least`.
    fn new(all: usize, least: usize) -> Self {
        let threads = planecut_parallel::current_num_threads();
        Self { threads, least: (all / (SMALLEST_PARTS * threads)).max(least).max(1) }
    }

    /// The size of the next one, where so much is left.
    fn next(&self, left: usize) -> usize {
        (left / (PARTS_OF_REST * self.threads)).max(self.least)
    }

    /// The sizes of all of them.
    fn lengths(self, all: usize) -> impl Iterator<Item = usize> {
        let mut left = all;
        std::iter::from_fn(move || {
            let length = self.next(left).min(left);
            left -= length;
            (length > 0).then_some(length)
        })
    }
}

/// Runs of items of different sizes, for threads to share: each but the last is at least of size `least`, the sizes of its items added.
pub(crate) fn weighed_runs(count: usize, least: usize, size: impl Fn(usize) -> usize) -> Vec<Range<usize>> {
    let all: usize = (0..count).map(&size).sum();
    let shares = Shares::new(all, least);
    let (mut start, mut sum, mut left) = (0, 0, all);
    let mut enough = shares.next(left);
    let mut runs = Vec::new();
    for k in 0..count {
        sum += size(k);
        if sum >= enough {
            runs.push(start..k + 1);
            left -= sum;
            enough = shares.next(left);
            (start, sum) = (k + 1, 0);
        }
    }
    runs.extend((start < count).then_some(start..count));
    runs
}

/// Runs of items, for threads to share, that begin only where an item `is_apart` from the one before: each but the last has at least `least`.
pub(crate) fn runs_apart<T>(items: &[T], least: usize, is_apart: impl Fn(&T, &T) -> bool) -> Vec<&[T]> {
    let shares = Shares::new(items.len(), least);
    let mut runs = Vec::new();
    let mut rest = items;
    while rest.len() > shares.next(rest.len()) {
        let end =
            (shares.next(rest.len())..rest.len()).find(|k| is_apart(&rest[k - 1], &rest[*k])).unwrap_or(rest.len());
        let (run, others) = rest.split_at(end);
        runs.push(run);
        rest = others;
    }
    if !rest.is_empty() {
        runs.push(rest);
    }
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

/// Where parts of some lengths begin that follow one another, and where the last one ends.
pub(crate) fn starts_of(lengths: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut starts = vec![0];
    let mut end = 0;
    starts.extend(lengths.map(|length| {
        end += length;
        end
    }));
    starts
}

/// What is made of each element of some parts, one after another, in parallel, at least `least` of them in a row; `make` is given the number of the part and the place of the element in it. A long list
/// may have room for more, of which nothing is written to, see [`with_room`].
pub(crate) fn by_parts<T: Send>(
    lengths: impl Iterator<Item = usize>,
    least: usize,
    make: impl Fn(usize, usize) -> T + Sync,
) -> Vec<T> {
    let starts = starts_of(lengths);
    let count = starts[starts.len() - 1];
    let mut all = with_room(count, count);
    extend_by_parts(&mut all, &starts, least, make);
    all
}

/// The same, added to a list; `starts` gives where parts begin that follow one another, and where the last one ends.
fn extend_by_parts<T: Send>(all: &mut Vec<T>, starts: &[usize], least: usize, make: impl Fn(usize, usize) -> T + Sync) {
    let element = |part: &mut usize, k: usize| {
        // mostly it is in the same part as the one before
        if k < starts[*part] || k >= starts[*part + 1] {
            *part = starts.partition_point(|start| *start <= k) - 1;
        }
        make(*part, k - starts[*part])
    };
    let places = (0..starts[starts.len() - 1]).into_par_iter().with_min_len(least);
    all.par_extend(places.map_init(|| 0, element));
}

/// A list of elements that are made without regard to their places, by all threads: filling much memory takes time.
pub(crate) fn repeated<T: Send>(count: usize, element: impl Fn() -> T + Sync + Send) -> Vec<T> {
    made_by_place(count, REPEATED_OF_CHUNK / size_of::<T>().max(1), |_| element())
}

/// A list of elements that are made from their places by all threads, at least `least` of them in a row; for as long as an evaluation lasts, see [`with_room`].
pub(crate) fn made_by_place<T: Send>(count: usize, least: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    let mut list = with_room(count, count);
    list.par_extend((0..count).into_par_iter().with_min_len(least).map(make));
    list
}

/// The elements of some parts one after another. Where they are many, or there is one thread, parts are dropped when they are copied.
pub(crate) fn concat_owned<T: Copy + Send + Sync>(parts: Vec<Vec<T>>) -> Vec<T> {
    concat_made(parts, |_, element| *element)
}

/// The same of what is made of each element and the number of its part.
pub(crate) fn concat_made<S: Send + Sync, T: Send>(parts: Vec<Vec<S>>, make: impl Fn(usize, &S) -> T + Sync) -> Vec<T> {
    let lengths = || parts.iter().map(Vec::len);
    let (count, last) = (lengths().sum(), parts.len());
    let threads = planecut_parallel::current_num_threads();
    if threads > 1 && !takes_much_memory::<T>(count) {
        return by_parts(lengths(), COPIED_OF_CHUNK, |part, k| make(part, &parts[part][k]));
    }
    let mut all = with_room(count, count);
    if threads == 1 {
        for (number, part) in parts.into_iter().enumerate() {
            all.extend(part.iter().map(|element| make(number, element)));
        }
        return all;
    }
    let (mut some, mut first, mut waiting) = (Vec::new(), 0, 0);
    for (number, part) in (1..).zip(parts) {
        waiting += part.len();
        some.push(part);
        if waiting >= count / SHARES_OF_COPY || number == last {
            let starts = starts_of(some.iter().map(Vec::len));
            extend_by_parts(&mut all, &starts, COPIED_OF_CHUNK, |part, k| make(first + part, &some[part][k]));
            some.clear();
            (first, waiting) = (number, 0);
        }
    }
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
fn counted<R>(work: impl FnOnce() -> R) -> (R, Counts) {
    let before = Counts::now();
    let outcome = work();
    (outcome, Counts::since(before))
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::base::memory;

    #[test]
    fn items_are_numbered_across_chunks() {
        for seed in 0..50 {
            let mut rng = Rng::spread(seed);
            let (count, least) = (rng.below(3_000), 1 + rng.below(60));
            let items: Vec<usize> = (0..count).map(|_| rng.below(9)).collect();
            let (made, _) = map_items(&items, least, usize::MAX, |number, item| 10 * number + item);
            assert!(made.into_iter().eq(items.into_iter().enumerate().map(|(k, item)| 10 * k + item)), "seed {seed}");
        }
    }

    #[test]
    fn lists_of_any_length_are_joined_in_order() {
        for seed in 0..4 {
            let mut rng = Rng::spread(seed);
            // some of them so long that parts are dropped as they are copied
            let count = (memory::MUCH_MEMORY / size_of::<u64>()) >> (4 * (seed % 2));
            let (mut parts, mut end): (Vec<Vec<u64>>, u64) = (Vec::new(), 0);
            while end < 2 * count as u64 {
                let length = rng.below(count / 3) as u64 >> rng.below(12);
                parts.push((end..end + length).collect());
                end += length;
            }
            let numbers: Vec<usize> = (0..).zip(&parts).flat_map(|(k, part)| vec![k; part.len()]).collect();
            let joined = concat_made(parts, |part, element| (part, *element));
            assert!(joined.into_iter().eq(numbers.into_iter().zip(0..end)), "seed {seed}");
        }
    }

    #[test]
    fn runs_are_all_items_in_order_and_become_smaller() {
        for seed in 0..50 {
            let mut rng = Rng::spread(seed);
            let (count, least) = (rng.below(3_000), 1 + rng.below(60));
            let sizes: Vec<usize> = (0..count).map(|_| rng.below(9)).collect();
            let runs = weighed_runs(count, least, |k| sizes[k]);
            assert!(runs.iter().cloned().flatten().eq(0..count), "seed {seed}");
            let of_runs: Vec<usize> = runs.iter().map(|run| sizes[run.clone()].iter().sum()).collect();
            let [before @ .., _] = of_runs.as_slice() else { continue };
            assert!(before.iter().all(|size| *size >= least), "seed {seed}");
            // a run ends with the item that makes it large enough
            assert!(before.windows(2).all(|two| two[1] < two[0] + 9), "seed {seed}");
        }
    }
}
