//! Better groups, one part at a time: a part goes where it costs less.

use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::hull::Hull;
use super::probes::{add, count_fresh, once_and_twice};
use super::search::{Group, Search};
use crate::tolerances::SAME_HULL;

/// A part may go to the groups whose boxes it touches, and to at least this number of the nearest.
const NEAREST: usize = 4;
/// A part leaves a group for another.
struct Move {
    gain: f64,
    from: usize,
    to: usize,
    part: u32,
    /// Both groups after it.
    rest: Group,
    joined: Hull,
}

/// When each group changed, and when each part was looked at.
#[derive(Debug)]
pub(super) struct Clock {
    now: u64,
    changed: Vec<u64>,
    looked: Vec<u64>,
}

impl Clock {
    pub(super) fn new(groups: usize, parts: usize) -> Self {
        Self { now: 1, changed: vec![1; groups], looked: vec![0; parts] }
    }

    /// Says that a group changed.
    pub(super) fn touch(&mut self, group: usize) {
        self.now += 1;
        self.changed[group] = self.now;
    }

    /// Now.
    pub(super) fn now(&self) -> u64 {
        self.now
    }

    /// Whether a group changed after a time.
    pub(super) fn is_changed(&self, group: usize, since: u64) -> bool {
        self.changed[group] > since
    }
}

/// Moves parts as long as that pays, in at most this number of rounds.
pub(super) fn relocate(search: &Search, groups: &mut [Group], clock: &mut Clock, rounds: usize) {
    for _ in 0..rounds {
        let asked: Vec<(usize, u32)> = groups
            .iter()
            .enumerate()
            .filter(|(_, group)| group.parts.len() > 1)
            .flat_map(|(from, group)| group.parts.iter().map(move |part| (from, *part)))
            .filter(|(from, part)| is_open(search, groups, clock, *from, *part))
            .collect();
        for (_, part) in &asked {
            clock.looked[*part as usize] = clock.now;
        }
        let others: Vec<Vec<u64>> = covered_by_others(search, groups);
        let view = View { search, group_of: group_of_parts(search, groups), groups };
        let best = |(from, part): &(usize, u32)| view.best_move(&others[*from], *from, *part);
        let mut moves: Vec<Move> = asked.par_iter().with_min_len(2).filter_map(best).collect();
        moves.sort_by(|a, b| b.gain.total_cmp(&a.gain).then(a.part.cmp(&b.part)));
        // a move is good for the groups that it was found for
        let mut is_done = vec![false; groups.len()];
        let mut applied: Vec<usize> = Vec::new();
        for Move { from, to, part, rest, joined, .. } in moves {
            if is_done[from] || is_done[to] || is_neighbour_done(groups, &applied, from, to) {
                continue;
            }
            groups[from] = rest;
            groups[to].parts.push(part);
            groups[to].hull = joined;
            for group in [from, to] {
                is_done[group] = true;
                clock.touch(group);
                applied.push(group);
            }
        }
        if applied.is_empty() {
            break;
        }
    }
}

/// Whether a group that changed in this round reaches into one of two: then what a move gains is no longer known.
fn is_neighbour_done(groups: &[Group], done: &[usize], from: usize, to: usize) -> bool {
    let touches = |a: usize, b: usize| groups[a].hull.bounds.touches(&groups[b].hull.bounds);
    done.iter().any(|other| touches(*other, from) || touches(*other, to))
}

/// Whether something changed near a part since it was looked at.
fn is_open(search: &Search, groups: &[Group], clock: &Clock, from: usize, part: u32) -> bool {
    let looked = clock.looked[part as usize];
    let bounds = &search.parts[part as usize].bounds;
    let is_new = |(place, group): (usize, &Group)| {
        clock.changed[place] > looked && (place == from || group.hull.bounds.touches(bounds))
    };
    looked == 0 || groups.iter().enumerate().any(is_new)
}

