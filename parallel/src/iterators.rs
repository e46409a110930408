//! Rayon's parallel iterators, split by functions that are compiled once.

use std::cmp::Ordering;

use rayon::iter::plumbing::{Consumer, Producer, ProducerCallback, UnindexedConsumer};
use rayon::iter::{
    Enumerate, IndexedParallelIterator, IntoParallelIterator as IntoRayon, MaxLen, MinLen, ParallelIterator, Zip,
};
use rayon::slice::{ChunkByMut, Chunks, ChunksExact, ChunksMut, Iter, IterMut, Windows};

use crate::halves::{Splits, consume};

/// The traits that add the methods.
pub mod prelude {
    pub use rayon::iter::{IndexedParallelIterator, ParallelExtend, ParallelIterator};

    pub use super::{IntoParallelIterator, ParallelSlice, ParallelSliceMut};
}

/// A parallel iterator of rayon's over elements that have numbers. Its own methods are those that keep the numbers; the others are rayon's.
#[derive(Debug, Clone)]
#[must_use = "iterators do nothing until they are consumed"]
pub struct Indexed<I>(I);

impl<I: IndexedParallelIterator> Indexed<I> {
    /// No part is shorter, where the loop is not.
    pub fn with_min_len(self, least: usize) -> Indexed<MinLen<I>> {
        Indexed(self.0.with_min_len(least))
    }

    /// No part is longer.
    pub fn with_max_len(self, most: usize) -> Indexed<MaxLen<I>> {
        Indexed(self.0.with_max_len(most))
    }

    /// The elements with their numbers.
    pub fn enumerate(self) -> Indexed<Enumerate<I>> {
        Indexed(self.0.enumerate())
    }

    /// Pairs of elements with the same number.
    pub fn zip<Z: IntoRayon<Iter: IndexedParallelIterator>>(self, other: Z) -> Indexed<Zip<I, Z::Iter>> {
        Indexed(self.0.zip(other))
    }
}

impl<I: IndexedParallelIterator> ParallelIterator for Indexed<I> {
    type Item = I::Item;

    fn drive_unindexed<C: UnindexedConsumer<Self::Item>>(self, consumer: C) -> C::Result {
        self.drive(consumer)
    }

    fn opt_len(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

impl<I: IndexedParallelIterator> IndexedParallelIterator for Indexed<I> {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn drive<C: Consumer<Self::Item>>(self, consumer: C) -> C::Result {
        let length = self.0.len();
        self.0.with_producer(Consume { length, consumer })
    }

    fn with_producer<CB: ProducerCallback<Self::Item>>(self, callback: CB) -> CB::Output {
        self.0.with_producer(callback)
    }
}

/// Has the elements consumed once their producer is there.
struct Consume<C> {
    length: usize,
    consumer: C,
}

impl<T, C: Consumer<T>> ProducerCallback<T> for Consume<C> {
    type Output = C::Result;

    fn callback<P: Producer<Item = T>>(self, producer: P) -> C::Result {
        let splits = Splits::new(self.length, producer.min_len(), producer.max_len());
        consume(self.length, false, splits, producer, self.consumer)
    }
}

/// Whatever can be iterated over, and knows its length.
pub trait IntoParallelIterator: IntoRayon<Iter: IndexedParallelIterator> + Sized {
    /// The elements by value.
    fn into_par_iter(self) -> Indexed<Self::Iter> {
        Indexed(IntoRayon::into_par_iter(self))
    }
}

impl<I: IntoRayon<Iter: IndexedParallelIterator>> IntoParallelIterator for I {}

/// Views of slices.
pub trait ParallelSlice<T: Sync> {
    /// The elements.
    fn par_iter(&self) -> Indexed<Iter<'_, T>>;

    /// Pieces of a length, the last of which may be shorter.
    fn par_chunks(&self, length: usize) -> Indexed<Chunks<'_, T>>;

    /// Pieces of a length, without what is left of it at the end.
    fn par_chunks_exact(&self, length: usize) -> Indexed<ChunksExact<'_, T>>;

    /// All runs of a length.
    fn par_windows(&self, length: usize) -> Indexed<Windows<'_, T>>;
}

impl<T: Sync> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Indexed<Iter<'_, T>> {
        Indexed(IntoRayon::into_par_iter(self))
    }

    fn par_chunks(&self, length: usize) -> Indexed<Chunks<'_, T>> {
        Indexed(rayon::slice::ParallelSlice::par_chunks(self, length))
    }

    fn par_chunks_exact(&self, length: usize) -> Indexed<ChunksExact<'_, T>> {
        Indexed(rayon::slice::ParallelSlice::par_chunks_exact(self, length))
    }

    fn par_windows(&self, length: usize) -> Indexed<Windows<'_, T>> {
        Indexed(rayon::slice::ParallelSlice::par_windows(self, length))
    }
}

/// Views of slices that can be written, and sorts.
pub trait ParallelSliceMut<T: Send> {
    /// The elements.
    fn par_iter_mut(&mut self) -> Indexed<IterMut<'_, T>>;

    /// Pieces of a length, the last of which may be shorter.
    fn par_chunks_mut(&mut self, length: usize) -> Indexed<ChunksMut<'_, T>>;

    /// Runs of neighbours for which a predicate holds.
    fn par_chunk_by_mut<F: Fn(&T, &T) -> bool + Send + Sync>(&mut self, same: F) -> ChunkByMut<'_, T, F>;

    /// Sorts; equal elements may change places.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;

    /// Sorts by a comparison; equal elements may change places.
    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering + Sync);
}

impl<T: Send> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> Indexed<IterMut<'_, T>> {
        Indexed(IntoRayon::into_par_iter(self))
    }

    fn par_chunks_mut(&mut self, length: usize) -> Indexed<ChunksMut<'_, T>> {
        Indexed(rayon::slice::ParallelSliceMut::par_chunks_mut(self, length))
    }

    fn par_chunk_by_mut<F: Fn(&T, &T) -> bool + Send + Sync>(&mut self, same: F) -> ChunkByMut<'_, T, F> {
        rayon::slice::ParallelSliceMut::par_chunk_by_mut(self, same)
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        rayon::slice::ParallelSliceMut::par_sort_unstable(self);
    }

    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering + Sync) {
        rayon::slice::ParallelSliceMut::par_sort_unstable_by(self, compare);
    }
}
