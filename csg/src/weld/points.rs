//! Points by the planes that meet in them: equal points get one number, whichever three planes name them.
//!
//! Coordinates are correctly rounded, so equal points have equal coordinates: the coordinates propose, signs decide.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec3, compare_exactly};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::cancel::Run;
use crate::plane_table::{PlaneId, PlaneTable};

/// The points of a weld.
#[derive(Debug, Default)]
pub(super) struct Points {
    /// Three planes through each point, right-handed.
    pub(super) planes: Vec<[PlaneId; 3]>,
    pub(super) positions: Vec<DVec3>,
    /// Whether the position is the point itself, not rounded; false where that is not easily told.
    pub(super) exact: Vec<bool>,
}

impl Points {
    /// Numbers the meeting points of plane triples; gives the number of each, in order.
    pub(super) fn identify(table: &PlaneTable, triples: &[[PlaneId; 3]]) -> (Self, Vec<u32>) {
        let mut seen: FxHashMap<[u32; 3], u32> = FxHashMap::default();
        let mut distinct: Vec<[PlaneId; 3]> = Vec::new();
        let of_triple: Vec<u32> = triples
            .iter()
            .map(|triple| {
                let mut key = triple.map(PlaneId::index);
                key.sort_unstable();
                *seen.entry(key).or_insert_with(|| {
                    distinct.push(triple.map(PlaneId::unsided));
                    distinct.len() as u32 - 1
                })
            })
            .collect();
        let positions: Vec<DVec3> = distinct
            .par_iter()
            .with_min_len(256)
            .map(|triple| table.position(*triple).expect("the planes of a corner are independent"))
            .collect();
        let mut points = Self::default();
        let mut by_position: FxHashMap<[u64; 3], Vec<u32>> = FxHashMap::default();
        let of_distinct: Vec<u32> = distinct
            .into_iter()
            .zip(positions)
            .map(|(triple, position)| {
                let bucket = by_position.entry(position.to_array().map(f64::to_bits)).or_default();
                let known = bucket.iter().copied().find(|point| points.is_at(table, *point, triple));
                known.unwrap_or_else(|| {
                    bucket.push(points.push(table, triple, position));
                    points.planes.len() as u32 - 1
                })
            })
            .collect();
        (points, of_triple.into_iter().map(|k| of_distinct[k as usize]).collect())
    }

    /// The number of the meeting point of three independent planes, a new one where it is not known yet. Looks at all points.
    pub(super) fn add(&mut self, table: &PlaneTable, triple: [PlaneId; 3]) -> u32 {
        let triple = triple.map(PlaneId::unsided);
        let position = table.position(triple).expect("the lines of two edges that cross");
        let known = (0..self.planes.len() as u32)
            .find(|point| self.positions[*point as usize] == position && self.is_at(table, *point, triple));
        known.unwrap_or_else(|| self.push(table, triple, position))
    }

    fn push(&mut self, table: &PlaneTable, [a, b, c]: [PlaneId; 3], position: DVec3) -> u32 {
        let right_handed = table.orient3(a, b, c) == Sign::Positive;
        self.planes.push(if right_handed { [a, b, c] } else { [a, c, b] });
        self.positions.push(position);
        self.exact.push([a, b, c].into_iter().all(|plane| holds_exactly(table, plane, position)));
        self.planes.len() as u32 - 1
    }

    /// Whether three independent planes meet in a point.
    fn is_at(&self, table: &PlaneTable, point: u32, triple: [PlaneId; 3]) -> bool {
        triple.into_iter().all(|plane| self.side(table, point, plane) == Sign::Zero)
    }

    /// Keeps only the points at the ends of runs and numbers them by position, so that the numbering does not depend on the
    /// order of the brushes.
    pub(super) fn renumber(&mut self, table: &PlaneTable, mut runs: Vec<Run>) -> Vec<Run> {
        let mut order: Vec<u32> = runs.iter().flat_map(|run| [run.from, run.to]).collect();
        // each once: where coordinates tie, comparing is dear
        order.sort_unstable();
        order.dedup();
        let key = |p: u32| self.positions[p as usize].to_array();
        order.sort_unstable_by(|p, q| {
            let (a, b) = (key(*p), key(*q));
            a[0].total_cmp(&b[0])
                .then(a[1].total_cmp(&b[1]))
                .then(a[2].total_cmp(&b[2]))
                .then_with(|| self.compare_exactly(table, *p, *q))
        });
        let mut number = vec![0; self.planes.len()];
        for (new, old) in order.iter().enumerate() {
            number[*old as usize] = new as u32;
        }
        for run in &mut runs {
            run.from = number[run.from as usize];
            run.to = number[run.to as usize];
        }
        self.planes = order.iter().map(|p| self.planes[*p as usize]).collect();
        self.positions = order.iter().map(|p| self.positions[*p as usize]).collect();
        self.exact = order.iter().map(|p| self.exact[*p as usize]).collect();
        runs
    }

    /// The order of two points whose coordinates round alike.
    #[cold]
    fn compare_exactly(&self, table: &PlaneTable, p: u32, q: u32) -> Ordering {
        if p == q {
            return Ordering::Equal;
        }
        let rows = |point: u32| self.planes[point as usize].map(|plane| table.row(plane));
        compare_exactly(rows(p), rows(q), &[0, 1, 2])
    }

    /// On which side of a plane a point lies; positive is outside.
    pub(super) fn side(&self, table: &PlaneTable, point: u32, plane: PlaneId) -> Sign {
        let planes = self.planes[point as usize];
        table.side(planes, &table.homogeneous(planes), plane)
    }
}

/// Whether a plane of short integers passes through a position of few bits: every product and sum is exact then.
fn holds_exactly(table: &PlaneTable, plane: PlaneId, position: DVec3) -> bool {
    const BITS: u32 = 24;
    let limit = f64::from(1 << BITS);
    let row = table.row(plane);
    let [x, y, z, d] = *row.coefficients();
    let is_short = |v: f64| (v * 16.0).fract() == 0.0 && v.abs() < limit;
    row.integer_bits().is_some_and(|bits| bits < BITS)
        && position.to_array().into_iter().all(is_short)
        && x * position.x + y * position.y + z * position.z == d
}
