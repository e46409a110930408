//! Where no cell may grow: regions that are given, and what a ball can reach.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::{HalfSpace, IncrementalPolytope};

use super::CoarsenError;
use super::hull::Hull;
use super::part::{Part, bounds_of, boxes_of, built};
use super::reachable::Reachable;
use super::subtract::{shares_interior, subtract};
use crate::tolerances::CLEAR_TOUCHING;

/// What is to stay clear.
#[derive(Debug, Default)]
pub(super) struct Clear {
    /// Convex regions in which there is nothing of the solid.
    regions: Vec<Part>,
    boxes: Boxes,
    reachable: Option<Reachable>,
}

impl Clear {
    /// Regions without what the parts of a solid fill of them already, and what a ball can reach.
    pub(super) fn around(
        parts: &[Part],
        boxes: &Boxes,
        regions: &[Part],
        reachable: Option<Reachable>,
    ) -> Result<Self, CoarsenError> {
        let mut clear = Vec::new();
        for region in regions {
            let mut near = Vec::new();
            boxes.touching(&region.bounds, &mut near);
            let filling: Vec<&Part> = near.iter().map(|part| &parts[*part as usize]).collect();
            for piece in subtract(&region.polytope, &filling) {
                clear.extend(Part::of_polytope(piece, region.material)?);
            }
        }
        Ok(Self { boxes: boxes_of(&clear), regions: clear, reachable })
    }

    /// The regions whose boxes touch a box.
    pub(super) fn near(&self, bounds: &Bounds) -> impl Iterator<Item = &Part> {
        let mut near = Vec::new();
        self.boxes.touching(bounds, &mut near);
        near.into_iter().map(|region| &self.regions[region as usize])
    }

    /// Whether cells may grow anywhere.
    pub(super) fn is_empty(&self) -> bool {
        self.regions.is_empty() && self.reachable.is_none()
    }

    /// Whether there are regions.
    pub(super) fn has_regions(&self) -> bool {
        !self.regions.is_empty()
    }

    /// By how much less than its radius a ball covers what is kept clear of it.
    pub(super) fn tolerance(&self) -> Option<f64> {
        self.reachable.as_ref().map(|reachable| reachable.tolerance)
    }

    /// Whether a trial hull keeps out of regions, up to rounding, and of what a ball can reach.
    pub(super) fn allows_hull(&self, hull: &Hull) -> bool {
        let margin = CLEAR_TOUCHING * hull.size();
        let keeps_out = |region: &Part| {
            let shrunk =
                hull.planes.iter().filter_map(|(normal, offset)| HalfSpace::new(*normal, offset - margin).ok());
            built(region.half_spaces.iter().copied().chain(shrunk)).is_empty()
        };
        (self.regions.is_empty() || self.near(&hull.bounds).all(keeps_out))
            && self.reachable.as_ref().is_none_or(|reachable| reachable.allows_hull(hull))
    }

    /// Whether a body keeps out of all of it, exactly.
    pub(super) fn allows(&self, body: &IncrementalPolytope) -> bool {
        let is_apart = |region: &Part| !shares_interior(body, &region.half_spaces);
        (self.regions.is_empty() || self.near(&bounds_of(&body.to_mesh().0)).all(is_apart))
            && self.reachable.as_ref().is_none_or(|reachable| reachable.allows(body))
    }
}
