//! Pairs of groups that may be merged, the one of least cost first.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use planecut_csg::stages::Bounds;
use planecut_kernel::HalfSpace;
use planecut_parallel::prelude::*;

use super::box_list::BoxList;
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
    /// The box of each slot's hull where that covers probes which nothing else does; else nothing.
    reach: BoxList,
    /// Empty slots.
    vacant: Vec<u32>,
    /// The slots of each place's pairs; some are empty by now, or another pair's.
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
        let slot = self.vacant.pop().unwrap_or(self.slots.len() as u32);
        if slot as usize == self.slots.len() {
            self.slots.push(None);
            self.reach.push(Bounds::EMPTY);
        }
        self.queue.push(Reverse(Entry { is_far: pair.is_far, cost: pair.cost, places: pair.places, slot }));
        for place in pair.places {
            self.of_place[place as usize].push(slot);
        }
        self.reach.set(slot, if pair.fresh > 0 { pair.hull.bounds } else { Bounds::EMPTY });
        self.slots[slot as usize] = Some(pair);
        self.count += 1;
    }

    /// Takes the pair of least cost out.
    pub(super) fn pop(&mut self) -> Option<Pair> {
        loop {
            let Reverse(entry) = self.queue.pop()?;
            if self.get(&entry).is_some() {
                return self.take(entry.slot);
            }
        }
    }

    fn take(&mut self, slot: u32) -> Option<Pair> {
        let pair = self.slots[slot as usize].take()?;
        self.reach.set(slot, Bounds::EMPTY);
        self.vacant.push(slot);
        self.count -= 1;
        Some(pair)
    }

    /// Takes all pairs of a place out and returns who the other ones are.
    pub(super) fn take_of(&mut self, place: u32) -> Vec<u32> {
        let mut others = Vec::new();
        for slot in std::mem::take(&mut self.of_place[place as usize]) {
            let is_own = |pair: &Pair| pair.places.contains(&place);
            if self.slots[slot as usize].as_ref().is_some_and(is_own)
                && let Some(Pair { places: [a, b], .. }) = self.take(slot)
            {
                others.push(if a == place { b } else { a });
            }
        }
        others
    }

    /// Updates what pairs cost whose hulls cover fresh probes and reach into a box: what is asked for says how many of these are left, and the cost.
    pub(super) fn update(&mut self, bounds: &Bounds, cost: impl Fn(&Pair) -> (u32, f64) + Sync) {
        let touching = self.reach.touching(bounds);
        let slots = &self.slots;
        let costs = touching.par_iter().with_min_len(32).map(|slot| slots[*slot as usize].as_ref().map(&cost));
        let costs: Vec<Option<(u32, f64)>> = costs.collect();
        for (slot, found) in touching.into_iter().zip(costs) {
            let (Some(pair), Some((fresh, cost))) = (self.slots[slot as usize].as_mut(), found) else { continue };
            let is_same = pair.cost.total_cmp(&cost).is_eq();
            (pair.fresh, pair.cost) = (fresh, cost);
            if fresh == 0 {
                self.reach.set(slot, Bounds::EMPTY);
            }
            if !is_same {
                let (is_far, places) = (pair.is_far, pair.places);
                self.queue.push(Reverse(Entry { is_far, cost, places, slot }));
            }
        }
    }

    /// The pair of an entry that is not out of date.
    fn get(&self, entry: &Entry) -> Option<&Pair> {
        let pair = self.slots[entry.slot as usize].as_ref()?;
        (pair.places == entry.places && pair.cost.total_cmp(&entry.cost).is_eq()).then_some(pair)
    }
}
