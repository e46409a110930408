//! Sorting by a number: what has nearly the same number is put together first, so that few elements are compared.

use std::ops::Range;

use planecut_parallel::prelude::*;

use super::memory::takes_much_memory;
use super::parallel::{map_chunks, split_by, weighed_runs};

/// Maximum number of elements that are all compared with one another.
const COMPARED: usize = 64;

/// Maximum number of those that are compared within short arrays, which take less time to make.
const FEW: usize = 16;

/// Maximum number of elements that are sorted by comparisons: where numbers lie close together but for some, buckets would have to be sorted again and again.
const SOME: usize = 512;

/// How often all elements are there at once where threads share the work, and room for more.
const COPIES: usize = 4;

/// Number of elements for each bucket, about.
const OF_BUCKET: usize = 4;

/// Number of elements from which threads share the work.
const MANY: usize = 1 << 15;

/// Least number of elements that a thread sorts in a row.
const OF_CHUNK: usize = 1 << 11;

/// Maximum number of buckets that the elements of each thread are put into.
const MOST_BUCKETS: usize = 1 << 12;

/// Sorts a list of elements by a number, which must not fall where elements rise; those of the same number must be in order. It puts them into buckets of
/// about equal numbers, each of which is sorted in the same way where it has many elements (bucket sort: Knuth, The Art of Computer Programming, volume
/// 3, section 5.2.5).
pub(crate) fn sort_by_number<T: Copy + Ord + Send + Sync>(list: &mut Vec<T>, number: impl Fn(&T) -> u64 + Sync) {
    if list.len() <= COMPARED {
        sort_few(list, &number);
    } else if takes_much_memory::<[T; COPIES]>(list.len()) {
        list.par_sort_unstable();
    } else if list.len() >= MANY && planecut_parallel::current_num_threads() > 1 {
        *list = sorted_by_threads(list, &number);
    } else {
        sort_many(list, &number);
    }
}

/// Sorts elements, of which there are mostly few, by a number: those of the same number stay in order.
#[inline]
pub(crate) fn sort_few<T: Copy>(list: &mut [T], number: &impl Fn(&T) -> u64) {
    if list.len() <= FEW {
        sort_by_counting::<T, FEW>(list, number);
    } else if list.len() <= COMPARED {
        sort_by_counting::<T, COMPARED>(list, number);
    } else {
        sort_many(list, number);
    }
}

/// Sorts a maximum number of elements by a number: for each it counts those that come before it, without a branch, which would mostly be guessed wrong
/// (comparison counting: Knuth, volume 3, section 5.2, algorithm C).
#[inline]
fn sort_by_counting<T: Copy, const MOST: usize>(list: &mut [T], number: &impl Fn(&T) -> u64) {
    let Some(first) = list.first() else { return };
    let (mut unsorted, mut numbers, mut places) = ([*first; MOST], [0; MOST], [0; MOST]);
    for (k, element) in list.iter().enumerate() {
        let own = number(element);
        let mut place = 0;
        for (other, place_of_other) in numbers[..k].iter().zip(&mut places[..k]) {
            let is_after = usize::from(*other > own);
            *place_of_other += is_after;
            place += 1 - is_after;
        }
        (unsorted[k], numbers[k], places[k]) = (*element, own, place);
    }
    let count = list.len();
    for (element, place) in unsorted[..count].iter().zip(&places) {
        list[*place] = *element;
    }
}

/// Sorts many elements by a number: those of the same number stay in order.
fn sort_many<T: Copy>(list: &mut [T], number: &impl Fn(&T) -> u64) {
    let unsorted = list.to_vec();
    if list.len() > SOME {
        return sort_into(&unsorted, list, number);
    }
    // numbers with their places, in one word
    let mut order: Vec<u128> =
        unsorted.iter().enumerate().map(|(place, element)| u128::from(number(element)) << 64 | place as u128).collect();
    order.sort_unstable();
    for (element, placed) in list.iter_mut().zip(order) {
        *element = unsorted[usize::try_from(placed & u128::from(u64::MAX)).expect("a place in the list")];
    }
}

/// Numbers from the least one on, in ranges that are equally long.
#[derive(Debug, Clone, Copy)]
struct Buckets {
    least: u64,
    shift: u32,
    count: usize,
}

impl Buckets {
    /// For numbers between two others: at most as many as are asked for, a power of two above one.
    fn new(least: u64, largest: u64, most: usize) -> Self {
        let bits = u64::BITS - (largest - least).leading_zeros();
        let shift = bits.saturating_sub(most.ilog2());
        let mut buckets = Self { least, shift, count: 0 };
        buckets.count = buckets.of(largest) + 1;
        buckets
    }

    #[expect(clippy::cast_possible_truncation, reason = "a number below that of the buckets")]
    fn of(self, number: u64) -> usize {
        ((number - self.least) >> self.shift) as usize
    }

