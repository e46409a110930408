//! Axis-aligned boxes around points.

use glam::DVec3;

/// The smallest and the largest coordinates of points; `None` where there are none.
pub(crate) fn box_around(points: impl Iterator<Item = DVec3>) -> Option<[DVec3; 2]> {
    points.map(|point| [point, point]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// The middle of a box. Halved before adding, so that no finite box overflows.
pub(crate) fn middle([min, max]: [DVec3; 2]) -> DVec3 {
    min * 0.5 + max * 0.5
}

/// The corners of a box; the bits of their numbers say at which end of each axis they lie.
pub(crate) fn box_corners([min, max]: [DVec3; 2]) -> [DVec3; 8] {
    let corner = |number: usize| DVec3::from([0, 1, 2].map(|axis| [min, max][number >> axis & 1][axis]));
    std::array::from_fn(corner)
}
