//! Better groups, a few at a time: their parts are merged again, with what the other groups cover known.
//!
//! Greedy merging knows nothing of what comes later; parts of two groups that are merged again while all others stay
//! often find better company ("ruin and recreate": Schrimpf, Schneider, Stamm-Wilbrandt, Dueck 2000).

use planecut_csg::stages::Bounds;
use planecut_parallel::prelude::*;

use super::hull::Hull;
use super::merge::Merger;
use super::probes::{add, count_fresh};
use super::relocate::Clock;
use super::search::{Group, Search};

/// Number of nearest groups with which each group is merged again.
const NEAREST: usize = 6;
/// Maximum number of parts that are merged again at once.
const MOST_PARTS: usize = 100;

/// Merges pairs of neighbouring groups again where that pays, those of which one changed after `since`; tells whether any was replaced.
/// It takes no more than half of the work that may be done, which is what merging the parts of each pair takes: about the square of how
/// many they are.
pub(super) fn regroup(search: &Search, groups: &mut [Group], clock: &mut Clock, since: u64, work: &mut usize) -> bool {
    let mut pairs = neighbours(&groups.iter().map(|group| group.hull.bounds).collect::<Vec<_>>());
    pairs.retain(|pair| pair.iter().any(|group| clock.is_changed(*group, since)));
    *work -= limit_work(search, groups, &mut pairs, *work / 2);
    let view: &[Group] = groups;
    let mut found: Vec<(f64, usize, Vec<Group>)> = pairs
        .par_iter()
        .enumerate()
        .filter_map(|(number, pair)| {
            let (gain, new) = try_pair(search, view, pair)?;
            Some((gain, number, new))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut applied: Vec<usize> = Vec::new();
    for (_, number, new) in found {
        let pair = &pairs[number];
        let touches = |a: &usize, b: &usize| groups[*a].hull.bounds.touches(&groups[*b].hull.bounds);
        if pair.iter().any(|group| applied.iter().any(|done| done == group || touches(done, group))) {
            continue;
        }
        for (place, group) in pair.iter().zip(new) {
            groups[*place] = group;
            clock.touch(*place);
            applied.push(*place);
        }
    }
    !applied.is_empty()
}

/// Leaves as many pairs as the budget of work suffices for, in their order: those where there is most to gain. Returns the work.
fn limit_work(search: &Search, groups: &[Group], pairs: &mut Vec<[usize; 2]>, most: usize) -> usize {
    let parts = |pair: &[usize; 2]| pair.iter().map(|group| groups[*group].parts.len()).sum::<usize>();
    let work = |pair: &[usize; 2]| parts(pair).pow(2);
    pairs.retain(|pair| (pair.len() + 1..=MOST_PARTS).contains(&parts(pair)));
    let all = pairs.iter().map(work).sum::<usize>();
    if all <= most {
        return all;
    }
    let empty = |group: &Group| {
        let filled: f64 = group.parts.iter().map(|part| search.hull(*part).volume).sum();
        (group.hull.volume - filled).max(0.0)
    };
    let empty: Vec<f64> = groups.iter().map(empty).collect();
    let gain = |pair: &[usize; 2]| pair.iter().map(|group| empty[*group]).sum::<f64>() / work(pair) as f64;
    pairs.sort_by(|a, b| gain(b).total_cmp(&gain(a)).then_with(|| a.cmp(b)));
    let mut done = 0;
    let mut is_within = |pair: &&[usize; 2]| {
        let with = done + work(pair);
        let is_within = with <= most;
        if is_within {
            done = with;
        }
        is_within
    };
    let count = pairs.iter().take_while(|pair| is_within(pair)).count();
    pairs.truncate(count);
    pairs.sort_unstable();
    done
}

/// Pairs of boxes that are near each other.
pub(super) fn neighbours(bounds: &[Bounds]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (place, own) in bounds.iter().enumerate() {
        let reach = |other: usize| {
            let both = own.union(&bounds[other]);
            ((both.max - both.min).length_squared(), other)
        };
        let mut near: Vec<(f64, usize)> = (0..bounds.len()).filter(|other| *other != place).map(reach).collect();
        if near.len() > NEAREST {
            near.select_nth_unstable_by(NEAREST - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            near.truncate(NEAREST);
        }
        near.retain(|(_, other)| bounds[*other].touches(own));
        pairs.extend(near.into_iter().map(|(_, other)| [place.min(other), place.max(other)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The parts of a pair of groups merged again into two, and what that gains; `None` for nothing.
fn try_pair(search: &Search, groups: &[Group], pair: &[usize; 2]) -> Option<(f64, Vec<Group>)> {
    let parts: Vec<u32> = pair.iter().flat_map(|place| groups[*place].parts.iter().copied()).collect();
    // whatever becomes of the pair stays within the box of both
    let bounds = pair.iter().fold(Bounds::EMPTY, |all, place| all.union(&groups[*place].hull.bounds));
    let covered = covered_beside(search, groups.iter().map(|group| &group.hull), pair, &bounds);
    let before = cost(search, &covered, pair.iter().map(|place| &groups[*place].hull));
    let mut merger = Merger::new(search, parts.into_iter().map(|part| search.single(part)).collect(), covered.clone());
    while merger.count() > pair.len() {
        merger.step()?;
        // it becomes no less
        if search.cost(merger.count_fresh(&covered), 0.0) >= before {
            return None;
        }
    }
    let new = merger.into_groups();
    let gain = before - cost(search, &covered, new.iter().map(|group| &group.hull));
    (new.len() == pair.len() && gain > search.least_gain()).then_some((gain, new))
}

/// The probes that hulls cover which reach into a box, but for those of a pair.
pub(super) fn covered_beside<'a>(
    search: &Search,
    hulls: impl Iterator<Item = &'a Hull>,
    pair: &[usize; 2],
    bounds: &Bounds,
) -> Vec<u64> {
    let mut covered = vec![0_u64; search.probes.words()];
    let others = hulls.enumerate().filter(|(place, hull)| !pair.contains(place) && hull.bounds.touches(bounds));
    others.for_each(|(_, hull)| add(&mut covered, hull.coverage(search.probes)));
    covered
}

/// What hulls cost where other probes are covered already.
pub(super) fn cost<'a>(search: &Search, covered: &[u64], hulls: impl Iterator<Item = &'a Hull>) -> f64 {
    let (mut all, mut fresh, mut volume) = (covered.to_vec(), 0, 0.0);
    for hull in hulls {
        fresh += count_fresh(&all, hull.coverage(search.probes));
        add(&mut all, hull.coverage(search.probes));
        volume += hull.volume;
    }
    search.cost(fresh, volume)
}
