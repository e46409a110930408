//! Numbers for keys: equal keys get one number, and keys sort as integers.

use std::hash::{BuildHasher, Hash};
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_parallel::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap};

use super::{by_group, concat_owned, made_by_place, repeated};
use crate::ids::number32;

/// Number of keys, about, that a thread numbers in a row.
const KEYS_OF_CHUNK: usize = 1 << 13;

/// Number of places of a table in which keys that may be equal are sought by their hashes.
const SLOTS: usize = 1 << 10;

/// Maximum number of keys that may be equal and are sought in that table; for more, which would fill it, there is a map.
const FEW: usize = SLOTS / 2;

/// By which four numbers are multiplied and summed up to one that tells most of them apart: none is a short sum of the others.
pub(crate) const WEIGHTS: [f64; 4] = [0.731_592_653_589, 0.467_182_818_284, 0.618_033_988_749, 0.914_213_562_373];

/// The different keys, and for each key given the place of its like among them.
///
/// `key` gives each from its place, and is asked twice, so that a long list of keys need not be kept. `group` gives a number below `bound` which equal keys
/// share: keys are numbered group by group, and those of groups near each other lie near each other. `number_of` gives the number of a key from its place.
pub(crate) fn intern<K: Copy + Eq + Hash + Send + Sync, N: Send>(
    keys: usize,
    key: impl Fn(usize) -> K + Sync,
    bound: usize,
    group: impl Fn(&K) -> usize + Sync,
    number_of: impl Fn(usize) -> N + Sync,
) -> (Vec<K>, Vec<N>) {
    let group_of = |place: usize| number32(group(&key(place)));
    let of_key: Vec<u32> = made_by_place(keys, KEYS_OF_CHUNK / 4, group_of);
    let (starts, members) = by_group(bound, keys, |place| of_key[place] as usize, number32);
    let numbers = repeated(keys, || AtomicU32::new(0));
    // groups in runs of about as many keys
    let count = keys.div_ceil(KEYS_OF_CHUNK);
    let first_group = |chunk: usize| match chunk {
        0 => 0,
        _ if chunk == count => bound,
        _ => starts[..bound].partition_point(|start| (*start as usize) < chunk * KEYS_OF_CHUNK),
    };
    let runs: Vec<Range<usize>> = (0..count).map(|chunk| first_group(chunk)..first_group(chunk + 1)).collect();
    let different: Vec<Vec<K>> = runs
        .par_iter()
        .map(|groups| {
            let mut different = Different::default();
            for ends in starts[groups.start..=groups.end].windows(2) {
                let members = &members[ends[0] as usize..ends[1] as usize];
                different.begin_group(members.len());
                for &place in members {
                    numbers[place as usize].store(different.number(key(place as usize)), Ordering::Relaxed);
                }
            }
            different.keys
        })
        .collect();
    drop((members, starts));
    let (mut first, mut end) = (vec![0; bound], 0);
    for (groups, different) in runs.into_iter().zip(&different) {
        first[groups].fill(end);
        end += number32(different.len());
    }
    let number =
        |place: usize| number_of((numbers[place].load(Ordering::Relaxed) + first[of_key[place] as usize]) as usize);
    let all_numbers = made_by_place(keys, KEYS_OF_CHUNK / 4, number);
    drop((numbers, of_key));
    (concat_owned(different), all_numbers)
}

/// The different keys of some groups.
struct Different<K> {
    keys: Vec<K>,
    /// Where those of the group at hand begin.
    first: usize,
    /// The numbers of these by their hashes, among older ones, where keys of the group are few.
    slots: Vec<u32>,
    /// The same where they are many.
    number: FxHashMap<K, u32>,
    are_many: bool,
}

impl<K> Default for Different<K> {
    fn default() -> Self {
        Self { keys: Vec::new(), first: 0, slots: vec![u32::MAX; SLOTS], number: FxHashMap::default(), are_many: false }
    }
}

impl<K: Copy + Eq + Hash> Different<K> {
    /// Begins with another group, of some keys.
    fn begin_group(&mut self, keys: usize) {
        self.first = self.keys.len();
        self.are_many = keys > FEW;
        if self.are_many {
            self.number.clear();
        }
    }

    fn number(&mut self, key: K) -> u32 {
        let fresh = self.keys.len();
        if self.are_many {
            let number = *self.number.entry(key).or_insert(number32(fresh));
            if number as usize == fresh {
                self.keys.push(key);
            }
            return number;
        }
        // Whether it is there already would mostly be guessed wrong: it is added, and removed where it was there.
        self.keys.push(key);
        #[expect(clippy::cast_possible_truncation, reason = "the last bits are what counts")]
        let mut slot = hash_of(&key) as usize % SLOTS;
        loop {
            let known = self.slots[slot] as usize;
            let number = if self.first <= known && known < fresh { known } else { fresh };
            if self.keys[number] == key {
                self.slots[slot] = number32(number);
                self.keys.truncate(fresh + usize::from(number == fresh));
                return number32(number);
            }
            slot = (slot + 1) % SLOTS;
        }
    }
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
        const CHUNK: u64 = KEYS_OF_CHUNK as u64;
        for count in [0, 1, 100, CHUNK - 1, CHUNK + 1, 5 * CHUNK + 3] {
            let keys: Vec<u64> = (0..count).map(|k| k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 50).collect();
            // groups of one key, of some keys, and of very many
            for shift in [0, 4, 12] {
                let group = |key: &u64| (*key >> shift) as usize;
                let (found, numbers) = intern(keys.len(), |place| keys[place], 1 << 14, group, |place| place);
                assert!(keys.iter().zip(&numbers).all(|(key, number)| found[*number] == *key));
                assert!(found.is_sorted_by_key(group));
                let mut sorted = found.clone();
                sorted.sort_unstable();
                sorted.dedup();
                assert_eq!(sorted.len(), found.len());
            }
        }
    }
}
