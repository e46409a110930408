//! How finely curves are cut: `$fn`, `$fa` and `$fs`, as OpenSCAD 2021.01 reads them.
//!
//! Source: the OpenSCAD User Manual, "Special variables", and the lengths of a helix and of Archimedes' spiral.

use planecut_kernel::DVec2;
use planecut_shapes::primitives::MAX_SEGMENTS;

use super::arguments::Arguments;

/// Radii below this are points: OpenSCAD's grid, 2⁻²⁰.
const POINT: f64 = 1.0 / (1u64 << 20) as f64;
/// Least `$fa` and `$fs`.
const LEAST: f64 = 0.01;

/// The three special variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fragments {
    /// `$fn`: segments of a whole turn, where it is above 0.
    count: f64,
    /// `$fa`: least angle of a segment in degrees.
    angle: f64,
    /// `$fs`: least length of a segment.
    length: f64,
}

/// A number of segments or slices beyond what is accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooMany(pub(super) f64);

impl Fragments {
    pub(super) fn of(arguments: &Arguments<'_, '_>) -> Self {
        let least = |name, other| f64::max(arguments.number_or(name, other), LEAST);
        Self { count: arguments.number_or("$fn", 0.0), angle: least("$fa", 12.0), length: least("$fs", 2.0) }
    }

    /// The segments of a circle.
    pub(super) fn around(&self, radius: f64) -> Result<u32, TooMany> {
        self.exact_around(radius).and_then(accepted)
    }

    /// The number of segments of an arc of `degrees`, rounded down.
    pub(super) fn along_arc(&self, radius: f64, degrees: f64) -> Result<u32, TooMany> {
        let whole = self.exact_around(radius)?;
        accepted((whole * degrees.abs() / 360.0).floor().max(1.0))
    }

    fn exact_around(&self, radius: f64) -> Result<f64, TooMany> {
        if radius < POINT || self.is_unusable() {
            return Ok(3.0);
        }
        if self.count > 0.0 {
            return Ok(self.count.floor().max(3.0));
        }
        let by_length = radius * std::f64::consts::TAU / self.length;
        Ok((360.0 / self.angle).min(by_length).max(5.0).ceil())
    }

    fn is_unusable(&self) -> bool {
        self.count.is_infinite() || self.count.is_nan()
    }

    /// The slices of a twisted extrusion whose outline reaches as far as `radius` from the axis.
    pub(super) fn twisted(&self, radius: f64, height: f64, twist: f64, scale: DVec2) -> Result<u32, TooMany> {
        let twist = twist.abs();
        // half a turn in a slice would pass through the axis; this is the least that OpenSCAD takes
        let least = (twist / 120.0).ceil().max(1.0);
        if radius < POINT || self.is_unusable() {
            return accepted(least);
        }
        if self.count > 0.0 {
            return accepted((twist / 360.0 * self.count).ceil().max(least));
        }
        let is_cone = scale.x == scale.y && scale.x != 1.0;
        let path = if is_cone {
            spiral(radius, height, twist.to_radians(), scale.x)
        } else {
            helix(radius, height, twist.to_radians())
        };
        let (by_angle, by_length) = ((twist / self.angle).ceil(), (path / self.length).ceil());
        accepted(by_angle.min(by_length).max(least))
    }

    /// The slices of an extrusion that is stretched unevenly and not twisted; no corner moves farther than `shift`.
    pub(super) fn stretched(&self, shift: f64, height: f64) -> Result<u32, TooMany> {
        if shift < POINT || self.is_unusable() {
            return Ok(1);
        }
        if self.count > 0.0 {
            return accepted(self.count.floor().max(1.0));
        }
        accepted((shift.hypot(height) / self.length).ceil().max(1.0))
    }
}

fn accepted(count: f64) -> Result<u32, TooMany> {
    if count <= f64::from(MAX_SEGMENTS) { Ok(count as u32) } else { Err(TooMany(count)) }
}

/// The length of a helix.
fn helix(radius: f64, height: f64, turn: f64) -> f64 {
    (turn * radius).hypot(height)
}

/// The length of a path on a cone whose radius changes by a factor: a part of Archimedes' spiral, and the height.
fn spiral(radius: f64, height: f64, turn: f64, factor: f64) -> f64 {
    // the angles from the tip of the cone at which the part begins and ends
    let far = if factor > 1.0 { turn * factor / (factor - 1.0) } else { turn / (1.0 - factor) };
    let near = far - turn;
    let length = |angle: f64| 0.5 * (angle * (1.0 + angle * angle).sqrt() + angle.asinh());
    (radius / far * (length(far) - length(near))).hypot(height)
}
