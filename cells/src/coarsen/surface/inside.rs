//! What is inside of a surface.

use planecut_kernel::DVec3;

use super::super::probes::spread;
use super::extremes::Extremes;
use super::region::{Region, normal};
use super::solid_angles::SolidAngles;
use super::winding::Winding;

/// Points by which it is estimated how much of a box is inside.
const TRIED: usize = 128;
/// A sheet whose hull is thinner than this share of its thickness is flat.
const FLAT_SHARE: f64 = 0.25;
/// Parts of each edge of a box at whose ends it is seen whether it is inside.
const ALONG_EDGE: usize = 4;
/// How often such a part is halved to find where it leaves what is filled.
const HALVED: usize = 20;

/// Which side of a surface points are on.
pub(super) trait Inside: Sync {
    /// Whether a point is inside.
    fn holds(&self, point: DVec3) -> bool;
    /// The volume of what is inside of a box, about, and points inside that neither the surface nor the corners of the box tell of: where there is no surface
    /// between inside and outside.
    fn fills(&self, region: &Region) -> (f64, Vec<DVec3>);
    /// Whether faces have nothing on either side.
    fn is_thin(&self) -> bool {
        false
    }
}

/// What a closed surface goes around more than zero times.
pub(super) struct Solid<'a>(pub(super) Winding<'a>);

impl Inside for Solid<'_> {
    fn holds(&self, point: DVec3) -> bool {
        self.0.around(point) > 0
    }

    fn fills(&self, region: &Region) -> (f64, Vec<DVec3>) {
        (region.volume(), Vec::new())
    }
}

/// What a surface goes around more than half.
pub(super) struct Filled(pub(super) SolidAngles);

impl Inside for Filled {
    fn holds(&self, point: DVec3) -> bool {
        self.0.around(point) > 0.5
    }

    /// By points that are spread evenly over the box, the farthest of which are told, and by those on its edges where these leave the inside.
    fn fills(&self, region: &Region) -> (f64, Vec<DVec3>) {
        let size = region.high - region.low;
        let tried = (0..TRIED).map(|k| region.low + size * spread(k));
        let inside: Vec<DVec3> = tried.filter(|point| self.holds(*point)).collect();
        // some may be empty that no point has met
        let share = if region.polygons.is_empty() { 1.0 } else { 1.0 - 1.0 / TRIED as f64 };
        let volume = share * size.element_product() * inside.len() as f64 / TRIED as f64;
        let mut points = Extremes::of(inside.into_iter()).points().to_vec();
        for (low, high) in region.edges() {
            let at = |k: usize| low.lerp(high, k as f64 / ALONG_EDGE as f64);
            let holds: [bool; ALONG_EDGE + 1] = std::array::from_fn(|k| self.holds(at(k)));
            for k in 0..ALONG_EDGE {
                match (holds[k], holds[k + 1]) {
                    (true, false) => points.push(self.last_inside(at(k), at(k + 1))),
                    (false, true) => points.push(self.last_inside(at(k + 1), at(k))),
                    _ => {}
                }
            }
        }
        (volume, points)
    }
}

impl Filled {
    /// The last point inside on the way from one inside to one outside.
    fn last_inside(&self, mut inner: DVec3, mut outer: DVec3) -> DVec3 {
        for _ in 0..HALVED {
            let middle = 0.5 * inner + 0.5 * outer;
            *(if self.holds(middle) { &mut inner } else { &mut outer }) = middle;
        }
        inner
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
    fn fills(&self, region: &Region) -> (f64, Vec<DVec3>) {
        let area: f64 = region.polygons.iter().map(|(corners, _)| normal(corners).length() / 2.0).sum();
        (FLAT_SHARE * self.thickness * area, Vec::new())
    }
}
