//! In which order bodies are carved out of a cell, and along which of their planes first.
//!
//! Whatever the order, one body leaves one piece for each of its planes that carries a face of what it has in common with
//! the cell. What the order decides is how often the other bodies are cut by these pieces, and which pieces can be merged.
//!
//! The rule: of several bodies the one nearest to the middle of all comes first, so that lists halve. Of its planes those
//! come first whose direction many bodies share, all cells taking them in one and the same order: the pieces become slabs
//! that end where their neighbours do, and merge. Then come the others, first the one that cuts the fewest of the other
//! bodies.

use planecut_kernel::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::carve::Carver;
use super::cell::{Cell, CellPlane};
use super::convex::{Convex, Side};
use crate::bounds::Bounds;
use crate::plane_table::{PlaneId, PlaneTable};

/// A direction is common where at least this many bodies have a face across it,
const FEW: u32 = 3;
/// and at least this share of all bodies.
const SHARE: f64 = 0.25;

/// How to choose, and whether neighbours are merged in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rule {
    pub(super) chooses: bool,
    pub(super) merges: bool,
}

impl Default for Rule {
    fn default() -> Self {
        Self { chooses: true, merges: true }
    }
}

/// The next body to carve out, by its place in the list.
pub(super) fn next_body(carver: &Carver, cell: &Cell, bodies: &[u32]) -> Option<usize> {
    if bodies.len() < 3 || !carver.rule.chooses {
        return bodies.len().checked_sub(1);
    }
    let center = |body: &u32| within(carver.bodies[*body as usize].bounds(), cell.bounds()).center();
    let middle = bodies.iter().map(center).sum::<DVec3>() / bodies.len() as f64;
    let far = |k: &usize| (center(&bodies[*k]) - middle).length_squared();
    (0..bodies.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

fn within(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// The next plane to cut along, by its place in the list.
pub(super) fn next_plane(carver: &Carver, bodies: &[u32], planes: &[CellPlane]) -> Option<usize> {
    if planes.len() < 2 || !carver.rule.chooses {
        return planes.len().checked_sub(1);
    }
    let cuts = |plane: PlaneId| bodies.iter().filter(|body| carver.box_side(**body, plane) == Side::Both).count();
    let score = |plane: PlaneId| if carver.is_common(plane) { 0 } else { 1 + cuts(plane) };
    let scored = planes.iter().enumerate().map(|(place, plane)| ((score(plane.plane), plane.plane), place));
    scored.min().map(|(_, place)| place)
}

/// The directions across which many bodies have faces.
pub(super) fn common_directions(table: &PlaneTable, bodies: &[&Convex]) -> FxHashSet<Direction> {
    // how many bodies, and the last one
    let mut counts: FxHashMap<Direction, (u32, usize)> = FxHashMap::default();
    for (number, body) in bodies.iter().enumerate() {
        for facet in &body.facets {
            let count = counts.entry(direction(table, facet.plane)).or_insert((0, usize::MAX));
            if count.1 != number {
                *count = (count.0 + 1, number);
            }
        }
    }
    let is_common = |count: u32| count >= FEW && f64::from(count) >= SHARE * bodies.len() as f64;
    counts.into_iter().filter(|(_, (count, _))| is_common(*count)).map(|(direction, _)| direction).collect()
}

/// A normal up to its sign and length, rounded: for counting only.
pub(super) type Direction = [i64; 3];

pub(super) fn direction(table: &PlaneTable, plane: PlaneId) -> Direction {
    let [x, y, z, _] = *table.row(plane.unsided()).coefficients();
    let unit = DVec3::new(x, y, z).normalize() * f64::from(1 << 30);
    unit.to_array().map(|v| v.round() as i64)
}
