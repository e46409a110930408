//! Points by the planes that meet in them, numbered as long as an edge names them.

use std::cmp::Ordering;

use planecut_kernel::{DVec3, compare_exactly};

use super::names::{Names, find_all};
use crate::base::{hash_of, intern, map_chunks, sortable};
use crate::boundary::BoundaryEdge;
use crate::ids::{Id, NameId, PointId};
use crate::plane_table::{PlaneId, PlaneTable, curve_number};
use crate::weld::points::{self, Named, Points};

/// Number of points from which several threads work out where they are.
const POINTS_FOR_THREADS: usize = 256;

/// The points.
#[derive(Clone, Default)]
pub(super) struct NamedPoints {
    pub(super) names: Names<points::Triple, PointId>,
    pub(super) points: Points,
    /// For each point its place on the curve by which points are ordered.
    places: Vec<u64>,
}

/// What equal points share, in one number.
fn mark_of(position: DVec3) -> u64 {
    hash_of(&position.to_array().map(sortable))
}

/// The names of the ends of an edge.
fn names_of(edge: &BoundaryEdge) -> [points::Triple; 2] {
    [edge.start, edge.end].map(|end| points::key([edge.face, edge.edge, end]))
}

impl NamedPoints {
    /// Numbers the ends of an edge; planes by which points are known that were not known before go to `gained`.
    pub(super) fn take(&mut self, table: &PlaneTable, edge: &BoundaryEdge, gained: &mut Vec<PlaneId>) -> [NameId; 2] {
        let ends = names_of(edge).map(|name| {
            let known = self.names.find(&name);
            known.unwrap_or_else(|| self.add(table, name, &Named::of(table, points::planes(name)), gained))
        });
        self.names.use_all(&ends);
        ends
    }

    /// The same for many edges; what it takes to tell points apart is worked out by all threads.
    pub(super) fn take_all(
        &mut self,
        table: &PlaneTable,
        edges: &[BoundaryEdge],
        gained: &mut Vec<PlaneId>,
    ) -> Vec<[NameId; 2]> {
        let name = |end: usize| names_of(&edges[end / 2])[end % 2];
        let near = |name: &points::Triple| (name.0 >> 32) as usize;
        let (different, of_end) = intern(2 * edges.len(), name, table.len(), near, |number| number);
        let found = find_all(&self.names, &different, |name| Named::of(table, points::planes(*name)));
        let new = different.iter().zip(found);
        let numbers: Vec<NameId> =
            new.map(|(name, found)| found.unwrap_or_else(|named| self.add(table, *name, &named, gained))).collect();
        let ends: Vec<[NameId; 2]> = of_end.chunks_exact(2).map(|ends| [numbers[ends[0]], numbers[ends[1]]]).collect();
        self.names.use_all(ends.as_flattened());
        ends
    }

    /// Makes a name known.
    fn add(&mut self, table: &PlaneTable, name: points::Triple, named: &Named, gained: &mut Vec<PlaneId>) -> NameId {
        let is_same = |point: PointId| points::is_at(table, self.points.planes[point.index()], named.planes);
        let (id, is_new) = self.names.add(name, mark_of(named.position), is_same);
        if is_new {
            let number = self.names.thing(id);
            if number.index() == self.places.len() {
                self.points.push(named);
                self.places.push(0);
            } else {
                self.points.put(number, named);
            }
            self.places[number.index()] = curve_number(named.position);
            gained.extend(named.planes);
        }
        id
    }

    /// The order of points in space, whatever their numbers.
    pub(super) fn compare(&self, table: &PlaneTable, p: PointId, q: PointId) -> Ordering {
        if p == q {
            return Ordering::Equal;
        }
        let by_curve = self.places[p.index()].cmp(&self.places[q.index()]);
        if by_curve.is_ne() {
            return by_curve;
        }
        let coordinates = |point: PointId| self.points.positions[point.index()].to_array().map(sortable);
        let rows = |point: PointId| self.points.planes[point.index()].map(|plane| table.row(plane));
        coordinates(p).cmp(&coordinates(q)).then_with(|| compare_exactly(rows(p), rows(q), &[0, 1, 2]))
    }

    /// Puts points where they are now that their planes have moved.
    pub(super) fn follow(&mut self, table: &PlaneTable, moved: &[PointId]) {
        let follow =
            |points: &[PointId]| points.iter().map(|point| self.points.moved(table, *point)).collect::<Vec<_>>();
        let places: Vec<(DVec3, u8)> = if moved.len() < 2 * POINTS_FOR_THREADS {
            follow(moved)
        } else {
            map_chunks(moved, POINTS_FOR_THREADS, follow).0.concat()
        };
        for (point, place) in moved.iter().zip(places) {
            self.points.put_at(*point, place);
            self.places[point.index()] = curve_number(place.0);
        }
    }

    /// Marks points again that have moved, before anything is looked up by marks.
    pub(super) fn mark(&mut self, moved: &[PointId]) {
        for &point in moved {
            self.names.set_mark(point, mark_of(self.points.positions[point.index()]));
        }
    }
}
