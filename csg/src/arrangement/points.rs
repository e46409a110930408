//! Points of the arrangement: what defines them, where they are, and which of them are one.

use std::cmp::Ordering;

use glam::DVec3;
use planecut_kernel::DoubleDouble as Sum;
use planecut_kernel::sign::Sign;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::exact::{ExactPoint, turn_of_points};
use super::predicates::{projected, sign, turn};
use super::surface::{Surface, sorted};
use crate::ids::{Id, PointId, TriangleId};
use crate::weld::triangulate::rounded_turn;

const U: f64 = f64::EPSILON / 2.0;

/// Bound on the relative error of a few operations on sums of two numbers, with plenty of room.
const SUM_BOUND: f64 = 1.0 / (1_u128 << 98) as f64;

/// What defines a point, by the numbers of vertices and triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Key<V, T> {
    /// A vertex of an operand.
    Vertex(V),
    /// Where an edge crosses the plane of a triangle.
    EdgePlane { edge: [V; 2], triangle: T },
    /// Where two edges cross.
    EdgeEdge([[V; 2]; 2]),
    /// Where the planes of three triangles meet.
    ThreePlanes([T; 3]),
}

/// What defines a point of an arrangement.
pub(super) type PointKey = Key<PointId, TriangleId>;

impl<V: Copy + Ord, T: Copy + Ord> Key<V, T> {
    /// Where two edges cross; they are given in any order.
    pub(super) fn of_edges(one: [V; 2], other: [V; 2]) -> Self {
        Self::EdgeEdge(if one < other { [one, other] } else { [other, one] })
    }

    /// The same with other numbers.
    pub(super) fn renumbered<W: Copy + Ord, U: Copy + Ord>(
        self,
        vertex: impl Fn(V) -> W,
        triangle: impl Fn(T) -> U,
    ) -> Key<W, U> {
        let edge = |[a, b]: [V; 2]| sorted(vertex(a), vertex(b));
        match self {
            Self::Vertex(v) => Key::Vertex(vertex(v)),
            Self::EdgePlane { edge: ends, triangle: of } => Key::EdgePlane { edge: edge(ends), triangle: triangle(of) },
            Self::EdgeEdge([one, other]) => Key::of_edges(edge(one), edge(other)),
            Self::ThreePlanes(of) => {
                let mut triangles = of.map(triangle);
                triangles.sort_unstable();
                Key::ThreePlanes(triangles)
            }
        }
    }
}

/// The points of an arrangement. Vertices come first, with their numbers; those that are constructed from them follow.
#[derive(Debug, Default)]
pub(super) struct Points {
    vertices: usize,
    /// What defines each point that is not a vertex.
    keys: Vec<PointKey>,
    /// Where these are.
    places: Vec<Place>,
    number: FxHashMap<PointKey, PointId>,
    /// The planes of the triangles at edges on which points lie.
    planes_at: FxHashMap<[PointId; 2], [TriangleId; 2]>,
    /// The first point at a rounded place, and for each constructed point the next one at the same rounded place.
    at_place: FxHashMap<[u64; 3], PointId>,
    next_at_place: FxHashMap<PointId, PointId>,
}

/// Where a point is: as sums of two numbers, and by how much each may be off.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Correctly rounded.
    at: DVec3,
    /// What rounding left.
    rest: DVec3,
    /// Infinite where the rest is not known.
    slack: DVec3,
}

impl Place {
    /// A point of which nothing but the rounded place is known.
    fn rounded(at: DVec3) -> Self {
        Self { at, rest: DVec3::ZERO, slack: DVec3::INFINITY }
    }

    fn sum(&self, axis: usize) -> Sum {
        Sum::sum(self.at[axis], self.rest[axis])
    }
}

fn place_key(place: DVec3) -> [u64; 3] {
    place.to_array().map(|v| (v + 0.0).to_bits())
}

impl Points {
    /// No points but the vertices, each known by its place.
    pub(super) fn new(surface: &Surface<'_>) -> Self {
        let mut points = Self { vertices: surface.positions.len(), ..Self::default() };
        points.at_place.reserve(2 * points.vertices);
        for vertex in PointId::all(points.vertices) {
            // several corners of bodies may be at one place when rounded
            let first = *points.at_place.entry(place_key(surface.at(vertex))).or_insert(vertex);
            if first != vertex {
                let last = points.last_at(first);
                points.next_at_place.insert(last, vertex);
            }
        }
        points
    }

    /// The last of the points with the rounded place of one.
    fn last_at(&self, mut point: PointId) -> PointId {
        while let Some(next) = self.next_at_place.get(&point) {
            point = *next;
        }
        point
    }

    /// The number of points, vertices included.
    pub(super) fn len(&self) -> usize {
        self.vertices + self.keys.len()
    }

