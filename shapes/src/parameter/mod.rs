//! Which parameters shapes accept, what is said of others, and directions on circles of segments.

mod circle;
mod error;

use std::fmt::{self, Display, Formatter};

use planecut_kernel::{DVec2, DVec3};

pub(crate) use circle::{apothem, direction, middle};
pub use error::ShapeError;

/// Largest accepted magnitude of a length or coordinate. Lengths must be at least its inverse; smaller coordinates are
/// taken for 0. Within it no plane of a shape leaves the range of a [`HalfSpace`](planecut_kernel::HalfSpace).
pub const MAX_LENGTH: f64 = 1e25;
/// Largest accepted number of segments of a circle.
pub const MAX_SEGMENTS: u32 = 10_000;
/// Largest number of convex pieces of one shape.
pub const MAX_PIECES: u64 = crate::polyhedron::MAX_CELLS;

pub(crate) fn refuse(parameter: &'static str, found: &dyn Display, expected: &dyn Display) -> ShapeError {
    ShapeError::Parameter { parameter, found: found.to_string(), expected: expected.to_string() }
}

/// A number in few digits, however large.
struct Shown(f64);

impl Display for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if (1e-5..1e16).contains(&self.0.abs()) || self.0 == 0.0 {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// A length above 0.
pub(crate) fn positive(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value > 0.0 { length(parameter, value) } else { Err(refuse(parameter, &Shown(value), &"a number above 0")) }
}

/// A length of 0 or above.
pub(crate) fn not_negative(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value == 0.0 {
        return Ok(0.0);
    }
    if value > 0.0 { length(parameter, value) } else { Err(refuse(parameter, &Shown(value), &"a number not below 0")) }
}

fn length(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    let is_accepted = (MAX_LENGTH.recip()..=MAX_LENGTH).contains(&value);
    if is_accepted { Ok(value) } else { Err(refuse(parameter, &Shown(value), &"a number from 1e-25 to 1e25")) }
}

/// A coordinate, or a length of either sign.
pub(crate) fn coordinate(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if !value.is_finite() {
        return Err(refuse(parameter, &value, &"a finite number"));
    }
    if value.abs() > MAX_LENGTH {
        return Err(refuse(parameter, &Shown(value), &"a number of a magnitude up to 1e25"));
    }
    Ok(if value.abs() < MAX_LENGTH.recip() { 0.0 } else { value })
}

/// An angle in degrees, at most as many turns as there can be segments.
pub(crate) fn angle(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    let limit = 360.0 * f64::from(MAX_SEGMENTS);
    let expected = format!("a number of a magnitude up to {limit}");
    if value.abs() <= limit { Ok(value) } else { Err(refuse(parameter, &Shown(value), &expected)) }
}

pub(crate) fn point(parameter: &'static str, point: DVec3) -> Result<DVec3, ShapeError> {
    let [x, y, z] = point.to_array();
    Ok(DVec3::new(coordinate(parameter, x)?, coordinate(parameter, y)?, coordinate(parameter, z)?))
}

pub(crate) fn planar_point(parameter: &'static str, point: DVec2) -> Result<DVec2, ShapeError> {
    Ok(DVec2::new(coordinate(parameter, point.x)?, coordinate(parameter, point.y)?))
}

/// The number of segments of a circle.
pub(crate) fn segments(parameter: &'static str, count: u32) -> Result<u32, ShapeError> {
    let expected = format!("a whole number from 3 to {MAX_SEGMENTS}");
    if (3..=MAX_SEGMENTS).contains(&count) { Ok(count) } else { Err(refuse(parameter, &count, &expected)) }
}

/// At most [`MAX_PIECES`].
pub(crate) fn pieces(count: u64) -> Result<(), ShapeError> {
    if count <= MAX_PIECES { Ok(()) } else { Err(ShapeError::TooLarge { found: count, limit: MAX_PIECES }) }
}
