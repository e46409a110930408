//! Points by the planes that meet in them: equal points get one number, whichever three planes name them.
//!
//! Coordinates are correctly rounded, so equal points have equal coordinates: the coordinates propose, signs decide.

use std::hash::Hash;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{cmp, iter};

use planecut_kernel::sign::{Counts, Sign};
use planecut_kernel::{DVec3, compare_exactly};
use planecut_parallel::prelude::*;

use super::cancel::HalfEdge;
use super::triangulate::LoopCorner;
use crate::base::{
    Bounds, concat_owned, intern, made_by_place, map_chunks, map_items, repeated, runs_apart, sort_by_number, sortable,
    starts_of,
};
use crate::boundary::BoundaryEdge;
use crate::ids::{HalfEdgeId, Id, NameId, PointId};
use crate::plane_table::{PlaneId, PlaneTable, curve_number};

/// The points of a weld.
#[derive(Debug, Clone, Default)]
pub(super) struct Points {
    /// Three planes through each point, right-handed.
    pub(super) planes: Vec<[PlaneId; 3]>,
    pub(super) positions: Vec<DVec3>,
    /// Which coordinates are those of the point itself, not rounded, a bit for each; not where that is not easily told.
    exact: Vec<u8>,
}

/// The order of positions: along a curve through space, then by coordinates.
type Place = (u64, [u64; 3]);

/// The indices of three planes in ascending order, packed.
pub(super) type Triple = (u64, u32);

/// Number of bits of three numbers that fit into a word.
const SHORT_BITS: u32 = 21;

/// A point that three planes name, before equal ones are joined.
#[derive(Debug, Clone, Copy)]
pub(super) struct Named {
    pub(super) planes: [PlaneId; 3],
    pub(super) position: DVec3,
    exact: u8,
}

impl Points {
    /// Numbers the ends of edges by position; gives the numbers of both ends of each edge, in order.
    pub(super) fn identify(table: &PlaneTable, edges: &[BoundaryEdge]) -> (Self, Vec<[PointId; 2]>, Counts) {
        // a key of one word where the numbers of three planes fit into it
        if table.len() <= 1 << SHORT_BITS {
            let first = |key: &u64| (key >> (2 * SHORT_BITS)) as usize;
            Self::identify_by(table, edges, |triple| short(key(triple)), first, |key| planes(long(key)))
        } else {
            Self::identify_by(table, edges, key, |key| (key.0 >> 32) as usize, planes)
        }
    }

    /// The same by keys of triples of planes; `first` gives the smallest plane of each.
    fn identify_by<K: Copy + Eq + Hash + Send + Sync>(
        table: &PlaneTable,
        edges: &[BoundaryEdge],
        key: impl Fn([PlaneId; 3]) -> K + Sync,
        first: impl Fn(&K) -> usize + Sync,
        planes: impl Fn(K) -> [PlaneId; 3] + Sync,
    ) -> (Self, Vec<[PointId; 2]>, Counts) {
        let key_of_end = |end: usize| {
            let edge = &edges[end / 2];
            key([edge.face, edge.edge, if end.is_multiple_of(2) { edge.start } else { edge.end }])
        };
        let (different, of_triple) = intern(2 * edges.len(), key_of_end, table.len(), first, NameId::from_index);
        let name = |_, key: &K| Named::of(table, planes(*key));
        let (named, mut counts) = map_items(&different, 256, Named::blank(), name);
        drop(different);
        let place = |k: usize| (curve_number(named[k].position), NameId::from_index(k));
        let mut sorted: Vec<(u64, NameId)> = made_by_place(named.len(), 1024, place);
        sort_by_number(&mut sorted, |point| point.0);
        let runs = runs_apart(&sorted, 512, |a, b| a.0 != b.0);
        let (parts, joining) = map_chunks(&runs, 1, |chunk| {
            let count = chunk.iter().map(|run| run.len()).sum();
            let (mut joined, mut places) = (Joined { names: Vec::with_capacity(count), firsts: 0 }, Vec::new());
            for close in chunk.iter().flat_map(|run| run.chunk_by(|a, b| a.0 == b.0)) {
                if let [(_, only)] = close {
                    joined.add(iter::once(*only));
                    continue;
                }
                places.clear();
                places.extend(close.iter().map(|(_, k)| (coordinates(named[k.index()].position), *k)));
                places.sort_unstable();
                let alike = places.chunk_by(|a, b| a.0 == b.0);
                alike.for_each(|alike| join_equal(table, &named, alike, &mut joined));
            }
            joined
        });
        counts += joining;
        drop(runs);
        drop(sorted);
        let starts = starts_of(parts.iter().map(|part| part.firsts));
        let of_named = repeated(named.len(), || AtomicU32::new(0));
        let firsts_of = |(part, start): (&Joined, &usize)| {
            let mut firsts = Vec::with_capacity(part.firsts);
            for (k, is_first) in &part.names {
                firsts.extend(is_first.then_some(*k));
                // the first of those that are equal comes first
                let number = PointId::from_index(start + firsts.len() - 1);
                of_named[k.index()].store(number.number(), Ordering::Relaxed);
            }
            firsts
        };
        let firsts: Vec<Vec<NameId>> = parts.par_iter().zip(&starts).with_max_len(1).map(firsts_of).collect();
        drop(parts);
        let points = Self::of_names(&named, &concat_owned(firsts));
        drop(named);
        let number = |k: NameId| PointId::from_index(of_named[k.index()].load(Ordering::Relaxed) as usize);
        let ends = |edge: usize| [of_triple[2 * edge], of_triple[2 * edge + 1]].map(number);
        (points, made_by_place(edges.len(), 1024, ends), counts)
    }

