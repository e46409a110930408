//! What lies on one line of a boundary that changes, and which part of it is to be looked at again.
//!
//! The edges on a line make up parts with gaps between them, and what becomes of the edges of one part does not depend on those of others. So
//! only parts are cancelled and cut again in which something has changed, and of these what lies between two points around it that neither an edge nor what is left of
//! edges passes: what is cut there already depends on nothing but what is next to it.

use std::cmp::Ordering;
use std::ops::Range;

use smallvec::SmallVec;

use super::Edge;
use super::numbers::Context;
use crate::ids::{EdgeId, HalfEdgeId, Id, LineId, PointId, PointOfRegion, number32};
use crate::weld::cancel::HalfEdge;

/// An edge with its ends along its line, the lower one first.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeAlong {
    ends: [PointId; 2],
    number: EdgeId,
}

/// Lines of fewer edges are looked at whole.
const LEAST_EDGES: usize = 12;

/// Maximum number of edges that are put in their places one by one; more are sorted.
const MOST_DISPLACED: usize = 16;

/// What lies on a line. There are very many, and little on most of them.
#[derive(Clone, Default)]
pub(super) struct OnLine {
    /// Where they are many, by where they begin along the line, but for those that are new.
    edges: SmallVec<[EdgeId; 4]>,
    /// The pieces that are left of the edges, cut and paired.
    pub(super) pieces: SmallVec<[HalfEdgeId; 4]>,
    pub(super) is_dirty: bool,
    /// Whether all of it is to be looked at again.
    is_changed: bool,
    pub(super) has_slits: bool,
    rare: Option<Box<Rare>>,
}

/// What lies on few lines.
#[derive(Clone, Default)]
pub(super) struct Rare {
    /// Where edges came or went, or cuts did.
    changed: Vec<[PointId; 2]>,
    /// Where pinches cut pieces: the region of each pinch and the point.
    pub(super) cuts: Vec<PointOfRegion>,
    /// Where edges end inside runs.
    pub(super) passed: Vec<PointOfRegion>,
}

/// The order of points along a line.
#[derive(Clone, Copy)]
pub(super) struct Along<'a> {
    pub(super) context: Context<'a>,
    pub(super) line: LineId,
}

impl Along<'_> {
    #[inline]
    fn compare(&self, p: PointId, q: PointId) -> Ordering {
        let Context { table, numbers } = self.context;
        numbers.lines()[self.line.index()].compare(table, numbers.points(), p, q)
    }

    fn max(&self, p: PointId, q: PointId) -> PointId {
        if self.compare(p, q).is_lt() { q } else { p }
    }

    fn of_edge(&self, edge: &Edge) -> [PointId; 2] {
        let run = &edge.numbered.run;
        low_and_high([run.from, run.to], run.is_forward())
    }
}

/// Where something begins and ends along the line that runs one way or the other.
fn low_and_high([from, to]: [PointId; 2], forward: bool) -> [PointId; 2] {
    if forward { [from, to] } else { [to, from] }
}

/// From where to where parts of a line are: mostly there are few.
type Intervals = SmallVec<[[PointId; 2]; 8]>;

/// Parts of a line, in order, with gaps between them.
#[derive(Debug, Default)]
pub(super) struct Parts {
    /// Without these, all of it.
    intervals: Option<Intervals>,
}

impl Parts {
    /// Those that some intervals make up, of which each begins before it ends.
    fn of(along: &Along<'_>, mut intervals: Intervals) -> Self {
        intervals.sort_by(|a, b| along.compare(a[0], b[0]));
        let mut merged = Intervals::new();
        for [low, high] in intervals {
            match merged.last_mut() {
                Some(last) if along.compare(low, last[1]).is_le() => last[1] = along.max(last[1], high),
                _ => merged.push([low, high]),
            }
        }
        Self { intervals: Some(merged) }
    }

    /// Whether an interval has a point in common with one.
    fn touch(&self, along: &Along<'_>, [low, high]: [PointId; 2]) -> bool {
        let Some(intervals) = &self.intervals else { return true };
        let before = intervals.partition_point(|[other, _]| along.compare(*other, high).is_le());
        before > 0 && along.compare(low, intervals[before - 1][1]).is_le()
    }

    /// Whether a point of the line lies in one, or at its end.
    pub(super) fn hold(&self, along: &Along<'_>, point: PointId) -> bool {
        self.touch(along, [point, point])
    }

