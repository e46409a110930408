//! Greedy merging: of all pairs of neighbours always the one that costs least.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::HalfSpace;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::box_list::BoxList;
use super::hull::Hull;
use super::pairs::{Pair, Pairs};
use super::probes::{add, count_fresh};
use super::search::{Group, Search};

/// Least number of neighbours that each group knows.
const NEIGHBOURS: usize = 12;

/// Room for rounding where a distance is derived from areas, as a factor.
const SURELY: f64 = 1.0 + 1e-9;
/// Number of neighbours that a group keeps of others that it took in.
const PARTNERS: usize = 32;
/// Number of pairs whose probes are looked for at the same time.
const COVERED: usize = 8;
/// Number of pairs that are tried at the same time.
const ASKED: usize = 4;

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
    /// The box of each group's hull.
    boxes: BoxList,
    pairs: Pairs,
    /// The probes that are covered, by these groups or by others.
    covered: Vec<u64>,
    count: usize,
}

impl<'a> Merger<'a> {
    /// Begins with groups; `covered` are the probes that others cover.
    pub(super) fn new(search: &'a Search<'a>, groups: Vec<Group>, mut covered: Vec<u64>) -> Self {
        groups.iter().for_each(|group| add(&mut covered, group.hull.coverage(search.probes)));
        let count = groups.len();
        let boxes = BoxList::new(groups.iter().map(|group| group.hull.bounds).collect());
        let groups = groups.into_iter().map(Some).collect();
        let mut merger = Self { search, groups, boxes, pairs: Pairs::new(count), covered, count };
        merger.find_pairs(&merger.neighbours());
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
        job::check();
        if self.pairs.is_empty() {
            // groups that are far apart are no neighbours until nothing else is left
            self.find_pairs(&self.all_pairs());
        }
        let best = self.pop()?;
        Some(self.merge(best))
    }

    /// The same for the pair of least cost among those that cover no new probe and of which the exact hull can be had: that is asked of the
    /// places of both and their hull. Pairs of which it cannot are dropped.
    pub(super) fn step_freely(
        &mut self,
        exact: impl Fn([u32; 2], &Hull) -> Option<Vec<HalfSpace>> + Sync,
    ) -> Option<(Merge, Vec<HalfSpace>)> {
        loop {
            job::check();
            let mut best = self.pop()?;
            if let Some(half_spaces) = best.free.take() {
                return Some((self.merge(best), half_spaces));
            }
            let (mut asked, mut known) = (vec![best], Vec::new());
            while asked.len() < ASKED
                && let Some(pair) = self.pop()
            {
                if pair.free.is_some() { known.push(pair) } else { asked.push(pair) }
            }
            asked.retain(|pair| pair.fresh == 0);
            asked.par_iter_mut().with_max_len(1).for_each(|pair| pair.free = exact(pair.places, &pair.hull));
            let answered = asked.into_iter().filter(|pair| pair.free.is_some());
            answered.chain(known).for_each(|pair| self.pairs.insert(pair));
        }
    }

    /// Takes the pair of least cost out. Costs are lower bounds until the probes of a hull are known, and most pairs go before theirs are.
    fn pop(&mut self) -> Option<Pair> {
        loop {
            let first = self.pairs.pop()?;
            if first.hull.is_covered() {
                return Some(first);
            }
            let (mut asked, mut known) = (vec![first], None);
            while asked.len() < COVERED
                && known.is_none()
                && let Some(pair) = self.pairs.pop()
            {
                if pair.hull.is_covered() { known = Some(pair) } else { asked.push(pair) }
            }
            let (search, groups, covered) = (self.search, &self.groups, &self.covered);
            let set_cost = |pair: &mut Pair| (pair.fresh, pair.cost) = cost_of(search, groups, covered, pair);
            asked.par_iter_mut().with_min_len(2).for_each(set_cost);
            asked.into_iter().chain(known).for_each(|pair| self.pairs.insert(pair));
        }
    }

