//! Rayon's names for the iterators and sorts of the standard library.

use std::cmp::Ordering;
use std::iter::FlatMap;
use std::slice::{ChunkByMut, Chunks, ChunksExact, ChunksMut, Iter, IterMut, Windows};

/// Number of threads that loops run on: one.
#[must_use]
pub const fn current_num_threads() -> usize {
    1
}

/// The result of work.
pub fn in_pool<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// The results of two functions.
pub fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    let first = first();
    (first, second())
}

/// Does some work after dropping what that does not need.
pub fn drop_beside<T, R>(dropped: T, work: impl FnOnce() -> R) -> R {
    drop(dropped);
    work()
}

/// The results of `work` for the parts `0..count`, in their order.
pub fn map_parts<R>(count: usize, work: impl Fn(usize) -> R) -> Vec<R> {
    (0..count).map(work).collect()
}

/// The traits that add the methods.
pub mod prelude {
    pub use super::{IntoParallelIterator, ParallelExtend, ParallelIterator, ParallelSlice, ParallelSliceMut};
}

/// Whatever can be iterated over.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// The elements by value.
    fn into_par_iter(self) -> Self::IntoIter {
        self.into_iter()
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

/// Methods of parallel iterators that those of the standard library lack.
pub trait ParallelIterator: Iterator + Sized {
    /// The elements themselves: nothing is split among threads.
    #[must_use]
    fn with_min_len(self, _least: usize) -> Self {
        self
    }

    /// The elements themselves: nothing is split among threads.
    #[must_use]
    fn with_max_len(self, _most: usize) -> Self {
        self
    }

    /// The elements of all iterators that a function gives.
    fn flat_map_iter<T: IntoIterator, F: FnMut(Self::Item) -> T>(self, function: F) -> FlatMap<Self, T, F> {
        self.flat_map(function)
    }

    /// The elements of all elements.
    fn flatten_iter(self) -> std::iter::Flatten<Self>
    where
        Self::Item: IntoIterator,
    {
        self.flatten()
    }

    /// The results of a function that is given one state for all elements, as scratch memory.
    fn map_init<S, R>(
        self,
        init: impl FnOnce() -> S,
        mut function: impl FnMut(&mut S, Self::Item) -> R,
    ) -> impl Iterator<Item = R> {
        let mut state = init();
        self.map(move |element| function(&mut state, element))
    }

    /// Calls a function that is given one state for all elements, as scratch memory.
    fn for_each_init<S>(self, init: impl FnOnce() -> S, mut function: impl FnMut(&mut S, Self::Item)) {
        let mut state = init();
        self.for_each(|element| function(&mut state, element));
    }
}

impl<I: Iterator> ParallelIterator for I {}

/// Lists that grow by all elements of an iterator.
pub trait ParallelExtend<T> {
    /// Adds the elements at the end, in order.
    fn par_extend(&mut self, elements: impl IntoIterator<Item = T>);
}

impl<T> ParallelExtend<T> for Vec<T> {
    fn par_extend(&mut self, elements: impl IntoIterator<Item = T>) {
        self.extend(elements);
    }
}

/// Views of slices.
pub trait ParallelSlice<T> {
    /// The elements.
    fn par_iter(&self) -> Iter<'_, T>;

    /// Pieces of a length, the last of which may be shorter.
    fn par_chunks(&self, length: usize) -> Chunks<'_, T>;

    /// Pieces of a length, without what is left of it at the end.
    fn par_chunks_exact(&self, length: usize) -> ChunksExact<'_, T>;

    /// All runs of a length.
    fn par_windows(&self, length: usize) -> Windows<'_, T>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Iter<'_, T> {
        self.iter()
    }

    fn par_chunks(&self, length: usize) -> Chunks<'_, T> {
        self.chunks(length)
    }

    fn par_chunks_exact(&self, length: usize) -> ChunksExact<'_, T> {
        self.chunks_exact(length)
    }

    fn par_windows(&self, length: usize) -> Windows<'_, T> {
        self.windows(length)
    }
}

/// Views of slices that can be written, and sorts.
pub trait ParallelSliceMut<T> {
    /// The elements.
    fn par_iter_mut(&mut self) -> IterMut<'_, T>;

    /// Pieces of a length, the last of which may be shorter.
    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T>;

    /// Runs of neighbours for which a predicate holds.
    fn par_chunk_by_mut<F: FnMut(&T, &T) -> bool>(&mut self, same: F) -> ChunkByMut<'_, T, F>;

    /// Sorts; equal elements may change places.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;

    /// Sorts by a comparison; equal elements may change places.
    fn par_sort_unstable_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering);
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> IterMut<'_, T> {
        self.iter_mut()
    }

    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T> {
        self.chunks_mut(length)
    }

    fn par_chunk_by_mut<F: FnMut(&T, &T) -> bool>(&mut self, same: F) -> ChunkByMut<'_, T, F> {
        self.chunk_by_mut(same)
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }

    fn par_sort_unstable_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering) {
        self.sort_unstable_by(compare);
    }
}