    /// Whether a point of the line lies inside of one, not at an end.
    pub(super) fn hold_inside(&self, along: &Along<'_>, point: PointId) -> bool {
        let Some(intervals) = &self.intervals else { return true };
        let before = intervals.partition_point(|[other, _]| along.compare(*other, point).is_lt());
        before > 0 && along.compare(point, intervals[before - 1][1]).is_lt()
    }

    /// Whether something on the line that begins at a point lies in one.
    fn hold_from(&self, along: &Along<'_>, low: PointId) -> bool {
        let Some(intervals) = &self.intervals else { return true };
        let before = intervals.partition_point(|[other, _]| along.compare(*other, low).is_le());
        before > 0 && along.compare(low, intervals[before - 1][1]).is_lt()
    }

    /// Whether they are all of the line.
    pub(super) fn are_all(&self) -> bool {
        self.intervals.is_none()
    }
}

impl OnLine {
    pub(super) fn add(&mut self, number: EdgeId, ends: [PointId; 2]) {
        self.edges.push(number);
        self.note_change(ends);
    }

    /// Takes all edges out; the pieces of them that are left go when it is looked at again.
    pub(super) fn take_edges(&mut self) -> SmallVec<[EdgeId; 4]> {
        self.is_changed = true;
        std::mem::take(&mut self.edges)
    }

    /// Notes that something has changed between two points.
    pub(super) fn note_change(&mut self, ends: [PointId; 2]) {
        if self.edges.len() < LEAST_EDGES {
            self.is_changed = true;
        } else {
            self.rare_mut().changed.push(ends);
        }
    }

    /// Whether edges may be cut elsewhere than where others end.
    pub(super) fn is_crossed(&self) -> bool {
        self.has_slits || !self.passed().is_empty() || !self.cuts().is_empty()
    }

    pub(super) fn cuts(&self) -> &[PointOfRegion] {
        self.rare.as_ref().map_or(&[], |rare| &rare.cuts)
    }

    pub(super) fn passed(&self) -> &[PointOfRegion] {
        self.rare.as_ref().map_or(&[], |rare| &rare.passed)
    }

    pub(super) fn rare_mut(&mut self) -> &mut Rare {
        self.rare.get_or_insert_default()
    }

    /// Puts pieces that were taken out back: all of the line is to be looked at again.
    pub(super) fn put_back(&mut self, pieces: &mut Vec<HalfEdgeId>) {
        self.pieces.extend(pieces.drain(..));
        self.is_changed = true;
    }

    /// Puts the edges in order. Gives the parts in which something has changed, and the numbers of the edges and of the pieces there; the latter are taken out.
    /// `ordered` is a buffer.
    pub(super) fn take_changed(
        &mut self,
        along: &Along<'_>,
        edges: &[Edge],
        half_edges: &[HalfEdge],
        ordered: &mut Vec<EdgeAlong>,
        (group, old): (&mut Vec<EdgeId>, &mut Vec<HalfEdgeId>),
    ) -> Parts {
        ordered.clear();
        group.clear();
        old.clear();
        self.edges.retain(|number| {
            let edge = &edges[number.index()];
            if !edge.is_gone {
                ordered.push(EdgeAlong { ends: along.of_edge(edge), number: *number });
            }
            !edge.is_gone
        });
        let is_whole = std::mem::take(&mut self.is_changed);
        if is_whole || self.edges.len() < LEAST_EDGES || self.has_slits {
            group.extend_from_slice(&self.edges);
            old.extend(self.pieces.drain(..));
            self.rare.iter_mut().for_each(|rare| rare.changed.clear());
            return Parts::default();
        }
        sort_nearly_sorted(ordered, |a, b| along.compare(a.ends[0], b.ends[0]));
        self.edges.iter_mut().zip(&*ordered).for_each(|(number, edge)| *number = edge.number);
        let mut changed: Intervals = self.rare_mut().changed.drain(..).collect();
        for ends in &mut changed {
            let is_forward = along.compare(ends[0], ends[1]).is_le();
            *ends = low_and_high(*ends, is_forward);
        }
        let changed = Parts::of(along, changed);
        let is_passed = |point: PointId| {
            self.pieces.iter().any(|number| {
                let piece = &half_edges[number.index()];
                let [low, high] = low_and_high([piece.from, piece.to], piece.is_forward());
                along.compare(low, point).is_lt() && along.compare(point, high).is_lt()
            })
        };
        let mut intervals = changed.intervals.clone().unwrap_or_default();
        let mut rest = ordered.as_slice();
        while !rest.is_empty() {
            let part = first_part(along, rest);
            let (of_part, further) = rest.split_at(part.edges.end);
            if changed.touch(along, part.ends) {
                let part = part.around(along, &changed, is_passed);
                group.extend(of_part[part.edges].iter().map(|edge| edge.number));
                intervals.push(part.ends);
            }
            rest = further;
        }
        let parts = Parts::of(along, intervals);
        self.pieces.retain(|number| {
            let piece = &half_edges[number.index()];
            let [low, _] = low_and_high([piece.from, piece.to], piece.is_forward());
            let is_old = parts.hold_from(along, low);
            if is_old {
                old.push(*number);
            }
            !is_old
        });
        parts
    }
}

