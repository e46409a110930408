//! Bodies of a few planes that are given outright.

use planecut_csg::{Brush, MaterialId};
use planecut_kernel::{DVec3, HalfSpace};

use crate::parameter::{ShapeError, point, positive, refuse};
use crate::tolerances::NEGLIGIBLE_COMPONENT;

/// The box between two corners, for corners that a user gives: what [`Brush::cuboid`] takes as empty or panics at is an error here.
///
/// # Errors
/// [`ShapeError::Parameter`] where a minimum is not below its maximum, or a coordinate is not accepted.
pub fn cuboid(min: impl Into<DVec3>, max: impl Into<DVec3>, material: MaterialId) -> Result<Brush, ShapeError> {
    let (min, max) = (min.into(), max.into());
    let (min, max) = (point("min", min)?, point("max", max)?);
    for axis in 0..3 {
        if min[axis] >= max[axis] {
            let name = ["x", "y", "z"][axis];
            return Err(refuse(
                "max",
                &format!("{name} = {}", max[axis]),
                &format!("more than {}, that of min", min[axis]),
            ));
        }
    }
    Ok(Brush::cuboid(min, max, material))
}

/// The half of the box from the origin to `size` that lies below the plane through its edges `x = 0, z = size.z` and
/// `x = size.x, z = 0`.
///
/// # Errors
/// [`ShapeError::Parameter`] where a size is not above 0.
pub fn wedge(size: impl Into<DVec3>, material: MaterialId) -> Result<Brush, ShapeError> {
    let size = size.into();
    let [x, y, z] = size.to_array();
    let (x, y, z) = (positive("size", x)?, positive("size", y)?, positive("size", z)?);
    let slope = exact_or_scaled_slope(x, z);
    brush([(-DVec3::X, 0.0), (-DVec3::Y, 0.0), (DVec3::Y, y), (-DVec3::Z, 0.0), slope], material)
}

/// The plane through `(x, ·, 0)` and `(0, ·, z)`.
fn exact_or_scaled_slope(x: f64, z: f64) -> (DVec3, f64) {
    (DVec3::new(z, 0.0, x), x * z)
}

/// All points with `normal·x ≤ offset`; not bounded.
///
/// # Errors
/// [`ShapeError::HalfSpace`] where the numbers are not accepted.
pub fn half_space(normal: impl Into<DVec3>, offset: f64, material: MaterialId) -> Result<Brush, ShapeError> {
    let normal = normal.into();
    body_of_half_spaces(&[(normal, offset)], material)
}

/// All points with `normal·x ≤ offset` for each pair; may be unbounded or empty.
///
/// # Errors
/// [`ShapeError::HalfSpace`] where the numbers of a half-space are not accepted.
pub fn body_of_half_spaces(half_spaces: &[(DVec3, f64)], material: MaterialId) -> Result<Brush, ShapeError> {
    let accepted = half_spaces.iter().enumerate().map(|(index, (normal, offset))| {
        HalfSpace::new(*normal, *offset).map_err(|error| ShapeError::HalfSpace { index, error })
    });
    let accepted = accepted.collect::<Result<Vec<HalfSpace>, ShapeError>>()?;
    Ok(Brush::from_half_spaces(accepted, material))
}

/// The convex hull of points, as [`planecut_kernel::hull`] makes it: it contains every point, exactly, and its planes are
/// exact where their coefficients fit.
///
/// # Errors
/// [`ShapeError::Hull`] where a point is not accepted or the hull has no interior.
pub fn hull_of_points<P: Into<DVec3> + Copy>(points: &[P], material: MaterialId) -> Result<Brush, ShapeError> {
    let polytope = planecut_kernel::hull(points)?;
    let faces = polytope.facets().into_iter().filter_map(|(plane, _)| polytope.plane(plane).copied());
    Ok(Brush::from_half_spaces(faces, material))
}

/// A brush of planes that follow from accepted parameters.
pub(super) fn brush(planes: impl IntoIterator<Item = (DVec3, f64)>, material: MaterialId) -> Result<Brush, ShapeError> {
    let half_spaces = planes.into_iter().map(|(normal, offset)| plane(normal, offset));
    Ok(Brush::from_half_spaces(half_spaces.collect::<Result<Vec<HalfSpace>, ShapeError>>()?, material))
}

/// A half-space; what is mere rounding noise beside the rest becomes zero.
pub(crate) fn plane(normal: DVec3, offset: f64) -> Result<HalfSpace, ShapeError> {
    let noise = normal.abs().max_element() * NEGLIGIBLE_COMPONENT;
    let normal = DVec3::from_array(normal.to_array().map(|v| if v.abs() < noise { 0.0 } else { v }));
    let offset = if offset.abs() < noise { 0.0 } else { offset };
    Ok(HalfSpace::new(normal, offset)?)
}
