//! Cuts of the same two polygons that go on into one another, joined.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashSet;

use super::joined_cuts::{Joining, KeyedCut, KeyedEdgeCut};
use super::points::PointKey;
use crate::base::map_chunks;
use crate::ids::{PointId, number32};

/// Cuts that one thread looks at in a row.
const CHUNK: usize = 1 << 9;

/// No cut goes on there.
const NONE: u32 = u32::MAX;

/// A point on an edge, and that edge.
type OnEdge = ([PointId; 2], PointKey);

/// The points at which cuts along edges of others were joined, with these edges.
pub(super) type Vanished = FxHashSet<OnEdge>;

/// Joins cuts, which are sorted, as they are afterwards. Where another cut ends, or an edge is divided, none are joined, although some might
/// be.
pub(super) fn join(joining: &Joining<'_>, cuts: &[KeyedCut], edge_cuts: &[KeyedEdgeCut]) -> (Vec<KeyedCut>, Vanished) {
    let parts: Vec<Links<'_>> = parts(cuts).into_par_iter().map(|cuts| Links::new(joining, cuts)).collect();
    let mut within_edges: FxHashSet<OnEdge> = FxHashSet::default();
    within_edges.reserve(parts.iter().map(|part| part.within_edges.len()).sum());
    within_edges.extend(parts.iter().flat_map(|part| &part.within_edges));
    let divides = |cut: &&KeyedEdgeCut| {
        !cut.is_diagonal && joining.may_join(&cut.key) && !within_edges.contains(&(cut.edge, cut.key))
    };
    let keys = |cuts: &[KeyedEdgeCut]| cuts.iter().filter(divides).map(|cut| cut.key).collect::<Vec<_>>();
    let divided = map_chunks(edge_cuts, CHUNK, keys).0;
    let stays: FxHashSet<PointKey> =
        parts.iter().flat_map(|part| &part.ends).chain(divided.iter().flatten()).copied().collect();
    let joined: Vec<(Vec<KeyedCut>, Vec<OnEdge>)> = parts.into_par_iter().map(|part| part.join(&stays)).collect();
    let mut all = Vec::with_capacity(joined.iter().map(|(cuts, _)| cuts.len()).sum());
    let mut vanished = Vanished::default();
    vanished.reserve(joined.iter().map(|(_, points)| points.len()).sum());
    for (cuts, points) in joined {
        all.extend(cuts);
        vanished.extend(points);
    }
    (all, vanished)
}

/// Whether cuts are of the same two polygons, and along the same edge.
fn are_of_one_group(a: &KeyedCut, b: &KeyedCut) -> bool {
    (a.triangle, a.other, a.edge) == (b.triangle, b.other, b.edge)
}

/// Cuts in parts that hold whole groups.
fn parts(mut cuts: &[KeyedCut]) -> Vec<&[KeyedCut]> {
    let mut parts = Vec::new();
    while !cuts.is_empty() {
        let mut end = CHUNK.min(cuts.len());
        while end < cuts.len() && are_of_one_group(&cuts[end - 1], &cuts[end]) {
            end += 1;
        }
        let (part, rest) = cuts.split_at(end);
        parts.push(part);
        cuts = rest;
    }
    parts
}

/// Which cuts go on into one another, as far as those of their group tell.
struct Links<'a> {
    cuts: &'a [KeyedCut],
    /// For both ends of each cut the one that goes on there.
    next: Vec<[u32; 2]>,
    /// Points at which cuts end that might go on.
    ends: Vec<PointKey>,
    /// Points at which cuts along an edge of another go on, with that edge.
    within_edges: Vec<OnEdge>,
}

impl<'a> Links<'a> {
    fn new(joining: &Joining<'_>, cuts: &'a [KeyedCut]) -> Self {
        let mut links = Self { cuts, next: vec![[NONE; 2]; cuts.len()], ends: Vec::new(), within_edges: Vec::new() };
        // ends of cuts of one group, each with its cut and which of its ends it is
        let mut ends: Vec<(PointKey, u32, usize)> = Vec::new();
        let mut first = 0;
        for group in cuts.chunk_by(are_of_one_group) {
            let start = first;
            first += number32(group.len());
            if ![group[0].triangle, group[0].other].iter().any(|polygon| joining.polygons.has(*polygon)) {
                continue;
            }
            ends.clear();
            for (number, cut) in (start..).zip(group).filter(|(_, cut)| !cut.is_point()) {
                let of_cut = cut.ends.into_iter().enumerate().map(|(end, key)| (key, number, end));
                ends.extend(of_cut.filter(|(key, ..)| joining.may_join(key)));
            }
            ends.sort_unstable();
            for at_point in ends.chunk_by(|a, b| a.0 == b.0) {
                let key = at_point[0].0;
                let [(_, one, of_one), (_, other, of_other)] = *at_point else {
                    links.ends.push(key);
                    continue;
                };
                if joining.joins(&group[0], &key) {
                    links.next[one as usize][of_one] = other;
                    links.next[other as usize][of_other] = one;
                    links.within_edges.extend(group[0].edge.map(|edge| (edge, key)));
                } else {
                    links.ends.push(key);
                }
            }
        }
        links
    }

    /// Joins the cuts, but for those at some ends. Gives the points at which cuts along edges of others were joined, with these edges.
    fn join(self, stays: &FxHashSet<PointKey>) -> (Vec<KeyedCut>, Vec<OnEdge>) {
        let Self { cuts, next, .. } = self;
        let (mut joined, mut vanished) = (Vec::with_capacity(cuts.len()), Vec::new());
        let mut is_done = vec![false; cuts.len()];
        let mut start = 0;
        for group in cuts.chunk_by(are_of_one_group) {
            let (first, first_joined) = (start, joined.len());
            start += group.len();
            for k in first..start {
                if std::mem::replace(&mut is_done[k], true) {
                    continue;
                }
                let mut ends = cuts[k].ends;
                for (which, end) in ends.iter_mut().enumerate() {
                    let mut after = next[k][which];
                    while after != NONE && !stays.contains(end) {
                        let this = after as usize;
                        if std::mem::replace(&mut is_done[this], true) {
                            break;
                        }
                        vanished.extend(group[0].edge.map(|edge| (edge, *end)));
                        let other = usize::from(cuts[this].ends[0] == *end);
                        *end = cuts[this].ends[other];
                        after = next[this][other];
                    }
                }
                let ends = if ends[0] < ends[1] { ends } else { [ends[1], ends[0]] };
                joined.push(KeyedCut { ends, ..cuts[k] });
            }
            joined[first_joined..].sort_unstable();
        }
        (joined, vanished)
    }
}