/// Sorts what mostly is in order but for a few that came last; what is equal keeps its order.
fn sort_nearly_sorted<T: Copy>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let mut displaced = 0;
    for k in 1..items.len() {
        let item = items[k];
        if compare(&items[k - 1], &item).is_le() {
            continue;
        }
        displaced += 1;
        if displaced > MOST_DISPLACED {
            items.sort_by(compare);
            return;
        }
        let place = items[..k].partition_point(|other| compare(other, &item).is_le());
        items[place..=k].rotate_right(1);
    }
}

/// Some edges of a line, in their order.
struct Part {
    edges: Range<usize>,
    /// Where they begin and end.
    ends: [PointId; 2],
    /// Points within that no edge passes, and the first edge from there on.
    joints: SmallVec<[(PointId, u32); 32]>,
}

impl Part {
    /// Those around all that has changed among them, from and to joints that no piece passes either: nothing ends there or goes on because of what has changed, so what is
    /// beyond stays as it is.
    fn around(self, along: &Along<'_>, changed: &Parts, is_passed: impl Fn(PointId) -> bool) -> Self {
        let Some(intervals) = &changed.intervals else { return self };
        let first = intervals.partition_point(|[_, high]| along.compare(*high, self.ends[0]).is_lt());
        let end = intervals.partition_point(|[low, _]| along.compare(*low, self.ends[1]).is_le());
        let [low, high] = [intervals[first][0], intervals[end - 1][1]];
        let joints_to = self.joints.partition_point(|joint| along.compare(joint.0, low).is_lt());
        let joints_from = self.joints.partition_point(|joint| along.compare(joint.0, high).is_le());
        let is_end = |joint: &&(PointId, u32)| !is_passed(joint.0);
        let place = |joint: &(PointId, u32)| (joint.0, joint.1 as usize);
        let before = self.joints[..joints_to].iter().rev().find(is_end);
        let behind = self.joints[joints_from..].iter().find(is_end);
        let (from, start) = before.map_or((self.ends[0], self.edges.start), place);
        let (to, end) = behind.map_or((self.ends[1], self.edges.end), place);
        Self { edges: start..end, ends: [from, to], joints: SmallVec::new() }
    }
}

/// Of some edges, in their order, those up to a gap.
fn first_part(along: &Along<'_>, edges: &[EdgeAlong]) -> Part {
    let [low, mut high] = edges[0].ends;
    let mut joints = SmallVec::new();
    let mut count = 1;
    let mut last = edges[0].ends;
    for &EdgeAlong { ends, .. } in &edges[1..] {
        // mostly several faces end between two points
        if std::mem::replace(&mut last, ends) == ends {
            count += 1;
            continue;
        }
        let [start, end] = ends;
        match along.compare(start, high) {
            Ordering::Greater => break,
            Ordering::Equal => {
                joints.push((start, number32(count)));
                high = end;
            }
            Ordering::Less => high = along.max(high, end),
        }
        count += 1;
    }
    Part { edges: 0..count, ends: [low, high], joints }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn what_came_last_is_put_in_its_place_after_what_is_equal() {
        for seed in 0..300 {
            let mut rng = Rng::spread(seed);
            let (ordered, late) = (rng.below(60), rng.below(2 * MOST_DISPLACED));
            // few keys, so that many are equal, and a number that tells these apart
            let mut items: Vec<(usize, usize)> = (0..ordered + late).map(|number| (rng.below(20), number)).collect();
            items[..ordered].sort_by_key(|item| item.0);
            let mut expected = items.clone();
            expected.sort_by_key(|item| item.0);
            sort_nearly_sorted(&mut items, |a, b| a.0.cmp(&b.0));
            assert_eq!(items, expected, "seed {seed}");
        }
    }
}
