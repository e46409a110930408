//! Winding numbers at places within facets, by plain numbers that are sure of what they say.
//!
//! Where facets are left out because they cannot be seen, winding numbers do not spread to all regions, and regions need not have an edge of
//! the input beside them. A place within a facet is never exactly on it; but where all else is farther away than rounding
//! can be, that does not matter.

use glam::{DVec2, DVec3};
use planecut_kernel::sign::Sign;

use super::regions::FacetSide;
use super::states::Windings;
use crate::arrangement::Arrangement;
use crate::arrangement::facets::{FacetKind, Facets};
use crate::arrangement::hidden::Deciders;
use crate::arrangement::predicates::{best_axis, projected};
use crate::base::{Bounds, Boxes};
use crate::ids::{Id, InputTriangleId, PointId, number32};

/// How far a place may be from where it is meant to be, as a share of the largest coordinate of all.
const SLACK: f64 = 64.0 * f64::EPSILON;

/// Places that are tried in one facet.
const TRIES: usize = 8;

/// What is known of a region.
#[derive(Debug, Clone)]
pub(super) enum Content {
    /// It lies in an operand that decides.
    Decided,
    /// Winding numbers of all operands.
    Windings(Windings),
}

/// Tells winding numbers at places within facets.
pub(super) struct Places<'a> {
    arrangement: &'a Arrangement<'a>,
    facets: &'a Facets,
    deciders: &'a Deciders,
    boxes: Boxes,
    /// How far a place may be from where it is meant to be.
    slack: f64,
}

/// A ray from a place along an axis.
struct Ray {
    from: DVec3,
    axis: usize,
    is_ascending: bool,
}

impl<'a> Places<'a> {
    pub(super) fn new(arrangement: &'a Arrangement<'a>, facets: &'a Facets, deciders: &'a Deciders) -> Self {
        let operands = &arrangement.surface.input.operands;
        let boxes: Vec<Bounds> = operands.iter().map(|operand| operand.tree().all_bounds()).collect();
        let all = boxes.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
        let size = all.min.abs().max(all.max.abs()).max_element();
        Self { arrangement, facets, deciders, boxes: Boxes::new(boxes), slack: SLACK * size }
    }

    /// What is known of the region on a side of a facet, if some place within that facet tells.
    pub(super) fn content(&self, side: FacetSide) -> Option<Content> {
        let surface = &self.arrangement.surface;
        let triangle = match self.facets.kind(side.facet) {
            FacetKind::Patch(patch) => {
                let patch = self.arrangement.patches.all[patch.index()];
                surface.input.triangle(patch.operand as usize, patch.first)
            }
            _ => surface.triangle(self.facets.triangle(&self.arrangement.cells, side.facet)),
        };
        let (axis, sign) = best_axis(surface.input, &triangle)?;
        let is_ascending = (sign == Sign::Positive) == side.is_above;
        // a ray that leaves a plane does not come back to it
        let is_in_plane = |other: InputTriangleId| {
            let plane = |number| self.arrangement.planes[surface.triangle_of(number).index()];
            let are_here = surface.has(other) && surface.has(triangle.number);
            other == triangle.number || are_here && plane(other) == plane(triangle.number)
        };
        let places: Vec<DVec3> = match self.facets.kind(side.facet) {
            FacetKind::Cell(cell) => self.places_in_cell(cell, axis),
            _ => vec![triangle.places().into_iter().sum::<DVec3>() / 3.0],
        };
        places.into_iter().find_map(|from| self.content_along(&Ray { from, axis, is_ascending }, is_in_plane))
    }

    /// Places within a cell, seen along an axis.
    fn places_in_cell(&self, cell: usize, axis: usize) -> Vec<DVec3> {
        let at = |point: &PointId| self.arrangement.points.at(&self.arrangement.surface, *point);
        let loops: Vec<Vec<DVec3>> =
            self.arrangement.cells.loops(cell).map(|points| points.iter().map(at).collect()).collect();
        let Some(first) = loops.first() else { return Vec::new() };
        let count = first.len();
        let step = count.div_ceil(TRIES).max(1);
        let corners = (0..count).step_by(step).map(|k| [k, (k + 1) % count, (k + 2) % count].map(|k| first[k]));
        let beside_corners = corners.map(|[a, b, c]| (a + b + c) / 3.0);
        beside_corners.filter(|place| self.is_within(&loops, projected(*place, axis), axis)).collect()
    }