    /// Some of the points that were named, in the order given.
    fn of_names(named: &[Named], names: &[NameId]) -> Self {
        let named = |k: usize| &named[names[k].index()];
        Self {
            planes: made_by_place(names.len(), 1024, |k| named(k).planes),
            positions: made_by_place(names.len(), 1024, |k| named(k).position),
            exact: made_by_place(names.len(), 1024, |k| named(k).exact),
        }
    }

    /// Where they are.
    pub(super) fn into_positions(self) -> Vec<DVec3> {
        self.positions
    }

    /// The number of the meeting point of three independent planes, a new one where it is not known yet. Looks at all points.
    pub(super) fn add(&mut self, table: &PlaneTable, triple: [PlaneId; 3]) -> PointId {
        let named = Named::of(table, triple.map(PlaneId::unsided));
        let known = PointId::all(self.planes.len()).find(|point| {
            let point = point.index();
            self.positions[point] == named.position && is_at(table, self.planes[point], named.planes)
        });
        known.unwrap_or_else(|| self.push(&named))
    }

    pub(super) fn push(&mut self, named: &Named) -> PointId {
        let number = PointId::from_index(self.planes.len());
        self.planes.push(named.planes);
        self.positions.push(named.position);
        self.exact.push(named.exact);
        number
    }

    /// Where a point is whose planes have moved along their normals, and which of its coordinates are exact.
    pub(super) fn moved(&self, table: &PlaneTable, number: PointId) -> (DVec3, u8) {
        let planes = self.planes[number.index()];
        let position = table.position(planes).expect("the planes of a point are independent");
        (position, exact_coordinates(table, planes, position))
    }

    /// Puts a point where it has moved to.
    pub(super) fn put_at(&mut self, number: PointId, (position, exact): (DVec3, u8)) {
        let number = number.index();
        (self.positions[number], self.exact[number]) = (position, exact);
    }

    /// Puts a point in the place of another.
    pub(super) fn put(&mut self, number: PointId, named: &Named) {
        let number = number.index();
        (self.planes[number], self.positions[number], self.exact[number]) = (named.planes, named.position, named.exact);
    }

    /// Numbers all points by position; gives the new number of each.
    pub(super) fn renumber(&mut self, table: &PlaneTable) -> Vec<PointId> {
        let mut order: Vec<PointId> = PointId::all(self.planes.len()).collect();
        let place = |p: PointId| place(self.positions[p.index()]);
        let rows = |p: PointId| self.planes[p.index()].map(|plane| table.row(plane));
        order.sort_by(|p, q| place(*p).cmp(&place(*q)).then_with(|| compare_exactly(rows(*p), rows(*q), &[0, 1, 2])));
        let mut number = vec![PointId::NONE; order.len()];
        for (new, old) in PointId::all(order.len()).zip(&order) {
            number[old.index()] = new;
        }
        self.planes = order.iter().map(|p| self.planes[p.index()]).collect();
        self.positions = order.iter().map(|p| self.positions[p.index()]).collect();
        self.exact = order.iter().map(|p| self.exact[p.index()]).collect();
        number
    }