/// For each group the probes that the others cover.
fn covered_by_others(search: &Search, groups: &[Group]) -> Vec<Vec<u64>> {
    let (once, twice) =
        once_and_twice(search.probes.words(), groups.iter().map(|group| group.hull.coverage(search.probes)));
    let others = |group: &Group| {
        let mut others = once.clone();
        for (word, bits) in group.hull.coverage(search.probes) {
            let word = *word as usize;
            others[word] = (once[word] & !bits) | twice[word];
        }
        others
    };
    groups.par_iter().map(others).collect()
}

/// The group of each part.
fn group_of_parts(search: &Search, groups: &[Group]) -> Vec<u32> {
    let mut group_of = vec![0; search.parts.len()];
    for (group, part) in groups.iter().enumerate().flat_map(|(k, group)| group.parts.iter().map(move |part| (k, *part)))
    {
        group_of[part as usize] = group as u32;
    }
    group_of
}

/// All groups at some time.
struct View<'a> {
    search: &'a Search<'a>,
    groups: &'a [Group],
    group_of: Vec<u32>,
}

impl View<'_> {
    /// The best move of a part out of its group; `others` are the probes that other groups cover.
    fn best_move(&self, others: &[u64], from: usize, part: u32) -> Option<Move> {
        job::check();
        let (search, groups) = (self.search, self.groups);
        let (own, old) = (&search.parts[part as usize], &groups[from]);
        if !own.corners.iter().any(|corner| old.hull.corners.contains(corner)) {
            return None;
        }
        let others_of_it = old.parts.iter().copied().filter(|other| *other != part).collect();
        let rest = search.group(others_of_it);
        if rest.hull.volume > old.hull.volume * SAME_HULL {
            return None;
        }
        let mut covered = others.to_vec();
        add(&mut covered, rest.hull.coverage(search.probes));
        let freed = count_fresh(&covered, old.hull.coverage(search.probes));
        if search.cost(freed, old.hull.volume - rest.hull.volume) <= search.least_gain() {
            return None;
        }
        let mut best: Option<(f64, usize, Hull)> = None;
        for to in self.targets(from, part) {
            let target = &groups[to];
            let is_held = target.hull.holds(&own.bounds, &own.corners);
            let joined =
                if is_held { Some(target.hull.clone()) } else { search.joined(&target.hull, search.hull(part)) };
            let Some(joined) = joined else { continue };
            let grown = rest.hull.volume + joined.volume - old.hull.volume - target.hull.volume;
            let least = best.as_ref().map_or(search.least_gain(), |(most, ..)| *most);
            // if it covers nothing new
            if search.cost(freed, -grown) <= least {
                continue;
            }
            let added = count_fresh(&covered, joined.coverage(search.probes));
            let gain = search.cost(freed, 0.0) - search.cost(added, grown);
            if gain > least {
                best = Some((gain, to, joined));
            }
        }
        let (gain, to, joined) = best?;
        Some(Move { gain, from, to, part, rest, joined })
    }

    /// The groups that a part may go to.
    fn targets(&self, from: usize, part: u32) -> Vec<usize> {
        let (search, groups) = (self.search, self.groups);
        let own = &search.parts[part as usize].bounds;
        let mut places: Vec<usize> = match search.near(part) {
            Some(near) => near.iter().map(|other| self.group_of[*other as usize] as usize).collect(),
            None => (0..groups.len()).collect(),
        };
        places.sort_unstable();
        places.dedup();
        places.retain(|place| *place != from && search.may_join(groups[*place].parts[0], part));
        let away = |place: usize| {
            let bounds = &groups[place].hull.bounds;
            let both = own.union(bounds);
            (!bounds.touches(own), (both.max - both.min).length_squared(), place)
        };
        let mut near: Vec<(bool, f64, usize)> = places.into_iter().map(away).collect();
        near.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let touching = near.partition_point(|(is_apart, ..)| !is_apart);
        near.truncate(touching.max(NEAREST));
        near.into_iter().map(|(.., place)| place).collect()
    }
}