    /// Puts elements into their buckets, in their order; gives where each bucket ends.
    fn fill<T: Copy>(self, list: &[T], filled: &mut [T], number: impl Fn(&T) -> u64) -> Vec<u32> {
        let mut next = vec![0_u32; self.count];
        list.iter().for_each(|element| next[self.of(number(element))] += 1);
        let mut end = 0;
        for next in &mut next {
            end += std::mem::replace(next, end);
        }
        for element in list {
            let place = &mut next[self.of(number(element))];
            filled[*place as usize] = *element;
            *place += 1;
        }
        next
    }
}

/// The least and the largest of the numbers of some elements.
fn extent<T>(list: &[T], number: impl Fn(&T) -> u64) -> (u64, u64) {
    list.iter().map(number).fold((u64::MAX, 0), |(least, largest), number| (least.min(number), largest.max(number)))
}

/// Sorts a list into another one of the same length.
fn sort_into<T: Copy>(list: &[T], sorted: &mut [T], number: &impl Fn(&T) -> u64) {
    let (least, largest) = extent(list, number);
    if least >= largest {
        sorted.copy_from_slice(list);
        return;
    }
    let most = (list.len() / OF_BUCKET).next_power_of_two().max(2);
    let ends = Buckets::new(least, largest, most).fill(list, sorted, number);
    let mut start = 0;
    for end in ends {
        let bucket = &mut sorted[start..end as usize];
        start = end as usize;
        if bucket.len() > 1 {
            sort_few(bucket, number);
        }
    }
}

/// A list, sorted by all threads: each puts a part of it into buckets, then the buckets of the same numbers are joined and sorted.
fn sorted_by_threads<T: Copy + Send + Sync>(list: &[T], number: &(impl Fn(&T) -> u64 + Sync)) -> Vec<T> {
    let (extents, _) = map_chunks(list, OF_CHUNK, |chunk| extent(chunk, number));
    let (least, largest) = extents.into_iter().fold((u64::MAX, 0), |all, part| (all.0.min(part.0), all.1.max(part.1)));
    let buckets = Buckets::new(least, largest, MOST_BUCKETS);
    let size = list.len().div_ceil(planecut_parallel::current_num_threads());
    let fill = |part: &[T]| {
        let mut filled = part.to_vec();
        let ends = buckets.fill(part, &mut filled, number);
        (filled, ends)
    };
    let parts: Vec<(Vec<T>, Vec<u32>)> = list.par_chunks(size).with_max_len(1).map(fill).collect();
    let start_of = |ends: &[u32], bucket: usize| if bucket == 0 { 0 } else { ends[bucket - 1] as usize };
    let range_of = |ends: &[u32], run: &Range<usize>| start_of(ends, run.start)..start_of(ends, run.end);
    let length = |run: &Range<usize>| parts.iter().map(|(_, ends)| range_of(ends, run).len()).sum();
    let runs = weighed_runs(buckets.count, OF_CHUNK, |bucket| length(&(bucket..bucket + 1)));
    let mut sorted = list.to_vec();
    let slices = split_by(&mut sorted, runs.iter().map(&length));
    runs.par_iter().zip(slices).with_max_len(1).for_each(|(run, slice)| {
        let joined: Vec<T> = parts.iter().flat_map(|(filled, ends)| &filled[range_of(ends, run)]).copied().collect();
        sort_into(&joined, slice, number);
    });
    sorted
}

/// The numbers of two things in one, in the order of the first.
pub(crate) fn number_of_two(one: u32, other: u32) -> u64 {
    u64::from(one) << 32 | u64::from(other)
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::ids::number32;

    /// Numbers of a list: anywhere, in few places, close to one another but for some, in order, and as those of places in space are spread.
    fn number(rng: &mut Rng, kind: u64, place: usize) -> u64 {
        let any = (rng.below(1 << 32) as u64) << 32 | rng.below(1 << 32) as u64;
        match kind {
            0 => any,
            1 => any >> 60,
            2 => {
                if place.is_multiple_of(97) {
                    any
                } else {
                    u64::MAX - (any >> 40)
                }
            }
            3 => place as u64 / 3,
            4 => any >> rng.below(64),
            _ => u64::MAX,
        }
    }

    #[test]
    fn lists_are_sorted_as_by_comparisons() {
        for seed in 0..60 {
            let mut rng = Rng::spread(seed);
            let count = match seed % 3 {
                0 => rng.below(2 * COMPARED),
                1 => rng.below(5_000),
                _ => MANY + rng.below(MANY),
            };
            let kind = seed / 3 % 6;
            let list: Vec<(u64, u32)> =
                (0..count).map(|place| (number(&mut rng, kind, place), number32(place))).collect();
            let mut expected = list.clone();
            expected.sort_unstable();
            let mut sorted = list.clone();
            sort_by_number(&mut sorted, |element| element.0);
            assert!(sorted == expected, "seed {seed}");
            sorted.clone_from(&list);
            sort_few(&mut sorted, &|element: &(u64, u32)| element.0);
            assert!(sorted == expected, "seed {seed}");
            if !list.is_empty() {
                assert!(sorted_by_threads(&list, &|element: &(u64, u32)| element.0) == expected, "seed {seed}");
            }
        }
    }
}