    /// Whether a place is sure to lie within loops.
    fn is_within(&self, loops: &[Vec<DVec3>], place: DVec2, axis: usize) -> bool {
        let mut crossings = 0;
        for points in loops {
            let count = points.len();
            for k in 0..count {
                let [a, b] = [points[k], points[(k + 1) % count]].map(|point| projected(point, axis));
                if (a.y - place.y).abs() <= self.slack {
                    return false;
                }
                if (a.y > place.y) != (b.y > place.y) {
                    let Some(sign) = self.turn(a, b, place) else { return false };
                    crossings += u32::from((sign == Sign::Positive) == (b.y > a.y));
                }
            }
        }
        crossings % 2 == 1
    }

    /// On which side of the line from `a` to `b` a place lies, if that is sure.
    fn turn(&self, a: DVec2, b: DVec2, place: DVec2) -> Option<Sign> {
        let (along, to) = (b - a, place - a);
        let value = along.perp_dot(to);
        // each place may be off
        let bound = 4.0 * self.slack * (along.abs().element_sum() + to.abs().element_sum() + self.slack);
        (value.abs() > bound).then(|| crate::arrangement::predicates::sign(value))
    }

    /// What holds at the beginning of a ray, if that is sure; triangles in the plane that it leaves do not count.
    fn content_along(&self, ray: &Ray, is_in_plane: impl Fn(InputTriangleId) -> bool) -> Option<Content> {
        let mut reach = Bounds { min: ray.from - self.slack, max: ray.from + self.slack };
        if ray.is_ascending {
            reach.max[ray.axis] = f64::INFINITY;
        } else {
            reach.min[ray.axis] = f64::NEG_INFINITY;
        }
        let input = self.arrangement.surface.input;
        let mut near = Vec::new();
        self.boxes.touching(&reach, &mut near);
        near.sort_unstable();
        let mut windings = Windings::new();
        let mut is_sure = true;
        for operand in near {
            let own = &input.operands[operand as usize];
            let mut winding = Some(0);
            let passes = |bounds: &Bounds| bounds.touches(&reach);
            own.tree().for_each(passes, |triangle| {
                if own.bounds(triangle).touches(&reach) && !is_in_plane(input.number(operand as usize, triangle)) {
                    let places = input.triangle(operand as usize, triangle).places();
                    winding = winding.zip(self.crossing(ray, places)).map(|(sum, crossing)| sum + crossing);
                }
            });
            match winding {
                Some(0) => {}
                Some(winding) if self.deciders.is_decider[operand as usize] && own.rule().is_inside(winding) => {
                    return Some(Content::Decided);
                }
                Some(winding) => windings.push((number32(operand as usize), winding)),
                None => is_sure = false,
            }
        }
        is_sure.then_some(Content::Windings(windings))
    }

    /// How a ray crosses a triangle, if that is sure: 1 where it comes out of it, −1 where it goes in, 0 where it misses it.
    fn crossing(&self, ray: &Ray, places: [DVec3; 3]) -> Option<i32> {
        let [a, b, c] = places.map(|place| projected(place, ray.axis));
        let from = projected(ray.from, ray.axis);
        let turns = [self.turn(a, b, from), self.turn(b, c, from), self.turn(c, a, from)];
        let has = |sign: Sign| turns.contains(&Some(sign));
        if has(Sign::Positive) && has(Sign::Negative) {
            return Some(0);
        }
        let [Some(facing), Some(_), Some(_)] = turns else { return None };
        // below the plane, as the ray goes
        let (p, q, to) = (places[1] - places[0], places[2] - places[0], ray.from - places[0]);
        let normal = p.cross(q);
        let height = normal.dot(to);
        let off = p.abs().element_sum() + q.abs().element_sum();
        let bound = 8.0 * self.slack * (normal.abs().element_sum() + off * to.abs().element_sum() + off * self.slack);
        if height.abs() <= bound {
            return None;
        }
        let comes_out = (facing == Sign::Positive) == ray.is_ascending;
        let is_ahead = (height < 0.0) == comes_out;
        Some(i32::from(is_ahead) * if comes_out { 1 } else { -1 })
    }
}
