//! Better groups, a few at a time: their parts are merged anew, with what the other groups cover known.
//!
//! Greedy merging knows nothing of what comes later; parts of two or three groups that are merged again while all others stay
//! often find better company ("ruin and recreate": Schrimpf, Schneider, Stamm-Wilbrandt, Dueck 2000).

use rayon::prelude::*;

use super::merge::Merger;
use super::probes::{add, count_fresh};
use super::relocate::Clock;
use super::search::{Group, Search};

/// Each group is merged anew with so many of its nearest ones.
const NEAREST: usize = 6;
/// Most parts that are merged anew at once.
const MOST_PARTS: usize = 100;
/// Most parts of all sets in one round: those whose hulls are emptiest go first.
const MOST_WORK: usize = 1500;

/// Merges sets of `size` neighbouring groups anew as long as that pays, those that hold a group which changed since `since`; tells whether any was
/// replaced.
pub(super) fn regroup(search: &Search, groups: &mut [Group], clock: &mut Clock, size: usize, since: u64) -> bool {
    let mut sets = sets_of_neighbours(groups, size);
    sets.retain(|set| set.iter().any(|group| clock.is_changed(*group, since)));
    limit_work(search, groups, &mut sets);
    let view: &[Group] = groups;
    let mut found: Vec<(f64, usize, Vec<Group>)> = sets
        .par_iter()
        .enumerate()
        .filter_map(|(number, set)| {
            let (gain, new) = try_set(search, view, set)?;
            Some((gain, number, new))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut applied: Vec<usize> = Vec::new();
    for (_, number, new) in found {
        let set = &sets[number];
        let touches = |a: &usize, b: &usize| groups[*a].hull.bounds.touches(&groups[*b].hull.bounds);
        if set.iter().any(|group| applied.iter().any(|done| done == group || touches(done, group))) {
            continue;
        }
        for (place, group) in set.iter().zip(new) {
            groups[*place] = group;
            clock.touch(*place);
            applied.push(*place);
        }
    }
    !applied.is_empty()
}

/// Leaves so many sets as can be looked at in reasonable time, in their order: those where there is most to gain.
fn limit_work(search: &Search, groups: &[Group], sets: &mut Vec<Vec<usize>>) {
    let parts = |set: &[usize]| set.iter().map(|group| groups[*group].parts.len()).sum::<usize>();
    sets.retain(|set| (set.len() + 1..=MOST_PARTS).contains(&parts(set)));
    if sets.iter().map(|set| parts(set)).sum::<usize>() <= MOST_WORK {
        return;
    }
    let empty = |group: &Group| {
        let filled: f64 = group.parts.iter().map(|part| search.hull(*part).volume).sum();
        (group.hull.volume - filled).max(0.0)
    };
    let empty: Vec<f64> = groups.iter().map(empty).collect();
    let gain = |set: &[usize]| set.iter().map(|group| empty[*group]).sum::<f64>() / parts(set) as f64;
    let mut ordered: Vec<(f64, Vec<usize>)> = std::mem::take(sets).into_iter().map(|set| (gain(&set), set)).collect();
    ordered.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    let mut work = 0;
    sets.extend(ordered.into_iter().map(|(_, set)| set).take_while(|set| {
        work += parts(set);
        work <= MOST_WORK
    }));
    sets.sort_unstable();
}

/// Sets of groups that are near each other.
fn sets_of_neighbours(groups: &[Group], size: usize) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for (place, group) in groups.iter().enumerate() {
        let own = &group.hull.bounds;
        let reach = |other: &usize| {
            let both = own.union(&groups[*other].hull.bounds);
            (both.max - both.min).length_squared()
        };
        let mut near: Vec<usize> = (0..groups.len()).filter(|other| *other != place).collect();
        near.sort_by(|a, b| reach(a).total_cmp(&reach(b)).then(a.cmp(b)));
        near.truncate(NEAREST);
        near.retain(|other| groups[*other].hull.bounds.touches(own));
        for (k, first) in near.iter().enumerate() {
            if size == 2 {
                sets.push(vec![place, *first]);
            } else {
                sets.extend(near[k + 1..].iter().map(|second| vec![place, *first, *second]));
            }
        }
    }
    sets.iter_mut().for_each(|set| set.sort_unstable());
    sets.sort_unstable();
    sets.dedup();
    sets
}

/// The parts of a set of groups merged anew into as many, and what that gains; `None` for nothing.
fn try_set(search: &Search, groups: &[Group], set: &[usize]) -> Option<(f64, Vec<Group>)> {
    let parts: Vec<u32> = set.iter().flat_map(|place| groups[*place].parts.iter().copied()).collect();
    let mut covered = vec![0_u64; search.probes.words()];
    let others = groups.iter().enumerate().filter(|(place, _)| !set.contains(place));
    others.for_each(|(_, group)| add(&mut covered, &group.hull.coverage));
    let before = cost(search, &covered, set.iter().map(|place| &groups[*place]));
    let mut merger = Merger::new(search, parts.into_iter().map(|part| search.single(part)).collect(), covered.clone());
    while merger.count() > set.len() {
        merger.step()?;
        // it becomes no less
        if search.cost(merger.count_fresh(&covered), 0.0) >= before {
            return None;
        }
    }
    let new = merger.into_groups();
    let gain = before - cost(search, &covered, new.iter());
    (new.len() == set.len() && gain > search.least_gain()).then_some((gain, new))
}

/// What groups cost where other probes are covered already.
fn cost<'a>(search: &Search, covered: &[u64], groups: impl Iterator<Item = &'a Group>) -> f64 {
    let (mut all, mut fresh, mut volume) = (covered.to_vec(), 0, 0.0);
    for group in groups {
        fresh += count_fresh(&all, &group.hull.coverage);
        add(&mut all, &group.hull.coverage);
        volume += group.hull.volume;
    }
    search.cost(fresh, volume)
}
