//! Loops that are split into halves, with few functions for each type.
//!
//! Rayon's `join` is compiled again for each pair of closures, with some thirty functions around it: that was a quarter of the time that `planecut-csg` took to compile. Here the two halves are trait objects, so that it is
//! compiled once. That costs two indirect calls for each split.

use rayon::current_num_threads;
use rayon::iter::plumbing::{Consumer, Folder, Producer, Reducer};

use crate::awake::Helpers;

/// Half of a loop, which is told whether another thread has taken it.
type Half<'a> = &'a mut (dyn FnMut(bool) + Send);

/// Does both halves, on two threads where a second one has nothing to do.
fn join_halves(first: Half<'_>, second: Half<'_>) {
    let helpers = Helpers::new();
    rayon::join_context(
        |context| {
            first(context.migrated());
            helpers.wait();
        },
        |context| {
            if context.migrated() {
                helpers.help(|| second(true));
            } else {
                second(false);
            }
        },
    );
}

/// How far a loop is still to be split.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Splits {
    /// Into how many parts, about, it is still to be split, where no other thread takes any of them: half as many for each half.
    left: usize,
    /// The least length of a part.
    least: usize,
}

impl Splits {
    /// For a loop whose parts are to be at least and at most this long; the first of the two counts where both cannot be.
    pub(crate) fn new(length: usize, least: usize, most: usize) -> Self {
        Self { left: current_num_threads().max(length / most.max(1)), least: least.max(1) }
    }

    /// Whether a part is to be halved. One that another thread has taken shows that there are threads with nothing to do, and is split again as often as there are threads.
    fn take(&mut self, length: usize, is_taken: bool) -> bool {
        if length / 2 < self.least || (self.left == 0 && !is_taken) {
            return false;
        }
        self.left /= 2;
        if is_taken {
            self.left = self.left.max(current_num_threads());
        }
        true
    }
}

/// What a consumer makes of the elements, in their order.
pub(crate) fn consume<P, C>(length: usize, is_taken: bool, mut splits: Splits, producer: P, consumer: C) -> C::Result
where
    P: Producer,
    C: Consumer<P::Item>,
{
    if consumer.full() {
        return consumer.into_folder().complete();
    }
    if !splits.take(length, is_taken) {
        return producer.fold_with(consumer.into_folder()).complete();
    }
    let middle = length / 2;
    let halves = producer.split_at(middle);
    let (of_first, of_second, reducer) = consumer.split_at(middle);
    let (mut first, mut second) = (Some((halves.0, of_first)), Some((halves.1, of_second)));
    let mut results = (None, None);
    join_halves(
        &mut |is_taken| {
            results.0 = first.take().map(|(half, consumer)| consume(middle, is_taken, splits, half, consumer));
        },
        &mut |is_taken| {
            results.1 =
                second.take().map(|(half, consumer)| consume(length - middle, is_taken, splits, half, consumer));
        },
    );
    match results {
        (Some(first), Some(second)) => reducer.reduce(first, second),
        _ => unreachable!("both halves are done once, or one of them has panicked"),
    }
}
