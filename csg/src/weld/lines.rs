//! Lines by the planes that meet in them: equal lines get one number, whichever two planes name them.

use std::cmp::Ordering;

use planecut_kernel::sign::{Counts, Row, Sign, orient3};
use planecut_kernel::{DVec3, HalfSpace, line_coordinates};
use rustc_hash::FxHashMap;

use super::points::Points;
use crate::base::{WEIGHTS, intern, made_by_place, map_chunks, map_items, sort_by_number, sortable};
use crate::boundary::BoundaryEdge;
use crate::ids::{DirectedLine, Id, LineId, NameId, PointId};
use crate::plane_table::{PlaneId, PlaneTable};

/// The number of an axis: there are as many lines as a mesh has edges, so that each byte counts.
type Axis = u8;

/// A geometric line, directed so that the component of its first axis is positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Two planes through the line, so sided that `nₐ × n_b` is its direction.
    pub(super) planes: [PlaneId; 2],
    /// The first axis along which the line is not constant.
    axis: Axis,
    /// The signs of the components of the direction.
    direction: [Sign; 3],
}

/// What equal lines share, correctly rounded: the axis, the slopes against it, and where the line meets its plane.
pub(super) type Key = (usize, [u64; 4]);

/// Numbers the lines of edges; gives the lines and the number of the line of each edge, in order.
pub(super) fn identify(table: &PlaneTable, edges: &[BoundaryEdge]) -> (Vec<Line>, Vec<LineId>, Counts) {
    let key = |edge: usize| pair(&edges[edge]);
    let (different, of_pair) = intern(edges.len(), key, table.len(), |key| (key >> 32) as usize, NameId::from_index);
    let (lines, of_different, counts) = number(table, different);
    (lines, made_by_place(edges.len(), 1024, |edge| of_different[of_pair[edge].index()]), counts)
}

/// What names the line of an edge: the indices of its two planes.
pub(super) fn pair(edge: &BoundaryEdge) -> u64 {
    pair_of([edge.face, edge.edge])
}

/// What names the line in which two planes meet.
pub(super) fn pair_of(planes: [PlaneId; 2]) -> u64 {
    let [a, b] = planes.map(|plane| u64::from(plane.index()));
    a.min(b) << 32 | a.max(b)
}

/// Numbers the lines of different pairs, each two plane indices.
fn number(table: &PlaneTable, pairs: Vec<u64>) -> (Vec<Line>, Vec<LineId>, Counts) {
    let (mut lines, mut counts) = map_items(&pairs, 256, Line::blank(), |_, pair| Line::of(table, *pair));
    drop(pairs);
    let mark_of = |number, line: &Line| mark(table, line, NameId::from_index(number));
    let (mut order, marking) = map_items(&lines, 256, Mark::new(0, 0.0, 0.0, NameId::NONE), mark_of);
    counts += marking;
    sort_by_number(&mut order, |mark| mark.low);
    // runs of lines that may be equal
    let mut runs: Vec<&[Mark]> = Vec::new();
    let mut start = 0;
    while start < order.len() {
        let (mut end, mut reach) = (start + 1, order[start].high());
        while end < order.len() && order[end].low <= reach {
            reach = reach.max(order[end].high());
            end += 1;
        }
        if end - start > 1 {
            runs.push(&order[start..end]);
        }
        start = end;
    }
    let axes = AxisPlanes::default();
    let (parts, joining) = map_chunks(&runs, 64, |chunk| {
        let (mut some, mut equal) = (Vec::new(), Vec::new());
        for run in chunk {
            some.clear();
            some.extend(run.iter().map(|mark| mark.line));
            some.sort_unstable();
            find_equal(table, &axes, &lines, &some, &mut equal);
        }
        equal
    });
    drop(runs);
    drop(order);
    counts += joining;
    // of lines that are equal, the first in the order given; most are alone
    let mut first: Vec<NameId> = NameId::all(lines.len()).collect();
    for (line, other) in parts.into_iter().flatten() {
        first[line.index()] = other;
    }
    let (mut number, mut different) = (Vec::with_capacity(lines.len()), 0);
    for (k, first) in first.into_iter().enumerate() {
        if first.index() == k {
            number.push(LineId::from_index(different));
            lines[different] = lines[k];
            different += 1;
        } else {
            number.push(number[first.index()]);
        }
    }
    lines.truncate(different);
    (lines, number, counts)
}

/// Finds which of some lines, given in ascending order, are equal to an earlier one: by their exact keys, confirmed by signs.
fn find_equal(
    table: &PlaneTable,
    axes: &AxisPlanes,
    lines: &[Line],
    some: &[NameId],
    equal: &mut Vec<(NameId, NameId)>,
) {
    let mut by_key: FxHashMap<Key, Vec<NameId>> = FxHashMap::default();
    for k in some {
        let line = &lines[k.index()];
        let bucket = by_key.entry(key(table, line)).or_default();
        match bucket.iter().copied().find(|other| axes.is_same(table, &lines[other.index()], line)) {
            Some(other) => equal.push((*k, other)),
            None => bucket.push(*k),
        }
    }
}