    /// The place of a point, correctly rounded.
    #[inline]
    pub(super) fn at(&self, surface: &Surface<'_>, point: PointId) -> DVec3 {
        match point.index().checked_sub(self.vertices) {
            None => surface.at(point),
            Some(k) => self.places[k].at,
        }
    }

    /// Whether a point is at its place, not just near it: a vertex that is not a corner of a body.
    fn is_there(&self, surface: &Surface<'_>, point: PointId) -> bool {
        point.index() < self.vertices && surface.is_where_it_is_said(point)
    }

    fn key(&self, point: PointId) -> PointKey {
        match point.index().checked_sub(self.vertices) {
            None => PointKey::Vertex(point),
            Some(k) => self.keys[k],
        }
    }

    /// The exact coordinates of a point.
    fn exact(&self, surface: &Surface<'_>, point: PointId) -> ExactPoint {
        ExactPoint::new(surface, &self.key(point))
    }

    /// Adds points, each known by its key from then on. Points at the same place get the same number.
    pub(super) fn add(&mut self, surface: &Surface<'_>, keys: impl Iterator<Item = PointKey>) {
        let mut fresh: Vec<PointKey> = keys.filter(|key| !self.number.contains_key(key)).collect();
        fresh.par_sort_unstable();
        fresh.dedup();
        let place = |key: PointKey| (place_of(surface, &key), key);
        let mut placed: Vec<(Place, PointKey)> = fresh.into_par_iter().with_min_len(256).map(place).collect();
        // numbers follow from where points are, whatever defines them
        placed.par_sort_unstable_by(|(p, one), (q, other)| {
            let along = |axis: usize| p.at[axis].total_cmp(&q.at[axis]);
            along(0).then_with(|| along(1)).then_with(|| along(2)).then_with(|| one.cmp(other))
        });
        self.number.reserve(placed.len());
        self.at_place.reserve(placed.len());
        self.keys.reserve(placed.len());
        self.places.reserve(placed.len());
        for (place, key) in placed {
            let number = self.numbered(surface, key, place);
            self.number.insert(key, number);
        }
    }

    fn numbered(&mut self, surface: &Surface<'_>, key: PointKey, place: Place) -> PointId {
        let fresh = PointId::from_index(self.len());
        let first = *self.at_place.entry(place_key(place.at)).or_insert(fresh);
        if first != fresh {
            let exact = ExactPoint::new(surface, &key);
            let mut other = first;
            loop {
                if self.exact(surface, other).is_at(&exact) {
                    return other;
                }
                match self.next_at_place.get(&other) {
                    Some(next) => other = *next,
                    None => break,
                }
            }
            self.next_at_place.insert(other, fresh);
        }
        self.keys.push(key);
        self.places.push(place);
        fresh
    }

    /// The number of a point that was added, or is a vertex.
    pub(super) fn of_key(&self, key: &PointKey) -> PointId {
        match key {
            PointKey::Vertex(vertex) => *vertex,
            key => self.number[key],
        }
    }

    /// The turn of three points of a plane, seen along an axis.
    pub(super) fn turn(&self, surface: &Surface<'_>, [a, b, c]: [PointId; 3], axis: usize) -> Sign {
        if a == b || b == c || c == a {
            return Sign::Zero;
        }
        let [p, q, r] = [a, b, c].map(|point| projected(self.at(surface, point), axis));
        let (value, bound) = rounded_turn(p, q, r);
        if surface.is_safe && value.abs() > bound {
            return sign(value);
        }
        if [a, b, c].iter().all(|point| self.is_there(surface, *point)) {
            return turn(surface.input, [a, b, c].map(|point| surface.corner(point)), axis);
        }
        if self.are_of_one_line([a, b, c]) {
            return Sign::Zero;
        }
        if let Some(sign) = self.turn_of_sums(surface, [a, b, c], axis) {
            return sign;
        }
        let [a, b, c] = [a, b, c].map(|point| self.exact(surface, point));
        turn_of_points([&a, &b, &c], axis)
    }

