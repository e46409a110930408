//! What is left of a convex body when others are taken away, as convex pieces, exactly.

use std::ops::ControlFlow;

use planecut_csg::stages::Bounds;
use planecut_kernel::{AddPlaneResult, DVec3, HalfSpace, IncrementalPolytope};

use super::part::{Part, bounds_of};
use crate::tolerances::{CORNER_ROOM, SINGULAR_CORNER};

/// The pieces of a body outside of others. None has interior in common with another.
pub(super) fn subtract(body: &IncrementalPolytope, others: &[&Part]) -> Vec<IncrementalPolytope> {
    let mut left = Vec::new();
    let _: ControlFlow<()> = for_each_left(body, others, |piece| {
        left.push(piece);
        ControlFlow::Continue(())
    });
    left
}

/// Visits the pieces of a body outside of others, one after another as they are found, until told to stop.
pub(super) fn for_each_left<B>(
    body: &IncrementalPolytope,
    others: &[&Part],
    mut visit: impl FnMut(IncrementalPolytope) -> ControlFlow<B>,
) -> ControlFlow<B> {
    // pieces, and the first of the others that they were not held against
    let mut waiting = vec![(body.clone(), bounds_of(&body.to_mesh().0), 0)];
    let mut pieces = Vec::new();
    while let Some((piece, bounds, first)) = waiting.pop() {
        let cut = (first..others.len()).filter(|other| may_touch(others[*other], &bounds));
        let cut = cut.into_iter().find_map(|other| Some((other, cutting(&piece, &others[other].half_spaces)?)));
        match cut {
            Some((other, planes)) => {
                peel(piece, &planes, &mut pieces);
                waiting.extend(pieces.drain(..).map(|piece| {
                    let bounds = bounds_within(&piece, &bounds);
                    (piece, bounds, other + 1)
                }));
            }
            None => visit(piece)?,
        }
    }
    ControlFlow::Continue(())
}

/// Whether a part may have a point in a box: false where one of its planes has all of the box outside.
fn may_touch(part: &Part, bounds: &Bounds) -> bool {
    let is_beyond = |side: &HalfSpace| bounds.extent_along(side.normal(), side.offset()).0 > 0.0;
    part.bounds.touches(bounds) && !part.half_spaces.iter().any(is_beyond)
}

/// A box that holds a bounded body which lies within a box. Corners are taken in floating point, with room for what that loses; where it may
/// lose more, the box stays as it is.
fn bounds_within(body: &IncrementalPolytope, around: &Bounds) -> Bounds {
    let margin = DVec3::splat(CORNER_ROOM * (around.max - around.min).length());
    let center = around.center();
    let mut bounds = Bounds::EMPTY;
    for planes in body.simple_vertices() {
        let [Some(a), Some(b), Some(c)] = planes.map(|plane| plane.and_then(|plane| body.plane(plane))) else {
            return *around;
        };
        let [(a, d), (b, e), (c, f)] = [a, b, c].map(|plane| {
            let length = plane.normal().length();
            (plane.normal() / length, (plane.offset() - plane.normal().dot(center)) / length)
        });
        let determinant = a.dot(b.cross(c));
        if determinant.abs() < SINGULAR_CORNER || !determinant.is_finite() {
            return *around;
        }
        let corner = center + (b.cross(c) * d + c.cross(a) * e + a.cross(b) * f) / determinant;
        bounds = Bounds { min: bounds.min.min(corner), max: bounds.max.max(corner) };
    }
    Bounds { min: bounds.min - margin, max: bounds.max + margin }.intersection(around)
}

/// Whether a body and the intersection of half-spaces have interior in common, exactly.
pub(super) fn shares_interior(body: &IncrementalPolytope, other: &[HalfSpace]) -> bool {
    cutting(body, other).is_some()
}

/// The half-spaces that each cut something off what those before them left; `None` where nothing is left in the end.
fn cutting(body: &IncrementalPolytope, other: &[HalfSpace]) -> Option<Vec<HalfSpace>> {
    let mut common = body.clone();
    let mut cutting = Vec::new();
    for half_space in other {
        match common.add_plane(*half_space) {
            AddPlaneResult::Added { .. } => cutting.push(*half_space),
            AddPlaneResult::Redundant { .. } => {}
            AddPlaneResult::Empty { .. } => return None,
        }
    }
    Some(cutting)
}

/// Cuts off what lies beyond each of the half-spaces in turn; what lies within all of them is dropped.
fn peel(mut piece: IncrementalPolytope, cutting: &[HalfSpace], left: &mut Vec<IncrementalPolytope>) {
    for half_space in cutting {
        let mut outside = piece.clone();
        outside.add_plane(half_space.flipped());
        if !outside.is_empty() {
            left.push(outside);
        }
        piece.add_plane(*half_space);
    }
}
