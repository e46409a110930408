//! A loop as its hull without pockets: what lies between the hull and the loop.
//!
//! A notch along an arc has a reflex corner at each of its sides, and a cell of the solid for each; but it is one convex pocket.
//!
//! A pocket is bounded by sides of the loop and by one line of the hull, its lid. The lid is no boundary of the solid, so nothing may
//! depend on how it is rounded: the hull ends a little beyond it, and pockets do not end there at all.

use planecut_kernel::{DVec2, HalfSpace};

use super::extruded::half_spaces;
use super::simple::plane;
use super::walls::{Walls, side};
use crate::outline::{corners_of_hull, largest_coordinate, signed_area, turn};
use crate::parameter::ShapeError;
use crate::tolerances::{LID_NOISE, LID_REACH};

/// Loops of fewer reflex corners are cut into cells.
const MANY: usize = 8;
/// More pockets than these take longer than cells: the lids of the hull are cut by each of them.
const MOST: usize = 16;
/// Walls of the hull, and those of each convex part of the pockets.
pub(super) struct HullAndPockets {
    pub(super) hull: Vec<HalfSpace>,
    pub(super) pockets: Vec<Vec<HalfSpace>>,
}

/// The hull and the pockets of a loop that runs either way, where that takes far fewer bodies than cells.
pub(super) fn hull_and_pockets(corners: &[DVec2]) -> Result<Option<HullAndPockets>, ShapeError> {
    let mut corners = corners.to_vec();
    if signed_area(&corners) < 0.0 {
        corners.reverse();
    }
    let n = corners.len();
    let turn_at = |k: usize| turn(corners[(k + n - 1) % n], corners[k % n], corners[(k + 1) % n]);
    let reflex = (0..n).filter(|k| turn_at(*k) < 0.0).count();
    if reflex < MANY {
        return Ok(None);
    }
    let size = largest_coordinate(&corners);
    let Some(hull) = hull_corners(&corners) else { return Ok(None) };
    let hull = with_corners_on_lids(&corners, &hull, LID_NOISE * size);
    let is_worth_while = |pockets: usize| pockets <= MOST && 3 * pockets < reflex;
    let mut waiting: usize = sides_of(&hull, n).map(|(from, between)| least_parts(from, between, turn_at)).sum();
    if !is_worth_while(waiting) {
        return Ok(None);
    }
    let mut found = HullAndPockets { hull: Vec::new(), pockets: Vec::new() };
    for (from, between) in sides_of(&hull, n) {
        let to = (from + between) % n;
        let line = side(corners[from], corners[to])?;
        if between == 1 {
            let is_short = corners[from].distance(corners[to]) <= LID_REACH * size;
            let depth = |p: &DVec2| (line.offset() - line.normal().truncate().dot(*p)) / line.normal().length();
            if is_short && corners.iter().any(|p| depth(p) < -LID_REACH * size) {
                // rounding turns so short a side anywhere, also across the body
                return Ok(None);
            }
            found.hull.push(line);
            continue;
        }
        if corners[from].distance(corners[to]) <= LID_REACH * size {
            // a mouth that is no wider than what the hull reaches beyond
            return Ok(None);
        }
        let reach = line.normal().length() * size * LID_REACH;
        found.hull.push(plane(line.normal(), line.offset() + reach)?);
        // the lid, and then the sides from its end back to its start
        let pocket: Vec<DVec2> =
            [from].into_iter().chain((1..=between).rev().map(|step| (from + step) % n)).map(|k| corners[k]).collect();
        let walls = Walls::over(&pocket)?;
        for mut cell in walls.cells()? {
            cell.retain(|side| side.facet != 0);
            found.pockets.push(half_spaces(&cell, &walls.half_spaces).collect());
        }
        waiting -= least_parts(from, between, turn_at);
        if !is_worth_while(found.pockets.len() + waiting) {
            return Ok(None);
        }
    }
    Ok(Some(found))
}

/// The sides of a hull of a loop of `n` corners: the corner where each begins, and how many sides of the loop lie behind it.
fn sides_of(hull: &[usize], n: usize) -> impl Iterator<Item = (usize, usize)> {
    hull.iter().enumerate().map(move |(k, from)| (*from, (hull[(k + 1) % hull.len()] + n - from) % n))
}

/// Number of convex parts, at least, of the pocket behind a side of the hull: a cut ends in two of its reflex corners at most.
fn least_parts(from: usize, between: usize, turn_at: impl Fn(usize) -> f64) -> usize {
    // the loop turns to the left where the pocket does to the right
    let reflex = (from + 1..from + between).filter(|k| turn_at(*k) > 0.0).count();
    if between == 1 { 0 } else { 1 + reflex.div_ceil(2) }
}

/// The numbers of the corners of the convex hull, ascending; `None` where they do not come in the order of the loop.
fn hull_corners(corners: &[DVec2]) -> Option<Vec<usize>> {
    let mut hull = corners_of_hull(corners);
    let first = hull.iter().enumerate().min_by_key(|(_, number)| **number)?.0;
    hull.rotate_left(first);
    hull.is_sorted_by(|a, b| a < b).then_some(hull)
}

/// The corners of the hull, and those that lie on its lines but for noise: pockets do not touch their lids in between.
fn with_corners_on_lids(corners: &[DVec2], hull: &[usize], noise: f64) -> Vec<usize> {
    let n = corners.len();
    let mut all = Vec::with_capacity(hull.len());
    for (from, between) in sides_of(hull, n) {
        let (start, along) = (corners[from], corners[(from + between) % n] - corners[from]);
        let is_on_lid = |number: &usize| along.perp_dot(corners[*number] - start) <= noise * along.length();
        all.push(from);
        all.extend((1..between).map(|step| (from + step) % n).filter(is_on_lid));
    }
    all
}
