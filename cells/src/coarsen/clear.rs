//! Regions that no cell may grow into.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::IncrementalPolytope;

use super::CoarsenError;
use super::part::{Part, bounds_of, boxes_of};
use super::subtract::{shares_interior, subtract};

/// Convex regions in which there is nothing of the solid.
#[derive(Debug, Default)]
pub(super) struct Clear {
    regions: Vec<Part>,
    boxes: Boxes,
}

impl Clear {
    /// Regions without what the parts of a solid fill of them already.
    pub(super) fn around(parts: &[Part], boxes: &Boxes, regions: &[Part]) -> Result<Self, CoarsenError> {
        let mut clear = Vec::new();
        for region in regions {
            let mut near = Vec::new();
            boxes.touching(&region.bounds, &mut near);
            let filling: Vec<&Part> = near.iter().map(|part| &parts[*part as usize]).collect();
            for piece in subtract(&region.polytope, &filling) {
                clear.extend(Part::of_polytope(piece, region.material)?);
            }
        }
        Ok(Self { boxes: boxes_of(&clear), regions: clear })
    }

    /// The regions whose boxes touch a box.
    pub(super) fn near(&self, bounds: &Bounds) -> impl Iterator<Item = &Part> {
        let mut near = Vec::new();
        self.boxes.touching(bounds, &mut near);
        near.into_iter().map(|region| &self.regions[region as usize])
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.regions.is_empty()
    }

    /// Whether a body keeps out of all of them, exactly.
    pub(super) fn allows(&self, body: &IncrementalPolytope) -> bool {
        self.is_empty()
            || self.near(&bounds_of(&body.to_mesh().0)).all(|region| !shares_interior(body, &region.half_spaces))
    }
}
