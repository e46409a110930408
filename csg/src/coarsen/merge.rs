//! Greedy merging: of all pairs of neighbours always the one that costs least.

use rayon::prelude::*;

use super::hull::Hull;
use super::probes::{add, count_fresh};
use super::search::{Group, Search};
use crate::bounds::Bounds;

/// Each group knows at least so many neighbours.
const NEIGHBOURS: usize = 12;

/// A group that took others in keeps so many of their neighbours.
const PARTNERS: usize = 32;
/// So many pairs are asked for their answers at the same time.
const ASKED: usize = 8;

/// Two groups, by place, and their hull.
#[derive(Debug, Clone)]
struct Pair {
    places: [u32; 2],
    hull: Hull,
    /// How many probes it covers that nothing else does.
    fresh: u32,
    cost: f64,
    /// Whether it fulfils what was asked of it.
    answer: Option<bool>,
}

/// A group took others in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Merge {
    pub(super) kept: u32,
    pub(super) gone: Vec<u32>,
}

/// Groups that become fewer.
#[derive(Debug)]
pub(super) struct Merger<'a> {
    search: &'a Search<'a>,
    groups: Vec<Option<Group>>,
    pairs: Vec<Pair>,
    /// The probes that are covered, by these groups or by others.
    covered: Vec<u64>,
    count: usize,
}

impl<'a> Merger<'a> {
    /// Begins with groups; `covered` are the probes that others cover.
    pub(super) fn new(search: &'a Search<'a>, groups: Vec<Group>, mut covered: Vec<u64>) -> Self {
        groups.iter().for_each(|group| add(&mut covered, &group.hull.coverage));
        let count = groups.len();
        let mut merger =
            Self { search, groups: groups.into_iter().map(Some).collect(), pairs: Vec::new(), covered, count };
        merger.pairs = merger.pairs_of(&merger.neighbours());
        merger
    }