    fn merge(&mut self, pair: Pair) -> Merge {
        let Pair { places: [kept, other], hull, .. } = pair;
        let mut gone = vec![other];
        gone.extend(
            self.boxes.touching(&hull.reach()).into_iter().filter(|place| ![kept, other].contains(place)).filter(
                |place| {
                    let within = |group: &Group| {
                        self.search.may_join(group.parts[0], self.first_part(kept))
                            && hull.holds(&group.hull.bounds, &group.hull.corners)
                    };
                    self.groups[*place as usize].as_ref().is_some_and(within)
                },
            ),
        );
        let mut parts: Vec<u32> = self.groups[kept as usize].take().map_or(Vec::new(), |group| group.parts);
        for place in &gone {
            parts.extend(self.groups[*place as usize].take().into_iter().flat_map(|group| group.parts));
        }
        self.count -= gone.len();
        gone.iter().for_each(|place| self.boxes.set(*place, Bounds::EMPTY));
        self.boxes.set(kept, hull.bounds);
        let coverage = hull.coverage(self.search.probes);
        let adds = count_fresh(&self.covered, coverage) > 0;
        add(&mut self.covered, coverage);
        let bounds = hull.bounds;
        self.groups[kept as usize] = Some(Group { parts, hull });

        let is_changed = |place: u32| place == kept || gone.contains(&place);
        let mut partners: Vec<u32> = gone.iter().chain([&kept]).flat_map(|place| self.pairs.take_of(*place)).collect();
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
        if adds {
            let (search, groups, covered) = (self.search, &self.groups, &self.covered);
            self.pairs.update(&bounds, |pair| cost_of(search, groups, covered, pair));
        }
        let new: Vec<[u32; 2]> = partners.into_iter().map(|place| [place.min(kept), place.max(kept)]).collect();
        self.find_pairs(&new);
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
        let bounds: Vec<Bounds> = self.groups.iter().flatten().map(|group| group.hull.bounds).collect();
        let boxes = Boxes::new(bounds.clone());
        let of_place = |number: u32| {
            let own = alive[number as usize];
            let may_join = |other: &u32| {
                *other != number && self.search.may_join(self.first_part(alive[*other as usize]), self.first_part(own))
            };
            let nearest = nearest(&boxes, &bounds, number, may_join);
            nearest
                .into_iter()
                .map(|other| alive[other as usize])
                .map(|other| [other.min(own), other.max(own)])
                .collect::<Vec<_>>()
        };
        let mut pairs: Vec<[u32; 2]> = (0..alive.len() as u32).into_par_iter().flat_map_iter(of_place).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Adds those of some pairs that may be merged.
    fn find_pairs(&mut self, places: &[[u32; 2]]) {
        let pair = |places: &[u32; 2]| {
            let [a, b] = places.map(|place| self.groups[place as usize].as_ref());
            let (a, b) = (a?, b?);
            if !self.search.may_join(a.parts[0], b.parts[0]) {
                return None;
            }
            let (hull, is_near) = self.search.joined_groups(a, b)?;
            // until its probes are asked for
            let least = self.search.cost(0, hull.volume - a.hull.volume - b.hull.volume);
            Some(Pair { places: *places, fresh: 0, cost: least, is_far: !is_near, hull, free: None })
        };
        // what a thread takes at once is worth the switch
        let found: Vec<Pair> = places.par_iter().with_min_len(4).filter_map(pair).collect();
        found.into_iter().for_each(|pair| self.pairs.insert(pair));
    }
}

/// The boxes with which one shares the smallest box, of those that may be taken.
fn nearest(boxes: &Boxes, bounds: &[Bounds], number: u32, may_take: impl Fn(&u32) -> bool) -> Vec<u32> {
    let own = &bounds[number as usize];
    let size = own.max - own.min;
    let mut reach = (0.25 * size.length()).max(f64::MIN_POSITIVE);
    let mut near = Vec::new();
    loop {
        boxes.touching(&Bounds { min: own.min - reach, max: own.max + reach }, &mut near);
        let is_all = near.len() == bounds.len();
        near.retain(&may_take);
        let mut others: Vec<(f64, u32)> =
            near.iter().map(|other| (common_box(own, &bounds[*other as usize]), *other)).collect();
        if others.len() > NEIGHBOURS {
            let by_size = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            others.select_nth_unstable_by(NEIGHBOURS - 1, by_size);
            others.truncate(NEIGHBOURS);
        }
        // what is farther along an axis makes the common box longer by as much at least
        let across = size.element_sum() - size.max_element();
        let most = others.iter().map(|(common, _)| *common).fold(0.0, f64::max);
        let needed = (most - common_box(own, own)) / across * SURELY;
        if is_all || others.len() == NEIGHBOURS && needed <= reach {
            return others.into_iter().map(|(_, other)| other).collect();
        }
        reach = if others.len() == NEIGHBOURS && needed.is_finite() { needed } else { 2.0 * reach };
    }
}

/// How many probes a pair covers that are not covered yet, and what it costs.
fn cost_of(search: &Search, groups: &[Option<Group>], covered: &[u64], pair: &Pair) -> (u32, f64) {
    let volume = |place: u32| groups[place as usize].as_ref().map_or(0.0, |group| group.hull.volume);
    let own = pair.hull.volume - volume(pair.places[0]) - volume(pair.places[1]);
    let fresh = count_fresh(covered, pair.hull.coverage(search.probes));
    (fresh, search.cost(fresh, own))
}

/// Half the area of the box around two boxes: the less, the nearer they are.
fn common_box(a: &Bounds, b: &Bounds) -> f64 {
    let both = a.union(b);
    let size = both.max - both.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}
