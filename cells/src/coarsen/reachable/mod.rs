//! Where a ball can go that comes from outside, and what it covers there: space that colliders must leave open.
//!
//! A grid of voxels is laid around the solid: [`voxelize`] finds those that the surface touches, [`distance`] those where the middle of the ball may be, [`flood`]
//! which of these are connected to the outside, and [`distance`] again what the ball covers from there. Bodies are held against that exactly ([`octree`]).
//!
//! **Why nothing is left out.** Let `s` be the step of the grid, `d` the diagonal of a voxel, `√3·s`, `r` the radius and `t` the tolerance. If the ball may be
//! around a point, no point of the surface is nearer than `r` to it, so the middles of its voxel and of any that the surface touches are at least `r − d` apart; such voxels are
//! free. Points of a path that the ball takes are in voxels beside each other. What is within `r − t` of such a point is in a voxel whose middle is within
//! `r − t + d` of that of a free voxel that was reached; these are kept clear.
//! **Why it can be kept clear.** A voxel that the surface touches is at least `r − d` from a free one, in middles, so all points of a voxel that is kept clear are farther than
//! `(r − d) − (r − t + d) − d = t − 3d` from the surface. That is more than nothing where `t` is 6 steps, [`TOLERANCE_STEPS`].

mod distance;
mod flood;
mod grid;
mod octree;
mod voxelize;

use planecut_csg::stages::Bounds;
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};

use super::CoarsenError;
use super::hull::{Hull, sides_of};
use super::part::{bounds_of, built};
use super::probes::unit_planes;
use super::subtract::shares_interior;
use crate::tolerances::CLEAR_TOUCHING;
use distance::near;
use flood::flooded;
use grid::Grid;
use octree::{Body, Octree};
use voxelize::{fill, touched};

/// The tolerance in steps of the grid: more than `3·√3`.
const TOLERANCE_STEPS: f64 = 6.0;
/// Steps of the grid in a radius, at most and at least: the tolerance is a quarter of the radius at best, and all of it at worst.
const STEPS: (f64, f64) = (24.0, 6.0);
/// Maximum number of steps from a surface to the middle of the ball: squares of distances are numbers of 15 bits.
const MOST_STEPS: f64 = 180.0;
/// Maximum number of voxels, as long as there are that many steps in a radius, and with fewest steps.
const MOST_VOXELS: (f64, f64) = ((1_u32 << 25) as f64, (1_u32 << 27) as f64);

/// What a ball covers that rolls in from outside.
#[derive(Debug, Clone)]
pub(super) struct Reachable {
    octree: Octree,
    /// By how much less than its radius the ball covers.
    pub(super) tolerance: f64,
}

impl Reachable {
    /// What a ball of a radius can reach around a surface with thickness `2·half`, and around points that are filled although the surface has openings there.
    ///
    /// # Errors
    /// [`CoarsenError::Radius`] for one that is too small for the size of the surface, or for its thickness.
    pub(super) fn new(
        triangles: &[[DVec3; 3]],
        half: f64,
        radius: f64,
        is_filled: Option<&(dyn Fn(DVec3) -> bool + Sync)>,
    ) -> Result<Self, CoarsenError> {
        let bounds = triangles.iter().fold(Bounds::EMPTY, |all, triangle| all.union(&bounds_of(triangle)));
        let step = step_for(&bounds, half, radius).ok_or_else(|| too_small(&bounds, half, radius))?;
        let grid = Grid::around(&bounds, step, margin(half, radius, step));
        let tolerance = TOLERANCE_STEPS * step;
        let diagonal = 3.0_f64.sqrt();
        // squares of distances in steps are integers
        let from_surface = ((radius + half) / step - diagonal).powi(2).ceil() as i16;
        let from_middle = ((radius - tolerance) / step + diagonal).powi(2).floor() as i16;
        let mut solid = touched(&grid, triangles);
        if let Some(is_filled) = is_filled {
            fill(&mut solid, &grid, is_filled);
        }
        let free = near(&solid, from_surface - 1).complement();
        let covered = near(&flooded(&free), from_middle);
        Ok(Self { octree: Octree::new(grid, covered), tolerance })
    }

    /// Whether a body keeps out of all of it, exactly.
    pub(super) fn allows(&self, body: &IncrementalPolytope) -> bool {
        let half_spaces: Vec<HalfSpace> = body.planes().map(|(_, plane)| *plane).collect();
        let bounds = bounds_of(&body.to_mesh().0);
        let planes = unit_planes(&half_spaces);
        let body_about = Body { planes: &planes, bounds: &bounds };
        self.octree.covers(&bounds)
            && !self.octree.meets(&body_about, &mut |bounds| shares_interior(body, &to_half_spaces(sides_of(bounds))))
    }

    /// Whether a trial hull keeps out of all of it by more than rounding.
    pub(super) fn allows_hull(&self, hull: &Hull) -> bool {
        let margin = CLEAR_TOUCHING * hull.size();
        let bounds = Bounds { min: hull.bounds.min - margin, max: hull.bounds.max + margin };
        let planes: Vec<(DVec3, f64)> = hull.planes.iter().map(|(normal, offset)| (*normal, offset + margin)).collect();
        let body = Body { planes: &planes, bounds: &bounds };
        self.octree.covers(&bounds)
            && !self.octree.meets(&body, &mut |block| {
                let middle = block.center();
                planes.iter().all(|(normal, offset)| normal.dot(middle) < *offset)
                    || !built(to_half_spaces(planes.iter().copied().chain(sides_of(block)))).is_empty()
            })
    }
}

/// The half-spaces of planes that have some.
fn to_half_spaces(planes: impl Iterator<Item = (DVec3, f64)>) -> Vec<HalfSpace> {
    planes.filter_map(|(normal, offset)| HalfSpace::new(normal, offset).ok()).collect()
}

/// How many voxels the grid has beyond the surface: there all is free at its border.
fn margin(half: f64, radius: f64, step: f64) -> usize {
    ((radius + half) / step).ceil() as usize + 2
}

/// The finest step of a grid of not too many voxels; none where it is too coarse for the radius.
fn step_for(bounds: &Bounds, half: f64, radius: f64) -> Option<f64> {
    let ((most, least), (voxels, most_voxels)) = (STEPS, MOST_VOXELS);
    let count = |step: f64| Grid::count_around(bounds, step, margin(half, radius, step));
    let (mut step, coarsest) = ((radius / most).max((radius + half) / MOST_STEPS), radius / least);
    while step < coarsest {
        if count(step) <= voxels {
            return Some(step);
        }
        step *= 1.0 + 1.0 / 32.0;
    }
    (step <= 2.0 * coarsest && count(coarsest) <= most_voxels).then_some(coarsest)
}

/// Says which radius would do.
fn too_small(bounds: &Bounds, half: f64, radius: f64) -> CoarsenError {
    let mut accepted = radius;
    while accepted.is_finite() && step_for(bounds, half, accepted).is_none() {
        accepted *= 1.0 + 1.0 / 32.0;
    }
    CoarsenError::Radius { found: radius, least: accepted }
}

#[cfg(test)]
mod tests;
