//! Cells drawn in to what they alone hold.
//!
//! Cells may overlap. What another cell holds as well, a cell need not: the hull of the rest is smaller. Each step leaves the union
//! of the cells around the solid, exactly: the rest is what the solid has outside of all other cells, as exact convex pieces.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::CoarsenError;
use super::clear::Clear;
use super::enclose::{all_hold, enclose};
use super::part::{Part, bounds_of};
use super::probes::{Coverage, Probes, count_fresh, once_and_twice, unit_planes};
use super::subtract::{shares_interior, subtract};
use crate::tolerances::{CORNER_WITHIN, WORTH_SHRINKING};

/// Number of cells of which those are looked for that can be drawn in at once.
const AHEAD: usize = 256;

/// The parts of the solid, and what its cells must keep.
pub(super) struct Shrinking<'a> {
    pub(super) parts: &'a [Part],
    pub(super) boxes: &'a Boxes,
    pub(super) clear: &'a Clear,
    pub(super) by_material: bool,
}

impl Shrinking<'_> {
    /// Draws cells in, those that add most first; cells that hold nothing alone are dropped. Cells that add nothing alone, as far as probes
    /// can tell, stay as they are.
    ///
    /// Once is enough: as others are drawn in, what a cell alone holds becomes no less.
    pub(super) fn shrink(&self, bodies: &mut Vec<Part>, probes: &Probes) -> Result<(), CoarsenError> {
        let adds = added_alone(bodies, probes);
        let mut order: Vec<usize> = (0..bodies.len()).filter(|place| adds[*place] > 0).collect();
        order.sort_by(|a, b| adds[*b].cmp(&adds[*a]).then(a.cmp(b)));
        let reaches: Vec<Bounds> = bodies.par_iter().map(|body| self.reach(body)).collect();
        let mut is_dropped = vec![false; bodies.len()];
        while !order.is_empty() {
            let taken = independent(&mut order, |place, earlier| reaches[place].touches(&bodies[earlier].bounds));
            let drawn_in = |place: &usize| self.drawn_in(bodies, &is_dropped, *place, &reaches[*place]);
            let found: Vec<Result<Outcome, _>> = taken.par_iter().with_max_len(1).map(drawn_in).collect();
            for (place, outcome) in taken.into_iter().zip(found) {
                match outcome? {
                    Outcome::Same => {}
                    Outcome::Smaller(smaller) => bodies[place] = *smaller,
                    Outcome::Nothing => is_dropped[place] = true,
                }
            }
        }
        let mut dropped = is_dropped.iter();
        bodies.retain(|_| !dropped.next().is_some_and(|is_dropped| *is_dropped));
        Ok(())
    }

    /// The box of all parts that a cell may hold some of, and their points.
    fn reach(&self, body: &Part) -> Bounds {
        let mut near = Vec::new();
        self.boxes.touching(&body.bounds, &mut near);
        let parts = near.into_iter().map(|part| &self.parts[part as usize]);
        parts.fold(body.bounds, |all, part| all.union(&part.bounds).union(&bounds_of(&part.points)))
    }

    /// What becomes of a cell.
    fn drawn_in(
        &self,
        bodies: &[Part],
        is_dropped: &[bool],
        place: usize,
        reach: &Bounds,
    ) -> Result<Outcome, CoarsenError> {
        let own = &bodies[place];
        let others: Vec<&Part> = self.others(bodies, is_dropped, place, reach);
        if !others.iter().any(|other| other.bounds.touches(&own.bounds)) {
            return Ok(Outcome::Same);
        }
        let Some(pieces) = self.held_alone(own, &others)? else { return Ok(Outcome::Same) };
        if pieces.is_empty() {
            return Ok(Outcome::Nothing);
        }
        let pieces: Vec<&Part> = pieces.iter().collect();
        let smaller = Part::of_cell(enclose(&pieces, self.clear)?, own.material)?;
        let is_worth_it = smaller.volume() < own.volume() * WORTH_SHRINKING;
        Ok(if is_worth_it { Outcome::Smaller(Box::new(smaller)) } else { Outcome::Same })
    }

    /// The other cells that may hold some of the parts that a cell does.
    fn others<'b>(&self, bodies: &'b [Part], is_dropped: &[bool], place: usize, reach: &Bounds) -> Vec<&'b Part> {
        let own = &bodies[place];
        let others = bodies.iter().enumerate().filter(|(other, _)| *other != place && !is_dropped[*other]);
        let others = others.map(|(_, other)| other).filter(|other| other.bounds.touches(reach));
        others.filter(|other| !self.by_material || other.material == own.material).collect()
    }

    /// What a cell holds of the solid and no other cell does, as convex pieces; `None` where others hold nothing of its parts.
    fn held_alone(&self, own: &Part, others: &[&Part]) -> Result<Option<Vec<Part>>, CoarsenError> {
        let mut near = Vec::new();
        self.boxes.touching(&own.bounds, &mut near);
        let near = near.into_iter().map(|part| &self.parts[part as usize]);
        let near: Vec<&Part> = near.filter(|part| !self.by_material || part.material == own.material).collect();
        let left: Vec<Option<Vec<Part>>> =
            near.par_iter().map(|part| left_of(part, others)).collect::<Result<_, _>>()?;
        if left.iter().all(Option::is_none) {
            return Ok(None);
        }
        let pieces = near.into_iter().zip(left).flat_map(|(part, left)| left.unwrap_or_else(|| vec![part.clone()]));
        Ok(Some(pieces.collect()))
    }
}