    /// The turn of three points, where sums of two numbers are enough to tell.
    fn turn_of_sums(&self, surface: &Surface<'_>, points: [PointId; 3], axis: usize) -> Option<Sign> {
        if !surface.is_safe {
            return None;
        }
        let place = |point: PointId| match point.index().checked_sub(self.vertices) {
            None if surface.is_where_it_is_said(point) => {
                Place { at: surface.at(point), rest: DVec3::ZERO, slack: DVec3::ZERO }
            }
            None => Place::rounded(surface.at(point)),
            Some(k) => self.places[k],
        };
        let [a, b, c] = points.map(place);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let from_a = |p: &Place, axis: usize| p.sum(axis).plus(a.sum(axis).negated());
        let [bu, bv, cu, cv] = [from_a(&b, u), from_a(&b, v), from_a(&c, u), from_a(&c, v)];
        let (left, right) = (bu.times_sum(cv), bv.times_sum(cu));
        let value = left.plus(right.negated()).high;
        let off = |axis: usize| a.slack[axis] + b.slack[axis] + c.slack[axis] + SUM_BOUND * a.at[axis].abs();
        let [off_u, off_v] = [off(u), off(v)];
        let bound = SUM_BOUND * (left.high.abs() + right.high.abs())
            + 2.0 * (off_u * (bv.high.abs() + cv.high.abs()) + off_v * (bu.high.abs() + cu.high.abs()) + off_u * off_v);
        (value.abs() > bound).then(|| sign(value))
    }

    /// Tells the planes of the triangles at an edge on which points lie.
    pub(super) fn know_edge(&mut self, edge: [PointId; 2], planes: [TriangleId; 2]) {
        self.planes_at.insert(edge, planes);
    }

    /// Whether three points are known to lie on one line by what defines them: on one edge, or in two planes that cross.
    fn are_of_one_line(&self, points: [PointId; 3]) -> bool {
        let keys = points.map(|point| self.key(point));
        keys.iter().any(|key| match *key {
            PointKey::EdgePlane { edge, triangle } => {
                keys.iter().all(|other| is_on_edge(other, edge))
                    || self.planes_at.get(&edge).is_some_and(|planes| {
                        planes.iter().any(|plane| {
                            keys.iter()
                                .all(|other| self.is_in_plane(other, triangle) && self.is_in_plane(other, *plane))
                        })
                    })
            }
            PointKey::EdgeEdge(edges) => edges.iter().any(|edge| keys.iter().all(|other| is_on_edge(other, *edge))),
            PointKey::Vertex(_) | PointKey::ThreePlanes(_) => false,
        })
    }

    /// Whether a point is known to lie in a plane by what defines it.
    fn is_in_plane(&self, key: &PointKey, plane: TriangleId) -> bool {
        let has = |edge: &[PointId; 2]| self.planes_at.get(edge).is_some_and(|planes| planes.contains(&plane));
        match key {
            PointKey::Vertex(_) => false,
            PointKey::EdgePlane { edge, triangle } => *triangle == plane || has(edge),
            PointKey::EdgeEdge(edges) => edges.iter().any(has),
            PointKey::ThreePlanes(planes) => planes.contains(&plane),
        }
    }

    /// The order of two points along an axis: correct rounding keeps it unless it makes them equal.
    pub(super) fn compare(&self, surface: &Surface<'_>, a: PointId, b: PointId, axis: usize) -> Ordering {
        let (p, q) = (self.at(surface, a)[axis], self.at(surface, b)[axis]);
        match p.partial_cmp(&q) {
            Some(Ordering::Equal) | None if a != b && !(self.is_there(surface, a) && self.is_there(surface, b)) => {
                self.exact(surface, a).compare(&self.exact(surface, b), axis)
            }
            order => order.unwrap_or(Ordering::Equal),
        }
    }

    /// The order of two points by their coordinates along two axes.
    pub(super) fn compare_along(&self, surface: &Surface<'_>, a: PointId, b: PointId, axes: [usize; 2]) -> Ordering {
        self.compare(surface, a, b, axes[0]).then_with(|| self.compare(surface, a, b, axes[1]))
    }

    /// An axis along which two points differ, the one along which they differ most where rounding does not hide that, and their order
    /// along it.
    pub(super) fn axis_between(&self, surface: &Surface<'_>, from: PointId, to: PointId) -> (usize, Ordering) {
        let along = (self.at(surface, to) - self.at(surface, from)).abs();
        let longest = along.max_position();
        let order = |axis: usize| (axis, self.compare(surface, from, to, axis));
        [longest, (longest + 1) % 3, (longest + 2) % 3]
            .into_iter()
            .map(order)
            .find(|(_, order)| order.is_ne())
            .unwrap_or((longest, Ordering::Equal))
    }

    /// Whether a point of the line through two others lies between them.
    pub(super) fn is_between(&self, surface: &Surface<'_>, from: PointId, to: PointId, point: PointId) -> bool {
        let (axis, _) = self.axis_between(surface, from, to);
        let order = |a, b| self.compare(surface, a, b, axis);
        point != from && point != to && order(from, point) == order(point, to)
    }

    /// Sorts points of a line from `from` on, an end of all of them.
    pub(super) fn sort_along(&self, surface: &Surface<'_>, from: PointId, to: PointId, points: &mut Vec<PointId>) {
        let (axis, ascending) = self.axis_between(surface, from, to);
        points.sort_unstable();
        points.dedup();
        points.sort_by(|a, b| {
            let order = self.compare(surface, *a, *b, axis);
            if ascending.is_gt() { order.reverse() } else { order }
        });
    }
}

