//! How exactly corners are known.

use crate::tolerances::{CORNER_NOISE, PLANE_MARGIN};
use planecut_kernel::DVec3;

/// How exactly the coordinates of a surface are known: corners that are this near to a plane count as on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Precision {
    /// Computed in `f64`.
    Double,
    /// Rounded to `f32`.
    Single,
    /// Decimals with this many significant digits.
    Digits(u32),
    /// Decimals with this many digits after the point.
    Places(u32),
}

impl Precision {
    /// How far each point may lie from planes that it is meant to be on.
    pub(super) fn slack(self, points: &[DVec3]) -> Vec<f64> {
        let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let of = |p: &DVec3| CORNER_NOISE * size + PLANE_MARGIN * self.rounding(p, size);
        points.iter().map(of).collect()
    }

    /// How far two coordinates are apart that were meant to be one and are rounded to neighbouring numbers, where they are largest.
    pub(super) fn between_neighbours(self, points: &[DVec3]) -> f64 {
        let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let rounding = points.iter().map(|p| self.rounding(p, size)).fold(0.0, f64::max);
        // the difference of neighbours is rounded, too
        2.0 * rounding * (1.0 + CORNER_NOISE) + 4.0 * f64::EPSILON * size
    }

    /// The largest rounding of a coordinate.
    fn rounding(self, point: &DVec3, size: f64) -> f64 {
        match self {
            Self::Double => 0.0,
            // tools that write single precision compute in it: coordinates are off by roundings of the largest
            Self::Single => 0.5 * f64::from(f32::EPSILON) * size,
            Self::Digits(digits) => point.to_array().map(|v| half_unit(v, digits)).into_iter().fold(0.0, f64::max),
            Self::Places(places) => 0.5 * 10f64.powi(-(places.min(300) as i32)),
        }
    }
}

/// Half a unit of the last of a number's significant digits.
fn half_unit(v: f64, digits: u32) -> f64 {
    if v == 0.0 { 0.0 } else { 0.5 * 10f64.powi(v.abs().log10().floor() as i32 + 1 - digits.min(300) as i32) }
}
