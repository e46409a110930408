//! Numbers for keys: equal keys get one number, and keys sort as integers.

use std::hash::{BuildHasher, Hash};
use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap};

/// Fewer keys than this are numbered on one thread.
const MANY: usize = 1 << 13;
/// Keys are shared out by their hash. A constant, so that the numbers do not depend on the number of threads.
const SHARDS: usize = 8;

/// The different keys, and for each key given the place of its like among them.
pub(crate) fn distinct<K: Copy + Eq + Hash + Send + Sync>(keys: &[K]) -> (Vec<K>, Vec<u32>) {
    if keys.len() < MANY {
        let mut shard = Shard::default();
        let numbers = keys.iter().map(|key| shard.number(*key)).collect();
        return (shard.keys, numbers);
    }
    let numbers: Vec<AtomicU32> = keys.par_iter().with_min_len(MANY).map(|_| AtomicU32::new(0)).collect();
    // where the keys of each shard are, chunk by chunk
    let places: Vec<[Vec<u32>; SHARDS]> =
        keys.par_chunks(MANY).enumerate().map(|(chunk, keys)| share_out(keys, chunk * MANY)).collect();
    let shards: Vec<Vec<K>> = (0..SHARDS)
        .into_par_iter()
        .map(|s| {
            let mut shard = Shard::default();
            for place in places.iter().flat_map(|chunk| &chunk[s]) {
                numbers[*place as usize].store(shard.number(keys[*place as usize]), Ordering::Relaxed);
            }
            shard.keys
        })
        .collect();
    let mut first = [0; SHARDS];
    for s in 1..SHARDS {
        first[s] = first[s - 1] + shards[s - 1].len() as u32;
    }
    let number = |(number, key): (AtomicU32, &K)| number.into_inner() + first[shard_of(key)];
    let numbers = numbers.into_par_iter().with_min_len(MANY).zip(keys).map(number).collect();
    (shards.concat(), numbers)
}

/// The keys that one thread numbers.
struct Shard<K> {
    keys: Vec<K>,
    number: FxHashMap<K, u32>,
    /// The last key and its number: the same key often comes twice in a row.
    last: Option<(K, u32)>,
}

impl<K> Default for Shard<K> {
    fn default() -> Self {
        Self { keys: Vec::new(), number: FxHashMap::default(), last: None }
    }
}

impl<K: Copy + Eq + Hash> Shard<K> {
    fn number(&mut self, key: K) -> u32 {
        if let Some((last, number)) = self.last
            && last == key
        {
            return number;
        }
        let number = *self.number.entry(key).or_insert_with(|| {
            self.keys.push(key);
            self.keys.len() as u32 - 1
        });
        self.last = Some((key, number));
        number
    }
}

fn share_out<K: Hash>(keys: &[K], first: usize) -> [Vec<u32>; SHARDS] {
    let mut places: [Vec<u32>; SHARDS] = std::array::from_fn(|_| Vec::with_capacity(keys.len() / (SHARDS - 1)));
    for (k, key) in keys.iter().enumerate() {
        places[shard_of(key)].push((first + k) as u32);
    }
    places
}

fn shard_of<K: Hash>(key: &K) -> usize {
    // bits that the maps do not use to place a key
    (FxBuildHasher.hash_one(key) >> 40) as usize % SHARDS
}

/// Sorts the places of groups: for groups numbered from 0 to `count`, where each begins in a list of all members by group, and
/// that list; members keep their order.
pub(crate) fn by_group(count: usize, of_member: impl Iterator<Item = u32> + Clone) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; count + 1];
    let mut members = 0;
    for group in of_member.clone() {
        starts[group as usize + 1] += 1;
        members += 1;
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut sorted = vec![0_u32; members];
    for (member, group) in of_member.enumerate() {
        sorted[next[group as usize] as usize] = member as u32;
        next[group as usize] += 1;
    }
    (starts, sorted)
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
        for count in [0, 1, 100, MANY as u64 - 1, MANY as u64, 5 * MANY as u64 + 3] {
            let keys: Vec<u64> = (0..count).map(|k| k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 50).collect();
            let (found, numbers) = distinct(&keys);
            assert!(keys.iter().zip(&numbers).all(|(key, number)| found[*number as usize] == *key));
            let mut sorted = found.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), found.len());
        }
    }

    #[test]
    fn members_are_listed_by_group_in_their_order() {
        let groups = [2, 0, 2, 3, 0, 2];
        let (starts, sorted) = by_group(5, groups.iter().copied());
        assert_eq!(starts, [0, 2, 2, 5, 6, 6]);
        assert_eq!(sorted, [1, 4, 0, 2, 5, 3]);
    }
}
