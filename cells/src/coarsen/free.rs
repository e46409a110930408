//! Merges that add nothing: the hull of both lies within the solid.

use std::ops::ControlFlow;

use planecut_csg::stages::Bounds;
use planecut_kernel::{DVec3, HalfSpace};

use super::CoarsenError;
use super::box_list::BoxList;
use super::clear::Clear;
use super::enclose::enclose;
use super::hull::Hull;
use super::merge::{Merge, Merger};
use super::part::{Part, built, material_of_most};
use super::probes::spread;
use super::search::Search;
use super::subtract::for_each_left;
use crate::tolerances::{FILLED_TOUCHING, NO_VOLUME};

/// A body that is left in more pieces, though all of them are nothing, is not looked into further.
const MOST_PIECES: usize = 1000;
/// Number of points between the corners of both bodies that are looked at before a hull is built exactly.
const LOOKED_AT: usize = 64;
/// Number of points in the hull of both that are looked at then.
const SPREAD: usize = 1000;

/// Merges parts as long as that adds nothing to their union.
pub(super) fn merge_freely(search: &Search) -> Result<Vec<Part>, CoarsenError> {
    let groups = (0..search.parts.len() as u32).map(|part| search.single(part)).collect();
    let mut merger = Merger::new(search, groups, vec![0; search.probes.words()]);
    // what the groups are by now: fewer bodies than parts, and larger
    let mut bodies: Vec<Option<Part>> = search.parts.iter().cloned().map(Some).collect();
    let mut boxes = BoxList::new(search.parts.iter().map(|part| part.bounds).collect());
    while let Some((Merge { kept, gone }, hull)) =
        merger.step_freely(|pair, hull| exact_hull(&bodies, &boxes, pair, hull))
    {
        let members = std::iter::once(&kept).chain(&gone).filter_map(|place| bodies[*place as usize].take());
        let body = merged(hull, &members.collect::<Vec<_>>())?;
        gone.iter().for_each(|place| boxes.set(*place, Bounds::EMPTY));
        boxes.set(kept, body.bounds);
        bodies[kept as usize] = Some(body);
    }
    Ok(bodies.into_iter().flatten().collect())
}

/// The hull of two bodies, exactly; `None` where the solid does not hold it.
fn exact_hull(bodies: &[Option<Part>], boxes: &BoxList, pair: [u32; 2], hull: &Hull) -> Option<Vec<HalfSpace>> {
    let [a, b] = pair.map(|place| bodies[place as usize].as_ref());
    let (a, b) = (a?, b?);
    let others = boxes.touching(&hull.bounds).into_iter().filter(|place| !pair.contains(place));
    // both first, and then what may fill most of the rest
    let mut near: Vec<&Part> = others.filter_map(|place| bodies[place as usize].as_ref()).collect();
    near.sort_by_cached_key(|other| {
        let common = other.bounds.intersection(&hull.bounds);
        std::cmp::Reverse(((common.max - common.min).element_product()).to_bits())
    });
    let filling: Vec<&Part> = [a, b].into_iter().chain(near).collect();
    if !is_filled_between(a, b, &filling, FILLED_TOUCHING * hull.size()) {
        return None;
    }
    // within the solid nothing is to stay clear
    let half_spaces = enclose(&[a, b], &Clear::default()).ok()?;
    is_filled(&half_spaces, &filling, NO_VOLUME * hull.volume).then_some(half_spaces)
}

/// One part for some; the hull is that of the first two.
fn merged(hull: Vec<HalfSpace>, members: &[Part]) -> Result<Part, CoarsenError> {
    let material = material_of_most(members.iter());
    let hull =
        if let [_, _] = members { hull } else { enclose(&members.iter().collect::<Vec<_>>(), &Clear::default())? };
    let part = Part::of_cell(hull, material)?;
    let points = members.iter().flat_map(|member| &member.points).copied();
    // the hull holds them, but by what it is made of, not by what it is
    let points = points.filter(|point| !part.polytope.contains(*point)).collect();
    Ok(Part { points, ..part })
}

/// Whether parts seem to hold what lies half way between corners of two of them, and points spread over the hull of both.
fn is_filled_between(a: &Part, b: &Part, parts: &[&Part], margin: f64) -> bool {
    let (a, b) = (&a.corners, &b.corners);
    let step = (a.len() * b.len()).div_ceil(LOOKED_AT);
    let halfway = (0..a.len() * b.len()).step_by(step.max(1)).map(|k| 0.5 * (a[k / b.len()] + b[k % b.len()]));
    let corner = |number: f64| {
        let number = (number * (a.len() + b.len()) as f64) as usize;
        if number < a.len() { a[number] } else { b[number - a.len()] }
    };
    let between = (0..SPREAD).map(|k| {
        let (which, share) = (spread(2 * k), spread(2 * k + 1));
        corner(which.x).lerp(corner(which.y), share.x).lerp(corner(which.z), share.y)
    });
    let is_within = |part: &Part, point: DVec3| {
        let is_within = |plane: &HalfSpace| plane.signed_distance(point) <= margin;
        part.half_spaces.iter().all(is_within)
    };
    let mut last = 0;
    halfway.chain(between).all(|point| {
        // neighbours often lie in the same part
        if is_within(parts[last], point) {
            return true;
        }
        let found = parts.iter().position(|part| is_within(part, point));
        last = found.unwrap_or(last);
        found.is_some()
    })
}

/// Whether parts fill a body, but for a volume that is nothing. Where that takes too long to find out, they do not.
fn is_filled(half_spaces: &[HalfSpace], parts: &[&Part], nothing: f64) -> bool {
    let (mut outside, mut pieces) = (0.0, 0);
    let body = built(half_spaces.iter().copied());
    let filled = for_each_left(&body, parts, |piece| {
        outside += piece.measures().map_or(f64::INFINITY, |measures| measures.volume);
        pieces += 1;
        if outside <= nothing && pieces <= MOST_PIECES { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    filled.is_continue()
}