/// What becomes of a cell.
enum Outcome {
    Same,
    Smaller(Box<Part>),
    Nothing,
}

/// Takes those places out, of the first ones, that depend on none before them: then it is the same whether they are dealt with at once or one after
/// another.
fn independent(order: &mut Vec<usize>, depends: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let ahead = order.len().min(AHEAD);
    let is_taken: Vec<bool> =
        (0..ahead).map(|k| !order[..k].iter().any(|earlier| depends(order[k], *earlier))).collect();
    let mut taken = Vec::new();
    let mut number = 0;
    order.retain(|place| {
        let is_taken = is_taken.get(number) == Some(&true);
        number += 1;
        if is_taken {
            taken.push(*place);
        }
        !is_taken
    });
    taken
}

/// What no cell holds of a part, as convex pieces; `None` for all of it.
fn left_of(part: &Part, cells: &[&Part]) -> Result<Option<Vec<Part>>, CoarsenError> {
    let near: Vec<&Part> = cells.iter().copied().filter(|cell| cell.bounds.touches(&part.bounds)).collect();
    if near.iter().any(|cell| holds_part(cell, part)) {
        return Ok(Some(Vec::new()));
    }
    let mut cutting: Vec<&Part> =
        near.into_iter().filter(|cell| shares_interior(&part.polytope, &cell.half_spaces)).collect();
    let points = part.points.iter().filter(|point| !cells.iter().any(|cell| all_hold(&cell.half_spaces, **point)));
    let points: Vec<DVec3> = points.copied().collect();
    if cutting.is_empty() {
        return Ok((points.len() < part.points.len()).then(|| vec![Part { points, ..part.clone() }]));
    }
    // what holds most of it goes first, and leaves less to the others
    let held = |cell: &Part| part.corners.iter().filter(|corner| nearly_holds(cell, **corner, part)).count();
    cutting.sort_by_cached_key(|cell| std::cmp::Reverse(held(cell)));
    let rest = subtract(&part.polytope, &cutting);
    let pieces = rest.into_iter().filter_map(|piece| Part::of_polytope(piece, part.material).transpose());
    let mut pieces: Vec<Part> = pieces.collect::<Result<_, _>>()?;
    match pieces.first_mut() {
        Some(piece) => piece.points = points,
        None if points.is_empty() => {}
        // rounding alone keeps it here
        None => pieces.push(Part { points, ..part.clone() }),
    }
    Ok(Some(pieces))
}

/// How many probes each cell alone covers.
pub(super) fn added_alone(bodies: &[Part], probes: &Probes) -> Vec<u32> {
    let coverage: Vec<Coverage> =
        bodies.par_iter().map(|body| probes.within(&unit_planes(&body.half_spaces), &body.bounds)).collect();
    let (_, twice) = once_and_twice(probes.words(), coverage.iter());
    coverage.iter().map(|own| count_fresh(&twice, own)).collect()
}

/// Whether a cell holds all of a part, exactly.
fn holds_part(body: &Part, part: &Part) -> bool {
    part.corners.iter().all(|corner| nearly_holds(body, *corner, part))
        && body.half_spaces.iter().all(|plane| part.is_within(plane))
}

/// Whether a cell holds a corner of a part, or would but for rounding.
fn nearly_holds(body: &Part, corner: DVec3, part: &Part) -> bool {
    let margin = CORNER_WITHIN * part.size();
    body.half_spaces.iter().all(|plane| plane.signed_distance(corner) <= margin)
}
