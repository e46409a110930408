//! What is inside of a surface.

use planecut_kernel::DVec3;

use super::super::probes::spread;
use super::region::{Region, normal};
use super::solid_angles::SolidAngles;
use super::winding::Winding;

/// Points by which it is estimated how much of a box is inside.
const TRIED: usize = 128;
/// A sheet whose hull is thinner than this share of its thickness is flat.
const FLAT_SHARE: f64 = 0.25;
/// How often an edge of a box is halved to find where it leaves what is filled.
const HALVED: usize = 20;

/// Which side of a surface points are on.
pub(super) trait Inside: Sync {
    /// Whether a point is inside.
    fn holds(&self, point: DVec3) -> bool;
    /// The volume of what is inside of a box, about.
    fn volume_in(&self, region: &Region) -> f64;
    /// Whether faces have nothing on either side.
    fn is_thin(&self) -> bool {
        false
    }
    /// Where edges of a box leave the inside although there is no surface.
    fn open_points(&self, _: &Region) -> Vec<DVec3> {
        Vec::new()
    }
}

/// What a closed surface goes around more than zero times.
pub(super) struct Solid<'a>(pub(super) Winding<'a>);

impl Inside for Solid<'_> {
    fn holds(&self, point: DVec3) -> bool {
        self.0.around(point) > 0
    }

    fn volume_in(&self, region: &Region) -> f64 {
        region.volume()
    }
}

/// What a surface goes around more than half.
pub(super) struct Filled(pub(super) SolidAngles);

impl Inside for Filled {
    fn holds(&self, point: DVec3) -> bool {
        self.0.around(point) > 0.5
    }

    fn volume_in(&self, region: &Region) -> f64 {
        let size = region.high - region.low;
        let inside = (0..TRIED).filter(|k| self.holds(region.low + size * spread(*k))).count();
        // some may be empty that no point has met
        let share = if region.polygons.is_empty() { 1.0 } else { 1.0 - 1.0 / TRIED as f64 };
        share * size.element_product() * inside as f64 / TRIED as f64
    }

    /// Found by halves along each edge of the box that leads from inside to outside.
    fn open_points(&self, region: &Region) -> Vec<DVec3> {
        let mut points = Vec::new();
        for (from, to) in region.edges() {
            let (mut inner, mut outer) = (from, to);
            for _ in 0..HALVED {
                let middle = 0.5 * inner + 0.5 * outer;
                *(if self.holds(middle) { &mut inner } else { &mut outer }) = middle;
            }
            points.push(inner);
        }
        points
    }
}

/// Nothing.
pub(super) struct Shell {
    pub(super) thickness: f64,
}

impl Inside for Shell {
    fn holds(&self, _: DVec3) -> bool {
        false
    }

    fn is_thin(&self) -> bool {
        true
    }

    /// Some of what a sheet has anyway: between flatter ones than that nothing is empty.
    fn volume_in(&self, region: &Region) -> f64 {
        FLAT_SHARE
            * self.thickness
            * region.polygons.iter().map(|(corners, _)| normal(corners).length() / 2.0).sum::<f64>()
    }
}
