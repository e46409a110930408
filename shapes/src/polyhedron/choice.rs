//! Which plane to cut along.

use std::cmp::Ordering;

use rustc_hash::FxHashMap;

use super::edges::Edges;
use super::part::{Part, Points};

/// How many sides of points are asked for at most to choose a cut.
const EFFORT: usize = 100_000;
/// How many planes are tried at least.
const MIN_CANDIDATES: usize = 16;

/// What it costs to cut a piece in two.
const CUT_PIECE: f64 = 4.0;
/// What a reflex edge is worth that is no longer one.
const MENDED_EDGE: f64 = 24.0;
/// What it costs that one side has a piece more than the other: parts that shrink slowly take long, and are cut more often.
const IMBALANCE: f64 = 0.6;
/// What it costs to pass a corner so near that it might have been on the plane.
const DOUBT: f64 = 64.0;

/// The plane that mends many reflex edges and cuts few pieces; `None` where no piece reaches beyond the plane of another.
pub(super) fn best_cut(part: &Part, edges: &Edges, points: &Points<'_>) -> Option<u32> {
    let local = Local::of(part);
    let mut candidates: Vec<u32> =
        edges.reflex.iter().flat_map(|(_, pieces)| pieces.map(|piece| part.pieces[piece as usize].plane)).collect();
    if candidates.is_empty() {
        candidates.extend(part.pieces.iter().map(|piece| piece.plane));
    }
    candidates.sort_unstable();
    candidates.dedup();
    let tried = (EFFORT / local.vertices.len().max(1)).max(MIN_CANDIDATES);
    let step = candidates.len().div_ceil(tried).max(1);
    let cost = |plane: &u32| local.cost(part, edges, points, *plane).map(|cost| (cost, *plane));
    let least = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    let best = candidates.iter().step_by(step).filter_map(cost).min_by(least);
    best.or_else(|| candidates.iter().find_map(cost)).map(|(_, plane)| plane)
}

/// The vertices of a part's pieces, numbered from 0.
struct Local {
    vertices: Vec<u32>,
    /// Of each piece the numbers of its corners, end to end.
    corners: Vec<u32>,
    ends: Vec<u32>,
    number: FxHashMap<u32, u32>,
}

impl Local {
    fn of(part: &Part) -> Self {
        let mut local =
            Self { vertices: Vec::new(), corners: Vec::new(), ends: Vec::new(), number: FxHashMap::default() };
        for piece in &part.pieces {
            for corner in &piece.corners {
                let next = local.vertices.len() as u32;
                let number = *local.number.entry(*corner).or_insert(next);
                if number == next {
                    local.vertices.push(*corner);
                }
                local.corners.push(number);
            }
            local.ends.push(local.corners.len() as u32);
        }
        local
    }

    /// What a cut costs; `None` where nothing lies on one of its sides.
    fn cost(&self, part: &Part, edges: &Edges, points: &Points<'_>, plane: u32) -> Option<f64> {
        let sides: Vec<Ordering> = self.vertices.iter().map(|v| points.side(*v, plane)).collect();
        let doubtful = self.vertices.iter().filter(|v| points.is_doubtful(**v, plane)).count();
        let (mut below, mut above, mut both) = (0usize, 0usize, 0usize);
        let mut start = 0;
        for (piece, end) in part.pieces.iter().zip(&self.ends) {
            let corners = &self.corners[start..*end as usize];
            start = *end as usize;
            if piece.plane == plane {
                continue;
            }
            let has = |side| corners.iter().any(|v| sides[*v as usize] == side);
            match (has(Ordering::Less), has(Ordering::Greater)) {
                (true, true) => both += 1,
                (true, false) => below += 1,
                (false, true) => above += 1,
                (false, false) => {}
            }
        }
        let is_on = |v: &u32| sides[self.number[v] as usize] == Ordering::Equal;
        let mended = edges.reflex.iter().filter(|(ends, _)| ends.iter().all(is_on)).count();
        let is_useful =
            both > 0 || below > 0 && above > 0 || mended > 0 || self.parts_from_own(part, plane, below, above);
        let cost = CUT_PIECE * both as f64 - MENDED_EDGE * mended as f64
            + DOUBT * doubtful as f64
            + IMBALANCE * below.abs_diff(above) as f64;
        is_useful.then_some(cost)
    }

    /// Whether something lies on the side of a plane where its own pieces have no solid.
    fn parts_from_own(&self, part: &Part, plane: u32, below: usize, above: usize) -> bool {
        let has =
            |is_reversed| part.pieces.iter().any(|piece| piece.plane == plane && piece.is_reversed == is_reversed);
        has(false) && above > 0 || has(true) && below > 0
    }
}
