//! Lines by the planes that meet in them: equal lines get one number, whichever two planes name them.

use std::cmp::Ordering;

use planecut_kernel::sign::{Row, Sign, orient3};
use planecut_kernel::{DVec3, HalfSpace, meet};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::points::Points;
use crate::plane_table::{PlaneId, PlaneTable};

/// A geometric line, directed so that the component of its first axis is positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Two planes through the line, so sided that `nₐ × n_b` is its direction.
    pub(super) planes: [PlaneId; 2],
    /// The first axis along which the line is not constant.
    pub(super) axis: usize,
    /// The signs of the components of the direction.
    direction: [Sign; 3],
}

/// What equal lines share, correctly rounded: the axis, the direction relative to it, and where the line meets the
/// coordinate plane of that axis.
type Key = (usize, [u64; 6]);

/// Numbers the lines of plane pairs; gives the lines and the number of each pair, in order.
pub(super) fn identify(table: &PlaneTable, pairs: &[[PlaneId; 2]]) -> (Vec<Line>, Vec<u32>) {
    let mut seen: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut distinct: Vec<[PlaneId; 2]> = Vec::new();
    let of_pair: Vec<u32> = pairs
        .iter()
        .map(|[a, b]| {
            let key = [a.index().min(b.index()), a.index().max(b.index())];
            *seen.entry(key).or_insert_with(|| {
                distinct.push([a.unsided(), b.unsided()]);
                distinct.len() as u32 - 1
            })
        })
        .collect();
    let axes = AxisPlanes::new();
    let keyed: Vec<(Line, Key)> =
        distinct.par_iter().with_min_len(256).map(|pair| line_and_key(table, &axes, *pair)).collect();
    let mut lines: Vec<Line> = Vec::new();
    let mut by_key: FxHashMap<Key, Vec<u32>> = FxHashMap::default();
    let of_distinct: Vec<u32> = keyed
        .into_iter()
        .map(|(line, key)| {
            let bucket = by_key.entry(key).or_default();
            let known = bucket.iter().copied().find(|k| axes.is_same(table, &lines[*k as usize], &line));
            known.unwrap_or_else(|| {
                lines.push(line);
                bucket.push(lines.len() as u32 - 1);
                lines.len() as u32 - 1
            })
        })
        .collect();
    (lines, of_pair.into_iter().map(|k| of_distinct[k as usize]).collect())
}

impl Line {
    /// Whether `n_a × n_b` of two planes through this line points along it.
    pub(super) fn is_along(&self, table: &PlaneTable, a: PlaneId, b: PlaneId) -> bool {
        table.cross_component(a, b, self.axis) == Sign::Positive
    }

    /// The exact order of two points of the line along its direction.
    ///
    /// Coordinates are correctly rounded: where they differ, the points are in that order.
    pub(super) fn compare(&self, table: &PlaneTable, points: &Points, p: u32, q: u32) -> Ordering {
        if p == q {
            return Ordering::Equal;
        }
        let (at_p, at_q) = (points.positions[p as usize], points.positions[q as usize]);
        for axis in 0..3 {
            if at_p[axis] != at_q[axis] && self.direction[axis] != Sign::Zero {
                let forward = self.direction[axis] == Sign::Positive;
                return if (at_p[axis] < at_q[axis]) == forward { Ordering::Less } else { Ordering::Greater };
            }
        }
        self.compare_exactly(table, points, p, q)
    }

    #[cold]
    fn compare_exactly(&self, table: &PlaneTable, points: &Points, p: u32, q: u32) -> Ordering {
        let [a, b] = self.planes;
        let across = points.planes[q as usize].into_iter().map(|c| (c, table.orient3(a, b, c)));
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

/// The coordinate planes through the origin and at one.
struct AxisPlanes {
    at_zero: [Row; 3],
    at_one: [Row; 3],
}

impl AxisPlanes {
    fn new() -> Self {
        let row =
            |axis: DVec3, offset: f64| Row::new(&HalfSpace::new(axis, offset).expect("an axis is a valid normal"));
        Self { at_zero: DVec3::AXES.map(|axis| row(axis, 0.0)), at_one: DVec3::AXES.map(|axis| row(axis, 1.0)) }
    }

    /// Exactly: both planes of `other` hold the direction and one point of `line`.
    fn is_same(&self, table: &PlaneTable, line: &Line, other: &Line) -> bool {
        let [a, b] = line.planes.map(|p| table.row(p));
        let cut = &self.at_zero[line.axis];
        let point = planecut_kernel::sign::Homogeneous::meet(a, b, cut);
        other.planes.iter().all(|plane| {
            line.planes.iter().any(|p| p.index() == plane.index())
                || orient3(a, b, table.row(*plane)) == Sign::Zero
                    && point.side_of([a, b, cut], table.row(*plane)) == Sign::Zero
        })
    }
}

fn line_and_key(table: &PlaneTable, axes: &AxisPlanes, [a, b]: [PlaneId; 2]) -> (Line, Key) {
    let direction: [Sign; 3] = std::array::from_fn(|axis| table.cross_component(a, b, axis));
    let axis = direction.iter().position(|sign| *sign != Sign::Zero).expect("the planes of an edge are not parallel");
    let line = if direction[axis] == Sign::Positive {
        Line { planes: [a, b], axis, direction }
    } else {
        Line { planes: [b, a], axis, direction: direction.map(Sign::flip) }
    };
    let through_origin = |plane: PlaneId| {
        let normal = table.half_space(plane).normal();
        Row::new(&HalfSpace::new(normal, 0.0).expect("the normal of a valid half-space"))
    };
    let independent = "the line crosses the coordinate plane of its axis";
    let slope = meet(&through_origin(a), &through_origin(b), &axes.at_one[axis]).expect(independent);
    let foot = meet(table.row(a), table.row(b), &axes.at_zero[axis]).expect(independent);
    let bits = |v: DVec3| v.to_array().map(f64::to_bits);
    let ([x, y, z], [u, v, w]) = (bits(slope), bits(foot));
    (line, (axis, [x, y, z, u, v, w]))
}
