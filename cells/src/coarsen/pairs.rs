//! Pairs of groups that may be merged, the one of least cost first.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use planecut_kernel::HalfSpace;
use planecut_parallel::prelude::*;

use super::hull::Hull;

/// Two groups, by place, and their hull.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub(super) places: [u32; 2],
    pub(super) hull: Hull,
    /// How many probes it covers that nothing else does.
    pub(super) fresh: u32,
    pub(super) cost: f64,
    /// Whether there is much empty space between both: such pairs come after all others.
    pub(super) is_far: bool,
    /// The exact hull, once it is known that it adds nothing.
    pub(super) free: Option<Vec<HalfSpace>>,
}

/// Pairs in a queue.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    slots: Vec<Option<Pair>>,
    /// The slots of each place's pairs, some of them empty by now.
    of_place: Vec<Vec<u32>>,
    /// Some are out of date: their pair is gone or costs something else.
    queue: BinaryHeap<Reverse<Entry>>,
    count: usize,
}

/// When a pair's turn is.
#[derive(Debug, Clone, Copy)]
struct Entry {
    is_far: bool,
    cost: f64,
    places: [u32; 2],
    slot: u32,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = self.is_far.cmp(&other.is_far).then(self.cost.total_cmp(&other.cost));
        by_cost.then_with(|| (self.places, self.slot).cmp(&(other.places, other.slot)))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Entry {}

impl Pairs {
    /// No pairs, for a number of places.
    pub(super) fn new(places: usize) -> Self {
        Self { of_place: vec![Vec::new(); places], ..Self::default() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Pair> {
        self.slots.iter().flatten()
    }

    pub(super) fn insert(&mut self, pair: Pair) {
        let slot = self.slots.len() as u32;
        self.queue.push(Reverse(Entry { is_far: pair.is_far, cost: pair.cost, places: pair.places, slot }));
        for place in pair.places {
            self.of_place[place as usize].push(slot);
        }
        self.slots.push(Some(pair));
        self.count += 1;
    }

    /// Takes the pair of least cost out.
    pub(super) fn pop(&mut self) -> Option<Pair> {
        loop {
            let Reverse(entry) = self.queue.pop()?;
            if self.get(&entry).is_some() {
                self.count -= 1;
                return self.slots[entry.slot as usize].take();
            }
        }
    }

    /// Takes all pairs of a place out and returns who the other ones are.
    pub(super) fn take_of(&mut self, place: u32) -> Vec<u32> {
        let slots = std::mem::take(&mut self.of_place[place as usize]);
        let taken: Vec<Pair> = slots.into_iter().filter_map(|slot| self.slots[slot as usize].take()).collect();
        self.count -= taken.len();
        taken.into_iter().map(|Pair { places: [a, b], .. }| if a == place { b } else { a }).collect()
    }

    /// Changes what pairs cost.
    pub(super) fn update(&mut self, change: impl Fn(&mut Pair) + Sync) {
        let changed = self.slots.par_iter_mut().enumerate().with_min_len(64).filter_map(|(slot, pair)| {
            let pair = pair.as_mut()?;
            let before = pair.cost;
            change(pair);
            let is_same = before.total_cmp(&pair.cost).is_eq();
            let (is_far, cost, places) = (pair.is_far, pair.cost, pair.places);
            (!is_same).then_some(Entry { is_far, cost, places, slot: slot as u32 })
        });
        let changed: Vec<Entry> = changed.collect();
        self.queue.extend(changed.into_iter().map(Reverse));
    }

    /// The pair of an entry that is not out of date.
    fn get(&self, entry: &Entry) -> Option<&Pair> {
        let pair = self.slots[entry.slot as usize].as_ref()?;
        pair.cost.total_cmp(&entry.cost).is_eq().then_some(pair)
    }
}