    /// The box of the rounded ends of a half-edge. Rounding is monotone, so it holds the rounded points on it.
    pub(super) fn extent(&self, piece: &HalfEdge) -> Bounds {
        Bounds::around(self.positions[piece.from.index()], self.positions[piece.to.index()])
    }

    /// The corner of a face at which a half-edge begins.
    pub(super) fn corner(&self, piece: HalfEdgeId, half_edge: &HalfEdge) -> LoopCorner {
        let point = half_edge.from;
        LoopCorner { point, at: self.positions[point.index()], line: half_edge.line(), piece }
    }

    /// Whether two coordinates of a point are its own, not rounded.
    pub(super) fn are_exact(&self, point: PointId, u: usize, v: usize) -> bool {
        let both = 1 << u | 1 << v;
        self.exact[point.index()] & both == both
    }

    /// The exact lexicographic order of two points by some of their coordinates.
    pub(super) fn compare(&self, table: &PlaneTable, p: PointId, q: PointId, axes: &[usize]) -> cmp::Ordering {
        if p == q {
            return cmp::Ordering::Equal;
        }
        let (at_p, at_q) = (self.positions[p.index()], self.positions[q.index()]);
        let rows = |point: PointId| self.planes[point.index()].map(|plane| table.row(plane));
        let by_axis = |axis: &usize| {
            let by_rounded = at_p[*axis].total_cmp(&at_q[*axis]);
            let is_certain = self.exact[p.index()] & self.exact[q.index()] & 1 << *axis != 0;
            if by_rounded.is_ne() || is_certain { by_rounded } else { compare_exactly(rows(p), rows(q), &[*axis]) }
        };
        // points that agree in all of these coordinates
        axes.iter().map(by_axis).find(|order| order.is_ne()).unwrap_or(cmp::Ordering::Equal)
    }

    /// On which side of a plane a point lies; positive is outside.
    pub(super) fn side(&self, table: &PlaneTable, point: PointId, plane: PlaneId) -> Sign {
        let planes = self.planes[point.index()];
        table.side(planes, &table.homogeneous(planes), plane)
    }
}

impl Named {
    /// What is in a list until its points are named.
    fn blank() -> Self {
        Self { planes: [PlaneId::of_index(0); 3], position: DVec3::ZERO, exact: 0 }
    }

    pub(super) fn of(table: &PlaneTable, [a, b, c]: [PlaneId; 3]) -> Self {
        let position = table.position([a, b, c]).expect("the planes of a corner are independent");
        Self { planes: right_handed(table, [a, b, c]), position, exact: exact_coordinates(table, [a, b, c], position) }
    }
}

/// Three planes that meet in a point, in an order in which their normals are right-handed.
pub(super) fn right_handed(table: &PlaneTable, [a, b, c]: [PlaneId; 3]) -> [PlaneId; 3] {
    if table.orient3(a, b, c) == Sign::Positive { [a, b, c] } else { [a, c, b] }
}

/// Which coordinates of the meeting point of three planes are not rounded, a bit for each; not where that is not easily told.
fn exact_coordinates(table: &PlaneTable, planes: [PlaneId; 3], position: DVec3) -> u8 {
    if planes.into_iter().all(|plane| holds_exactly(table, plane, position)) {
        return 0b111;
    }
    planes.into_iter().fold(0, |exact, plane| exact | axis_given_exactly(table, plane, position))
}

/// The order of points whose coordinates, rounded, differ.
fn place(position: DVec3) -> Place {
    (curve_number(position), coordinates(position))
}

/// Coordinates in the order of numbers.
fn coordinates(position: DVec3) -> [u64; 3] {
    position.to_array().map(sortable)
}

/// Names of points in the order of these.
struct Joined {
    /// Each with whether it is the first name of its point.
    names: Vec<(NameId, bool)>,
    /// How many points they name.
    firsts: usize,
}

impl Joined {
    /// Adds the names of a point.
    fn add(&mut self, names: impl Iterator<Item = NameId>) {
        self.names.extend(names.enumerate().map(|(place, k)| (k, place == 0)));
        self.firsts += 1;
    }
}

