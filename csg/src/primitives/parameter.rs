//! Which parameters are accepted.

use std::fmt::Display;

use planecut_kernel::{DVec2, DVec3};

use super::ShapeError;

/// Largest accepted magnitude of a length or coordinate; its inverse is the smallest one that is not zero. Within it no
/// plane of a shape leaves the range of a [`HalfSpace`](planecut_kernel::HalfSpace).
pub const MAX_LENGTH: f64 = 1e30;
/// Largest accepted number of segments of a circle.
pub const MAX_SEGMENTS: u32 = 10_000;
/// Largest number of convex pieces of one shape.
pub const MAX_PIECES: u64 = 4_194_304;

pub(crate) fn refuse(parameter: &'static str, found: &dyn Display, expected: &dyn Display) -> ShapeError {
    ShapeError::Parameter { parameter, found: found.to_string(), expected: expected.to_string() }
}

fn fits(value: f64) -> bool {
    value == 0.0 || (MAX_LENGTH.recip()..=MAX_LENGTH).contains(&value.abs())
}

/// A length above 0.
pub(crate) fn positive(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value > 0.0 { coordinate(parameter, value) } else { Err(refuse(parameter, &value, &"a number above 0")) }
}

/// A length of 0 or above.
pub(crate) fn not_negative(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value >= 0.0 { coordinate(parameter, value) } else { Err(refuse(parameter, &value, &"a number not below 0")) }
}

/// A coordinate, or a length of either sign.
pub(crate) fn coordinate(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if !value.is_finite() {
        return Err(refuse(parameter, &value, &"a finite number"));
    }
    let expected = "0 or a number of a magnitude between 1e-30 and 1e30";
    // adding zero turns −0 into 0
    if fits(value) { Ok(value + 0.0) } else { Err(refuse(parameter, &value, &expected)) }
}

pub(crate) fn finite(parameter: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value.is_finite() { Ok(value) } else { Err(refuse(parameter, &value, &"a finite number")) }
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