    /// The hulls of the pairs that may be merged next.
    pub(super) fn hulls(&self) -> impl Iterator<Item = ([u32; 2], Hull)> + '_ {
        self.pairs.iter().map(|pair| (pair.places, pair.hull.clone()))
    }

    /// How many groups there are.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The groups.
    pub(super) fn into_groups(self) -> Vec<Group> {
        self.groups.into_iter().flatten().collect()
    }

    /// How many probes are covered that were not at first.
    pub(super) fn count_fresh(&self, first: &[u64]) -> u32 {
        self.covered.iter().zip(first).map(|(now, first)| (now & !first).count_ones()).sum()
    }

    /// The volume that was added so far, as far as probes can tell.
    pub(super) fn added(&self) -> f64 {
        self.search.probes.volume(self.covered.iter().map(|word| word.count_ones()).sum())
    }

    /// Merges the pair that costs least and takes in all groups that lie within; `None` where no pair may be merged.
    pub(super) fn step(&mut self) -> Option<Merge> {
        if self.pairs.is_empty() {
            // groups that are far apart are no neighbours until nothing else is left
            self.pairs = self.pairs_of(&self.all_pairs());
        }
        let best = (0..self.pairs.len()).min_by(|a, b| self.compare(*a, *b))?;
        Some(self.merge(best))
    }

    /// The same for the pair of least cost among those that cover no new probe and fulfil a condition, which is asked of the places of
    /// both and their hull, once; pairs of these that do not fulfil it are dropped.
    pub(super) fn step_where(&mut self, condition: impl Fn([u32; 2], &Hull) -> bool + Sync) -> Option<Merge> {
        loop {
            let free = || (0..self.pairs.len()).filter(|k| self.pairs[*k].fresh == 0);
            let best = free().min_by(|a, b| self.compare(*a, *b))?;
            match self.pairs[best].answer {
                Some(true) => return Some(self.merge(best)),
                Some(false) => {
                    self.pairs.swap_remove(best);
                }
                None => {
                    let mut open: Vec<usize> = free().filter(|k| self.pairs[*k].answer.is_none()).collect();
                    if open.len() > ASKED {
                        open.select_nth_unstable_by(ASKED - 1, |a, b| self.compare(*a, *b));
                        open.truncate(ASKED);
                    }
                    let ask = |k: &usize| condition(self.pairs[*k].places, &self.pairs[*k].hull);
                    let answers: Vec<bool> = open.par_iter().with_max_len(1).map(ask).collect();
                    for (k, answer) in open.into_iter().zip(answers) {
                        self.pairs[k].answer = Some(answer);
                    }
                }
            }
        }
    }

    fn compare(&self, a: usize, b: usize) -> std::cmp::Ordering {
        let (a, b) = (&self.pairs[a], &self.pairs[b]);
        a.cost.total_cmp(&b.cost).then_with(|| a.places.cmp(&b.places))
    }

    fn merge(&mut self, pair: usize) -> Merge {
        let Pair { places: [kept, other], hull, .. } = self.pairs.swap_remove(pair);
        let mut gone = vec![other];
        gone.extend((0..self.groups.len() as u32).filter(|place| ![kept, other].contains(place)).filter(|place| {
            let within = |group: &Group| {
                self.search.may_join(group.parts[0], self.first_part(kept))
                    && hull.holds(&group.hull.bounds, &group.hull.corners)
            };
            self.groups[*place as usize].as_ref().is_some_and(within)
        }));
        let mut parts: Vec<u32> = self.groups[kept as usize].take().map_or(Vec::new(), |group| group.parts);
        for place in &gone {
            parts.extend(self.groups[*place as usize].take().into_iter().flat_map(|group| group.parts));
        }
        self.count -= gone.len();
        let adds = count_fresh(&self.covered, &hull.coverage) > 0;
        add(&mut self.covered, &hull.coverage);
        let bounds = hull.bounds;
        self.groups[kept as usize] = Some(Group { parts, hull });

        let is_changed = |place: u32| place == kept || gone.contains(&place);
        let mut partners: Vec<u32> = Vec::new();
        self.pairs.retain(|pair| {
            let [a, b] = pair.places.map(is_changed);
            partners.extend([(a, pair.places[1]), (b, pair.places[0])].into_iter().filter(|p| p.0).map(|p| p.1));
            !a && !b
        });
        partners.retain(|place| !is_changed(*place));
        partners.sort_unstable();
        partners.dedup();
        if partners.len() > PARTNERS {
            let own = &bounds;
            let size = |place: &u32| {
                self.groups[*place as usize].as_ref().map_or(f64::INFINITY, |group| common_box(own, &group.hull.bounds))
            };
            partners.select_nth_unstable_by(PARTNERS - 1, |a, b| size(a).total_cmp(&size(b)).then(a.cmp(b)));
            partners.truncate(PARTNERS);
            partners.sort_unstable();
        }
        let (covered, search) = (&self.covered, self.search);
        let groups = &self.groups;
        let volume = |place: u32| groups[place as usize].as_ref().map_or(0.0, |group| group.hull.volume);
        let open = |pair: &&mut Pair| adds && pair.fresh > 0 && pair.hull.bounds.touches(&bounds);
        self.pairs.par_iter_mut().with_min_len(64).filter(open).for_each(|pair| {
            let own = pair.hull.volume - volume(pair.places[0]) - volume(pair.places[1]);
            pair.fresh = count_fresh(covered, &pair.hull.coverage);
            pair.cost = search.cost(pair.fresh, own);
        });
        let new: Vec<[u32; 2]> = partners.into_iter().map(|place| [place.min(kept), place.max(kept)]).collect();
        let new = self.pairs_of(&new);
        self.pairs.extend(new);
        Merge { kept, gone }
    }

    fn first_part(&self, place: u32) -> u32 {
        self.groups[place as usize].as_ref().map_or(0, |group| group.parts[0])
    }

    fn alive(&self) -> Vec<u32> {
        (0..self.groups.len() as u32).filter(|place| self.groups[*place as usize].is_some()).collect()
    }

    fn all_pairs(&self) -> Vec<[u32; 2]> {
        let alive = self.alive();
        let pairs = alive.iter().enumerate().flat_map(|(k, a)| alive[k + 1..].iter().map(|b| [*a, *b]));
        pairs.collect()
    }

    /// Pairs of groups of which one is among the nearest of the other: those with which it shares the smallest box.
    fn neighbours(&self) -> Vec<[u32; 2]> {
        let alive = self.alive();
        if alive.len() <= NEIGHBOURS + 1 {
            return self.all_pairs();
        }
        let bounds = |place: u32| self.groups[place as usize].as_ref().map(|group| group.hull.bounds).expect("alive");
        let of_place = |place: &u32| {
            let own = bounds(*place);
            let mut others: Vec<(f64, u32)> = alive
                .iter()
                .filter(|other| {
                    *other != place && self.search.may_join(self.first_part(**other), self.first_part(*place))
                })
                .map(|other| (common_box(&own, &bounds(*other)), *other))
                .collect();
            if others.len() > NEIGHBOURS {
                let by_size = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
                others.select_nth_unstable_by(NEIGHBOURS - 1, by_size);
                others.truncate(NEIGHBOURS);
            }
            others.into_iter().map(|(_, other)| [other.min(*place), other.max(*place)]).collect::<Vec<_>>()
        };
        let mut pairs: Vec<[u32; 2]> = alive.par_iter().flat_map_iter(of_place).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The pairs of some that may be merged.
    fn pairs_of(&self, places: &[[u32; 2]]) -> Vec<Pair> {
        let pair = |places: &[u32; 2]| {
            let [a, b] = places.map(|place| self.groups[place as usize].as_ref());
            let (a, b) = (a?, b?);
            if !self.search.may_join(a.parts[0], b.parts[0]) {
                return None;
            }
            let hull = self.search.joined_groups(a, b)?;
            let own = hull.volume - a.hull.volume - b.hull.volume;
            let fresh = count_fresh(&self.covered, &hull.coverage);
            Some(Pair { places: *places, fresh, cost: self.search.cost(fresh, own), hull, answer: None })
        };
        // what a thread takes at once is worth the switch
        places.par_iter().with_min_len(4).filter_map(pair).collect()
    }
}

/// Half the area of the box around two boxes: the less, the nearer they are.
fn common_box(a: &Bounds, b: &Bounds) -> f64 {
    let both = a.union(b);
    let size = both.max - both.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}
