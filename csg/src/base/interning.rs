//! Numbers for keys: equal keys get one number, and keys sort as integers.

use crate::ids::number32;
use std::hash::{BuildHasher, Hash};
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_parallel::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap};

/// Number of keys, about, that are numbered in a row: their map stays in the cache.
const BUCKET: usize = 1 << 13;

/// By which four numbers are multiplied and summed up to one that tells most of them apart: none is a short sum of the others.
pub(crate) const WEIGHTS: [f64; 4] = [0.731_592_653_589, 0.467_182_818_284, 0.618_033_988_749, 0.914_213_562_373];

/// The different keys, and for each key given the place of its like among them.
///
/// Keys are numbered bucket by bucket. `key` gives each from its place, and is asked twice, so that a long list of keys need not be kept. `near`
/// tells which keys go together: equal ones have the same number below `bound`, and those of near numbers are best found near
/// each other. `number_of` gives the number of a key from its place.
pub(crate) fn intern<K: Copy + Eq + Hash + Send + Sync, N: Send>(
    keys: usize,
    key: impl Fn(usize) -> K + Sync,
    bound: usize,
    near: impl Fn(&K) -> usize + Sync,
    number_of: impl Fn(usize) -> N + Sync,
) -> (Vec<K>, Vec<N>) {
    // a function of the keys alone, so that the numbers do not depend on the number of threads
    let count = keys.div_ceil(BUCKET);
    if count < 2 {
        let mut bucket = Bucket::default();
        let numbers = (0..keys).map(|place| number_of(bucket.number(key(place)) as usize)).collect();
        return (bucket.keys, numbers);
    }
    let width = bound.div_ceil(count).max(1);
    let bucket_of = |place: usize| number32((near(&key(place)) / width).min(count - 1));
    let of_key: Vec<u32> = (0..keys).into_par_iter().with_min_len(BUCKET).map(bucket_of).collect();
    let (starts, members) = by_group(count, of_key.iter().map(|bucket| *bucket as usize), number32);
    let numbers: Vec<AtomicU32> = (0..keys).into_par_iter().with_min_len(BUCKET).map(|_| AtomicU32::new(0)).collect();
    let buckets: Vec<Vec<K>> = starts
        .par_windows(2)
        .map(|ends| {
            let mut bucket = Bucket::default();
            for &place in &members[ends[0] as usize..ends[1] as usize] {
                numbers[place as usize].store(bucket.number(key(place as usize)), Ordering::Relaxed);
            }
            bucket.keys
        })
        .collect();
    drop(members);
    let mut first = vec![0; count];
    for k in 1..count {
        first[k] = first[k - 1] + number32(buckets[k - 1].len());
    }
    let number =
        |(number, bucket): (AtomicU32, u32)| number_of((number.into_inner() + first[bucket as usize]) as usize);
    let numbers = numbers.into_par_iter().with_min_len(BUCKET).zip(of_key).map(number).collect();
    (buckets.concat(), numbers)
}

/// Keys that are numbered in a row.
struct Bucket<K> {
    keys: Vec<K>,
    number: FxHashMap<K, u32>,
    /// The last key and its number: the same key often comes twice in a row.
    last: Option<(K, u32)>,
}

impl<K> Default for Bucket<K> {
    fn default() -> Self {
        Self { keys: Vec::new(), number: FxHashMap::default(), last: None }
    }
}

impl<K: Copy + Eq + Hash> Bucket<K> {
    fn number(&mut self, key: K) -> u32 {
        if let Some((last, number)) = self.last
            && last == key
        {
            return number;
        }
        let number = *self.number.entry(key).or_insert_with(|| {
            self.keys.push(key);
            number32(self.keys.len()) - 1
        });
        self.last = Some((key, number));
        number
    }
}

/// Sorts the places of groups: for groups numbered from 0 to `count`, where each begins in a list of all members by group, and
/// that list; members keep their order. `number` gives the number of a member from its place.
pub(crate) fn by_group<M: Copy>(
    count: usize,
    of_member: impl Iterator<Item = usize> + Clone,
    number: impl Fn(usize) -> M,
) -> (Vec<u32>, Vec<M>) {
    let mut starts = vec![0_u32; count + 1];
    let mut members = 0;
    for group in of_member.clone() {
        starts[group + 1] += 1;
        members += 1;
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut sorted = vec![number(0); members];
    for (member, group) in of_member.enumerate() {
        sorted[next[group] as usize] = number(member);
        next[group] += 1;
    }
    (starts, sorted)
}

/// A hash that is the same in each run.
pub(crate) fn hash_of(value: &impl Hash) -> u64 {
    FxBuildHasher.hash_one(value)
}

/// A number in the order of [`f64::total_cmp`].
pub(crate) fn sortable(v: f64) -> u64 {
    let bits = v.to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_keys_share_a_number_however_many_there_are() {
        for count in [0, 1, 100, BUCKET as u64 - 1, BUCKET as u64 + 1, 5 * BUCKET as u64 + 3] {
            let keys: Vec<u64> = (0..count).map(|k| k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 50).collect();
            let (found, numbers) = intern(keys.len(), |place| keys[place], 1 << 14, |key| *key as usize, |place| place);
            assert!(keys.iter().zip(&numbers).all(|(key, number)| found[*number] == *key));
            let mut sorted = found.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), found.len());
        }
    }

    #[test]
    fn members_are_listed_by_group_in_their_order() {
        let groups = [2, 0, 2, 3, 0, 2];
        let (starts, sorted) = by_group(5, groups.iter().copied(), |place| place);
        assert_eq!(starts, [0, 2, 2, 5, 6, 6]);
        assert_eq!(sorted, [1, 4, 0, 2, 5, 3]);
    }
}
