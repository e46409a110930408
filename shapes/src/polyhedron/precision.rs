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

/// The most coordinates that are looked at to know how they were written.
const MOST_LOOKED_AT: usize = 4096;
/// A number of digits counts as deliberate where at least one coordinate in this many has it.
const SHARE: usize = 4;

impl Precision {
    /// How exactly coordinates look to be known, where no file tells: as single precision where all are, as decimals where they are short.
    #[must_use]
    pub fn of_coordinates(points: &[DVec3]) -> Self {
        let coordinates = || points.iter().flat_map(|point| point.to_array());
        let is_whole = |v: f64| v == v.trunc();
        if coordinates().all(is_whole) {
            return Self::Double;
        }
        if coordinates().all(|v| f64::from(v as f32) == v) {
            return Self::Single;
        }
        let some = || coordinates().step_by((3 * points.len()).div_ceil(MOST_LOOKED_AT).max(1)).map(decimals_of);
        let count = some().count();
        let (digits, places) = some().fold((0, 0), |(d, p), (digits, places)| (d.max(digits), p.max(places)));
        let is_shared = |has: &dyn Fn((u32, u32)) -> bool| SHARE * some().filter(|each| has(*each)).count() >= count;
        match digits {
            5..=6 if is_shared(&|(own, _)| own == digits) => Self::Digits(digits),
            _ if (4..=9).contains(&places) && is_shared(&|(_, own)| own == places) => Self::Places(places),
            7..=9 if is_shared(&|(own, _)| own == digits) => Self::Single,
            _ => Self::Double,
        }
    }

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

/// The significant digits of the shortest decimal that is this number, and how many of them are after the point.
fn decimals_of(v: f64) -> (u32, u32) {
    let text = format!("{v:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).count() as i32;
    let exponent: i32 = exponent.parse().unwrap_or(0);
    (digits as u32, (digits - 1 - exponent).max(0) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(coordinates: [f64; 6]) -> Precision {
        Precision::of_coordinates(&[DVec3::from_slice(&coordinates), DVec3::from_slice(&coordinates[3..])])
    }

    #[test]
    fn coordinates_tell_how_they_were_written() {
        assert_eq!(of([0.0, 1.0, -3.0, 7.0, 0.0, 1e6]), Precision::Double);
        assert_eq!(of([0.1f32, 1.7, -3.3, 7.0, 0.0, 0.7].map(f64::from)), Precision::Single);
        assert_eq!(of([0.123457, -12.3457, 1.23457e-7, 0.5, 0.0, 7.0]), Precision::Digits(6));
        assert_eq!(of([100.12345, -12.34567, 7.00001, 0.5, 0.0, 7.0]), Precision::Places(5));
        assert_eq!(of([0.1, 0.30000000000000004, 0.7, 1.0 / 3.0, 0.0, 7.0]), Precision::Double);
    }
}
