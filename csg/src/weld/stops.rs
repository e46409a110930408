//! Points of a line, in order along it.

use std::cmp::Ordering;

use super::lines::Line;
use super::points::Points;
use crate::base::{sort_few, sortable};
use crate::ids::{PointId, number32};
use crate::plane_table::PlaneTable;

/// Different points of a line in order along it, and where the ends from which they were made stand among them.
#[derive(Debug, Clone, Default)]
pub(super) struct Stops {
    ends: Vec<End>,
    points: Vec<PointId>,
    places: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct End {
    /// The coordinate along which the line rises, correctly rounded.
    along: f64,
    point: PointId,
    /// Its number in the order in which ends are given.
    number: u32,
}

impl Stops {
    /// Takes the points at which pieces of the line end in the place of those that are there; each may be given several times.
    pub(super) fn set(
        &mut self,
        table: &PlaneTable,
        points: &Points,
        line: &Line,
        ends: impl IntoIterator<Item = PointId>,
    ) {
        self.ends.clear();
        let end = |(number, point): (u32, PointId)| End { along: line.height(points, point), point, number };
        self.ends.extend((0..).zip(ends).map(end));
        sort_few(&mut self.ends, &|end: &End| sortable(end.along));
        let is_open = |ends: &[End]| (ends[0].along == ends[1].along) & (ends[0].point != ends[1].point);
        if self.ends.windows(2).fold(false, |is_any, ends| is_any | is_open(ends)) {
            self.ends.sort_unstable_by(|a, b| match a.along.partial_cmp(&b.along) {
                Some(Ordering::Equal) | None => line.compare(table, points, a.point, b.point),
                Some(order) => order,
            });
        }
        self.points.clear();
        self.places.clear();
        self.places.resize(self.ends.len(), 0);
        for end in &self.ends {
            if self.points.last() != Some(&end.point) {
                self.points.push(end.point);
            }
            self.places[end.number as usize] = number32(self.points.len() - 1);
        }
    }

    /// The points.
    pub(super) fn points(&self) -> &[PointId] {
        &self.points
    }

    /// Where the ends of each piece stand among the points, given one after the other.
    pub(super) fn places(&self) -> &[[u32; 2]] {
        self.places.as_chunks().0
    }
}

/// Sorts points along a line and drops repeated ones.
pub(super) fn sort_along(table: &PlaneTable, points: &Points, line: &Line, stops: &mut Vec<PointId>) {
    stops.sort_unstable_by(|p, q| line.compare(table, points, *p, *q));
    stops.dedup();
}