/// Adds points that round alike in their exact order, each with those that are equal to it.
fn join_equal(table: &PlaneTable, named: &[Named], alike: &[([u64; 3], NameId)], joined: &mut Joined) {
    let planes = |k: NameId| named[k.index()].planes;
    let names = || alike.iter().map(|(_, k)| *k);
    let first = alike[0].1;
    let equal = 1 + names().skip(1).take_while(|k| is_at(table, planes(first), planes(*k))).count();
    if equal == alike.len() {
        joined.add(names());
        return;
    }
    let mut groups: Vec<Vec<NameId>> = vec![names().take(equal).collect()];
    for k in names().skip(equal) {
        match groups.iter_mut().find(|group| is_at(table, planes(group[0]), planes(k))) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    let rows = |k: NameId| planes(k).map(|plane| table.row(plane));
    groups.sort_by(|p, q| compare_exactly(rows(p[0]), rows(q[0]), &[0, 1, 2]));
    groups.iter().for_each(|group| joined.add(group.iter().copied()));
}

/// What names the meeting point of three planes, whatever their order and sides.
pub(super) fn key(triple: [PlaneId; 3]) -> Triple {
    // without a branch
    let [p, q, r] = triple.map(PlaneId::index);
    let (low, high) = (p.min(q), p.max(q));
    let (least, middle, largest) = (low.min(r), low.max(high.min(r)), high.max(r));
    (u64::from(least) << 32 | u64::from(middle), largest)
}

/// A key in one word, of planes whose numbers have at most [`SHORT_BITS`] bits.
fn short((ab, c): Triple) -> u64 {
    (ab >> 32) << (2 * SHORT_BITS) | (ab & 0xFFFF_FFFF) << SHORT_BITS | u64::from(c)
}

/// The key of a word.
fn long(key: u64) -> Triple {
    const LAST: u64 = (1 << SHORT_BITS) - 1;
    ((key >> (2 * SHORT_BITS)) << 32 | key >> SHORT_BITS & LAST, (key & LAST) as u32)
}

/// The planes of a key, unsided.
#[expect(clippy::cast_possible_truncation, reason = "two numbers of 32 bits are taken apart")]
pub(super) fn planes((ab, c): Triple) -> [PlaneId; 3] {
    [(ab >> 32) as u32, ab as u32, c].map(PlaneId::of_index)
}

/// Whether a point given by three planes, right-handed, lies on three others.
pub(super) fn is_at(table: &PlaneTable, planes: [PlaneId; 3], others: [PlaneId; 3]) -> bool {
    let point = table.homogeneous(planes);
    others.into_iter().all(|plane| table.side(planes, &point, plane) == Sign::Zero)
}

/// The bit of the axis that a plane is perpendicular to, where the coordinate that it has there is not rounded.
fn axis_given_exactly(table: &PlaneTable, plane: PlaneId, position: DVec3) -> u8 {
    let [x, y, z, d] = *table.row(plane).coefficients();
    let normal = DVec3::new(x, y, z);
    let axis = normal.abs().max_position();
    let (along, at) = (normal[axis], position[axis]);
    let is_perpendicular = normal.cmpne(DVec3::ZERO).bitmask().count_ones() == 1;
    // the error of a product of such numbers is one itself, and the sum of both is rounded once
    let is_product = d == 0.0 && at == 0.0 || d.abs() > 1e-200 && at.mul_add(along, -d) == 0.0;
    if is_perpendicular && is_product { 1 << axis } else { 0 }
}

/// Whether a plane of short integers passes through a position of few bits: every product and sum is exact then.
fn holds_exactly(table: &PlaneTable, plane: PlaneId, position: DVec3) -> bool {
    const BITS: u32 = 24;
    let limit = f64::from(1 << BITS);
    let row = table.row(plane);
    let [x, y, z, d] = *row.coefficients();
    #[expect(clippy::cast_possible_truncation, reason = "the comparison is what tells")]
    let is_short = |v: f64| f64::from((v * 16.0) as i32) == v * 16.0 && v.abs() < limit;
    row.integer_bits().is_some_and(|bits| bits < BITS)
        && position.to_array().into_iter().all(is_short)
        && x * position.x + y * position.y + z * position.z == d
}

#[cfg(test)]
mod tests {
    use super::{SHORT_BITS, Triple, key, long, planes, short};
    use crate::plane_table::PlaneId;

    #[test]
    fn short_keys_are_those_of_the_same_planes() {
        let last = (1 << SHORT_BITS) - 1;
        for indices in [[0, 1, 2], [7, 5, 6], [last, 0, last - 1], [last, last, last]] {
            let long_key: Triple = key(indices.map(PlaneId::of_index));
            assert_eq!(long(short(long_key)), long_key);
            let mut sorted = indices;
            sorted.sort_unstable();
            assert_eq!(planes(long_key), sorted.map(PlaneId::of_index));
        }
    }
}