/// Whether a point is known to lie on an edge by what defines it.
fn is_on_edge(key: &PointKey, edge: [PointId; 2]) -> bool {
    match key {
        PointKey::Vertex(vertex) => edge.contains(vertex),
        PointKey::EdgePlane { edge: own, .. } => *own == edge,
        PointKey::EdgeEdge(edges) => edges.contains(&edge),
        PointKey::ThreePlanes(_) => false,
    }
}

/// The place of a point, correctly rounded.
fn place_of(surface: &Surface<'_>, key: &PointKey) -> Place {
    let between = if surface.is_safe && !surface.input.has_bodies {
        match *key {
            PointKey::Vertex(vertex) => return Place::rounded(surface.at(vertex)),
            PointKey::EdgePlane { edge, triangle } => through_plane(surface, edge, triangle),
            PointKey::EdgeEdge([one, other]) => through_edge(surface, one, other),
            PointKey::ThreePlanes(_) => None,
        }
    } else {
        None
    };
    between.unwrap_or_else(|| Place::rounded(ExactPoint::new(surface, key).rounded(surface.input)))
}

/// A vector of sums of two numbers.
type Sums = [Sum; 3];

fn difference(a: DVec3, b: DVec3) -> Sums {
    [0, 1, 2].map(|k| Sum::sum(a[k], -b[k]))
}

/// A component of the cross product of two vectors, and the sum of the magnitudes of its terms.
fn cross_component(a: &Sums, b: &Sums, axis: usize) -> (Sum, f64) {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (left, right) = (a[u].times_sum(b[v]), a[v].times_sum(b[u]));
    (left.plus(right.negated()), left.high.abs() + right.high.abs())
}

/// Where an edge crosses the plane of a triangle, where sums of two numbers are enough to round it.
fn through_plane(surface: &Surface<'_>, edge: [PointId; 2], triangle: TriangleId) -> Option<Place> {
    let [p, q] = edge.map(|end| surface.at(end));
    let [a, b, c] = surface.triangle(triangle).places();
    let (ab, ac) = (difference(b, a), difference(c, a));
    let normal = [0, 1, 2].map(|axis| cross_component(&ab, &ac, axis));
    let distance = |end: DVec3| {
        let along = difference(end, a);
        let terms = [0, 1, 2].map(|k| normal[k].0.times_sum(along[k]));
        let magnitude: f64 = (0..3).map(|k| normal[k].1 * along[k].high.abs()).sum();
        (terms[0].plus(terms[1]).plus(terms[2]), magnitude)
    };
    let ((from_p, magnitude_p), (from_q, magnitude_q)) = (distance(p), distance(q));
    between(p, q, from_p, from_p.plus(from_q.negated()), magnitude_p + magnitude_q)
}

/// Where two edges cross, where sums of two numbers are enough to round it.
fn through_edge(surface: &Surface<'_>, one: [PointId; 2], other: [PointId; 2]) -> Option<Place> {
    let ([p, q], [r, s]) = (one.map(|end| surface.at(end)), other.map(|end| surface.at(end)));
    let (along, across, offset) = (difference(q, p), difference(s, r), difference(r, p));
    let wholes = [0, 1, 2].map(|axis| cross_component(&along, &across, axis));
    let axis = (0..3).max_by(|a, b| wholes[*a].0.high.abs().total_cmp(&wholes[*b].0.high.abs()))?;
    let (share, magnitude) = cross_component(&offset, &across, axis);
    between(p, q, share, wholes[axis].0, magnitude + wholes[axis].1)
}

/// The point a share of the way from `p` to `q`; share and whole are off by a bound times `magnitude`.
fn between(p: DVec3, q: DVec3, share: Sum, whole: Sum, magnitude: f64) -> Option<Place> {
    let error = 2.0 * SUM_BOUND * magnitude / whole.high.abs() + SUM_BOUND;
    // also where the whole is not known to differ from zero
    if error.is_nan() || error > U {
        return None;
    }
    let t = share.over(whole);
    let mut place = Place::rounded(DVec3::ZERO);
    for k in 0..3 {
        let along = Sum::sum(q[k], -p[k]);
        let value = along.times_sum(t).plus(Sum::sum(p[k], 0.0));
        let slack = along.high.abs() * error + SUM_BOUND * (p[k].abs() + q[k].abs());
        place.at[k] = value.rounded_with(slack)?;
        place.rest[k] = (value.high - place.at[k]) + value.low;
        place.slack[k] = slack;
    }
    Some(place)
}