/// A range of numbers: those of equal lines overlap, and of lines that differ hardly any do. In the order of where they begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Mark {
    low: u64,
    /// The line that it is of.
    line: NameId,
    /// The bits of its width in single precision, rounded up: so marks are as short as a number with its place.
    width: u32,
}

impl Mark {
    /// That around a value; ranges of lines of different axes hardly ever overlap.
    fn new(axis: usize, value: f64, error: f64, line: NameId) -> Self {
        // the last two bits make room for the axis: without them the lower end is lower, and the upper one is made higher
        let number = |value: f64| (axis as u64) << 62 | sortable(value) >> 2;
        let (low, high) = (number(value - error), number(value + error) + 1);
        Self { low, line, width: rounded_up(high - low).to_bits() }
    }

    /// Where it ends, or somewhat above.
    fn high(&self) -> u64 {
        self.low.saturating_add(whole(f32::from_bits(self.width)))
    }
}

/// The least number in single precision that is not below a whole one.
#[expect(clippy::cast_precision_loss, reason = "rounding is what it is for")]
fn rounded_up(number: u64) -> f32 {
    let rounded = number as f32;
    if whole(rounded) < number { rounded.next_up() } else { rounded }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number is whole and not negative")]
fn whole(number: f32) -> u64 {
    number as u64
}

impl Line {
    /// What is in a list until its lines are made.
    fn blank() -> Self {
        Self { planes: [PlaneId::of_index(0); 2], axis: 0, direction: [Sign::Zero; 3] }
    }

    /// That of a [`pair`] of planes.
    #[expect(clippy::cast_possible_truncation, reason = "two numbers of 32 bits are taken apart")]
    pub(super) fn of(table: &PlaneTable, pair: u64) -> Self {
        let [a, b] = [pair >> 32, pair & 0xFFFF_FFFF].map(|p| PlaneId::of_index(p as u32));
        let direction: [Sign; 3] = std::array::from_fn(|axis| table.cross_component(a, b, axis));
        let axis = (0..3).find(|axis: &Axis| direction[usize::from(*axis)] != Sign::Zero);
        let axis = axis.expect("the planes of an edge are not parallel");
        if direction[usize::from(axis)] == Sign::Positive {
            Self { planes: [a, b], axis, direction }
        } else {
            Self { planes: [b, a], axis, direction: direction.map(Sign::flip) }
        }
    }

    /// The first axis along which the line is not constant.
    pub(super) fn axis(&self) -> usize {
        usize::from(self.axis)
    }

    /// This line, of which the number is given, in the direction `n_a × n_b` of two planes through it.
    pub(super) fn directed(&self, number: LineId, table: &PlaneTable, a: PlaneId, b: PlaneId) -> DirectedLine {
        DirectedLine::new(number, self.is_along(table, a, b))
    }

    /// Whether `n_a × n_b` of two planes through this line points along it.
    fn is_along(&self, table: &PlaneTable, a: PlaneId, b: PlaneId) -> bool {
        let [p, q] = self.planes;
        if (a.index(), b.index()) == (p.index(), q.index()) {
            return (a == p) == (b == q);
        }
        if (a.index(), b.index()) == (q.index(), p.index()) {
            return (a == q) != (b == p);
        }
        table.cross_component(a, b, self.axis()) == Sign::Positive
    }

    /// The coordinate of a point of the line along which the line rises, correctly rounded: points for which it differs are in that order.
    pub(super) fn height(&self, points: &Points, point: PointId) -> f64 {
        // by its address, which needs no branch
        points.positions[point.index()].to_array()[self.axis()]
    }

    /// The exact order of two points of the line along its direction.
    ///
    /// Coordinates are correctly rounded: where they differ, the points are in that order.
    #[inline]
    pub(super) fn compare(&self, table: &PlaneTable, points: &Points, p: PointId, q: PointId) -> Ordering {
        // along a line the same points come again and again
        if p == q { Ordering::Equal } else { self.compare_different(table, points, p, q) }
    }

    fn compare_different(&self, table: &PlaneTable, points: &Points, p: PointId, q: PointId) -> Ordering {
        let (at_p, at_q) = (points.positions[p.index()], points.positions[q.index()]);
        for axis in 0..3 {
            if at_p[axis] != at_q[axis] && self.direction[axis] != Sign::Zero {
                let forward = self.direction[axis] == Sign::Positive;
                return if (at_p[axis] < at_q[axis]) == forward { Ordering::Less } else { Ordering::Greater };
            }
        }
        self.compare_exactly(table, points, p, q)
    }

    #[cold]
    fn compare_exactly(&self, table: &PlaneTable, points: &Points, p: PointId, q: PointId) -> Ordering {
        let [a, b] = self.planes;
        let across = points.planes[q.index()].into_iter().map(|c| (c, table.orient3(a, b, c)));
        let Some((plane, ahead)) = across.into_iter().find(|(_, sign)| *sign != Sign::Zero) else {
            return Ordering::Equal;
        };
        match points.side(table, p, plane).times(ahead) {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        }
    }
}

/// The coordinate planes through the origin.
#[derive(Clone)]
pub(super) struct AxisPlanes {
    at_zero: [Row; 3],
}

impl Default for AxisPlanes {
    fn default() -> Self {
        let row = |axis: DVec3| Row::new(&HalfSpace::new(axis, 0.0).expect("an axis is a valid normal"));
        Self { at_zero: DVec3::AXES.map(row) }
    }
}

impl AxisPlanes {
    /// Exactly: both planes of `other` hold the direction and one point of `line`.
    pub(super) fn is_same(&self, table: &PlaneTable, line: &Line, other: &Line) -> bool {
        let [a, b] = line.planes.map(|p| table.row(p));
        let cut = &self.at_zero[line.axis()];
        let point = planecut_kernel::sign::Homogeneous::meet(a, b, cut);
        other.planes.iter().all(|plane| {
            line.planes.iter().any(|p| p.index() == plane.index())
                || orient3(a, b, table.row(*plane)) == Sign::Zero
                    && point.side_of([a, b, cut], table.row(*plane)) == Sign::Zero
        })
    }
}

fn mark(table: &PlaneTable, line: &Line, number: NameId) -> Mark {
    let (value, error) = rounded_mark(table, line).unwrap_or_else(|| exact_mark(table, line));
    Mark::new(line.axis(), value, error, number)
}

/// From the determinants of the planes' columns in plain numbers, where these are well conditioned: each is off by less than
/// three roundings of its permanent, the quotient by those of both and its own.
fn rounded_mark(table: &PlaneTable, line: &Line) -> Option<(f64, f64)> {
    const DETERMINANT_BOUND: f64 = 4.0 * f64::EPSILON;
    const WELL: f64 = 1e4;
    let [a, b] = line.planes.map(|plane| table.row(plane).coefficients());
    let (u, v) = ((line.axis() + 1) % 3, (line.axis() + 2) % 3);
    let minor = |i: usize, j: usize| {
        let (p, q) = (a[i] * b[j], a[j] * b[i]);
        (p - q, p.abs() + q.abs())
    };
    let (whole, whole_permanent) = minor(u, v);
    if whole_permanent > WELL * whole.abs() {
        return None;
    }
    let (mut mark, mut error) = (0.0, 0.0);
    for (weight, (i, j)) in WEIGHTS.iter().zip([(v, line.axis()), (line.axis(), u), (3, v), (u, 3)]) {
        let (value, permanent) = minor(i, j);
        let quotient = value / whole;
        mark += weight * quotient;
        error += DETERMINANT_BOUND * (permanent + quotient.abs() * whole_permanent) / whole.abs()
            + DETERMINANT_BOUND * quotient.abs();
    }
    mark.is_finite().then_some((mark, 2.0 * error))
}

fn exact_mark(table: &PlaneTable, line: &Line) -> (f64, f64) {
    let numbers = exact_numbers(table, line);
    let terms = || numbers.into_iter().zip(WEIGHTS).map(|(number, weight)| number * weight);
    (terms().sum(), 8.0 * f64::EPSILON * terms().map(f64::abs).sum::<f64>())
}

fn exact_numbers(table: &PlaneTable, line: &Line) -> [f64; 4] {
    let [a, b] = line.planes.map(|plane| table.row(plane));
    line_coordinates(a, b, line.axis()).expect("the line crosses the planes of its axis")
}

/// What equal lines share.
pub(super) fn key(table: &PlaneTable, line: &Line) -> Key {
    (line.axis(), exact_numbers(table, line).map(f64::to_bits))
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn marks_hold_the_range_that_they_are_made_of() {
        let mut rng = Rng::spread(32);
        for power in 0..62 {
            for _ in 0..1000 {
                let width = (1_u64 << power) + rng.below(1 << power.min(40)) as u64;
                let rounded = whole(rounded_up(width));
                assert!(width <= rounded && rounded - width <= width >> 22, "{width} became {rounded}");
            }
        }
        // a range around zero is nearly as wide as all numbers
        for (value, error) in [(0.0, 0.0), (1.5, 1e-15), (-2.0, 1e-300), (1e-17, 1e-15), (0.0, 1e300)] {
            let mark = Mark::new(1, value, error, NameId::NONE);
            let number = |value: f64| 1 << 62 | sortable(value) >> 2;
            assert!(mark.low <= number(value - error) && number(value + error) <= mark.high(), "{value} {error}");
        }
    }
}
