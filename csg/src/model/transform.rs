//! Affine maps of planes and points.

use crate::tolerances::{NEGLIGIBLE_COMPONENT, SINGULAR_DETERMINANT};
use glam::{DMat3, DVec3};
use planecut_kernel::{HalfSpace, HalfSpaceError};
use thiserror::Error;

/// Why a matrix, or a plane that it moves, was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum TransformError {
    /// An entry is NaN or infinite.
    #[error("the entries of a matrix must be finite")]
    NotFinite,
    /// The map is flat: its determinant is zero, or too near to zero to tell.
    #[error("the matrix is singular: it flattens what it is applied to")]
    Singular,
    /// A plane leaves the accepted range.
    #[error("a plane that the matrix is applied to leaves the accepted range: {0}")]
    OutOfRange(#[from] HalfSpaceError),
}

/// An invertible affine map `x ↦ A x + t`.
///
/// # Guarantees
/// All entries are finite and `A` has full rank.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::saved::SavedTransform", into = "super::saved::SavedTransform"))]
pub struct Transform {
    linear: DMat3,
    translation: DVec3,
    /// What normals are multiplied by: the cofactors of `A`, times the sign of its determinant. No division, so a matrix of
    /// small integers moves planes of small integers without rounding.
    cofactors: DMat3,
    /// The magnitude of the determinant.
    determinant: f64,
}

impl Transform {
    /// The map `x ↦ linear x + translation`.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`] and [`TransformError::Singular`].
    pub fn new(linear: DMat3, translation: impl Into<DVec3>) -> Result<Self, TransformError> {
        let translation = translation.into();
        if !linear.is_finite() || !translation.is_finite() {
            return Err(TransformError::NotFinite);
        }
        let [a, b, c] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let determinant = a.dot(b.cross(c));
        let size = a.length() * b.length() * c.length();
        if !determinant.is_finite() || determinant.abs() <= SINGULAR_DETERMINANT * size {
            return Err(TransformError::Singular);
        }
        let cofactors = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)) * determinant.signum();
        Ok(Self { linear, translation, cofactors, determinant: determinant.abs() })
    }

    /// The map `x ↦ A x + t` by the columns of `A`, and then `t`: what each axis goes to, and the origin.
    ///
    /// ```
    /// use planecut_csg::Transform;
    ///
    /// let turn = Transform::from_columns([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [5.0, 0.0, 0.0]]);
    /// assert_eq!(turn.map(|turn| turn.point([2.0, 0.0, 0.0]).to_array()), Ok([5.0, 2.0, 0.0]));
    /// ```
    ///
    /// # Errors
    /// As for [`Transform::new`].
    pub fn from_columns([x, y, z, translation]: [[f64; 3]; 4]) -> Result<Self, TransformError> {
        Self::new(DMat3::from_cols_array_2d(&[x, y, z]), translation)
    }

    /// Nothing moves.
    #[must_use]
    pub fn identity() -> Self {
        Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO, cofactors: DMat3::IDENTITY, determinant: 1.0 }
    }

    /// A shift.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`].
    pub fn translation(by: impl Into<DVec3>) -> Result<Self, TransformError> {
        Self::new(DMat3::IDENTITY, by)
    }

    /// A stretch along the axes; negative factors mirror.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`], and [`TransformError::Singular`] for a factor of zero.
    pub fn scale(factors: impl Into<DVec3>) -> Result<Self, TransformError> {
        Self::new(DMat3::from_diagonal(factors.into()), DVec3::ZERO)
    }

    /// A turn about an axis through the origin by an angle in degrees, counter-clockwise seen against the axis. Multiples of
    /// 90° about the coordinate axes are exact.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`], and [`TransformError::Singular`] for an axis of length zero.
    pub fn rotation(axis: impl Into<DVec3>, degrees: f64) -> Result<Self, TransformError> {
        let Some(axis) = axis.into().try_normalize() else { return Err(TransformError::Singular) };
        let (sine, cosine) = sine_and_cosine(degrees);
        let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        let cross = DMat3::from_cols(
            DVec3::new(0.0, axis.z, -axis.y),
            DVec3::new(-axis.z, 0.0, axis.x),
            DVec3::new(axis.y, -axis.x, 0.0),
        );
        Self::new(DMat3::IDENTITY * cosine + cross * sine + outer * (1.0 - cosine), DVec3::ZERO)
    }

    /// The mirror image in the plane through the origin with this normal.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`], and [`TransformError::Singular`] for a normal of length zero.
    pub fn mirror(normal: impl Into<DVec3>) -> Result<Self, TransformError> {
        let Some(n) = normal.into().try_normalize() else { return Err(TransformError::Singular) };
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        Self::new(DMat3::IDENTITY - outer * 2.0, DVec3::ZERO)
    }

    /// The mirror image in a plane, of which either side may be given. For planes across an axis no entry is rounded but the shift, which is once.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`] where products leave the range of numbers.
    pub fn mirror_at(plane: &HalfSpace) -> Result<Self, TransformError> {
        // a power of two takes the length away from where products leave the range
        let size = plane.normal().abs().max_element();
        let scale = f64::from_bits(size.to_bits() & (0x7ff << 52));
        let (n, offset) = (plane.normal() / scale, plane.offset() / scale);
        let square = n.length_squared();
        let column = |of: f64| (2.0 * of * n) / square;
        let linear = DMat3::IDENTITY - DMat3::from_cols(column(n.x), column(n.y), column(n.z));
        let shift =
            n.to_array().map(|of| if of * of == square { 2.0 * offset / of } else { 2.0 * offset * of / square });
        Self::new(linear, DVec3::from_array(shift))
    }

    /// This map, and then `next`.
    ///
    /// # Errors
    /// [`TransformError::NotFinite`] and [`TransformError::Singular`], where products leave the range of numbers.
    pub fn then(&self, next: &Self) -> Result<Self, TransformError> {
        Self::new(next.linear * self.linear, next.linear * self.translation + next.translation)
    }

    /// The matrix `A`.
    #[must_use]
    pub fn linear(&self) -> DMat3 {
        self.linear
    }

    /// The shift `t`.
    #[must_use]
    pub fn offset(&self) -> DVec3 {
        self.translation
    }

    /// Where a point goes.
    #[must_use]
    pub fn point(&self, point: impl Into<DVec3>) -> DVec3 {
        let point = point.into();
        self.linear * point + self.translation
    }

    /// Where the gradient of a function goes that is linear in space: what it says of a point it says of where the point goes.
    #[must_use]
    pub fn gradient(&self, gradient: DVec3) -> DVec3 {
        self.cofactors * gradient / self.determinant
    }

    /// Where a half-space goes: its coefficients rounded once or twice, exact where they are small integers.
    ///
    /// # Errors
    /// [`TransformError::OutOfRange`].
    pub fn half_space(&self, half_space: &HalfSpace) -> Result<HalfSpace, TransformError> {
        let normal = self.cofactors * half_space.normal();
        let offset = half_space.offset() * self.determinant + normal.dot(self.translation);
        Ok(HalfSpace::new(clean(normal), offset)?)
    }
}

/// Components that are mere rounding noise of the others become zero, so that they stay within the accepted range.
fn clean(normal: DVec3) -> DVec3 {
    let noise = normal.abs().max_element() * NEGLIGIBLE_COMPONENT;
    DVec3::from_array(normal.to_array().map(|v| if v.abs() < noise { 0.0 } else { v }))
}

/// Sine and cosine of an angle in degrees, exact for multiples of 30° where the value is.
#[must_use]
pub fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0).floor();
    let rest = turn - 90.0 * quadrant;
    let (sine, cosine) = match rest {
        0.0 => (0.0, 1.0),
        30.0 => (0.5, 0.75_f64.sqrt()),
        45.0 => (0.5_f64.sqrt(), 0.5_f64.sqrt()),
        60.0 => (0.75_f64.sqrt(), 0.5),
        _ => rest.to_radians().sin_cos(),
    };
    match quadrant {
        0.0 | 4.0 => (sine, cosine),
        1.0 => (cosine, -sine),
        2.0 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_and_shifts_by_short_numbers_are_exact() {
        let turn = Transform::rotation(DVec3::Z, 90.0).expect("a turn");
        let shift = Transform::translation(DVec3::new(1.0, 2.0, 3.0)).expect("a shift");
        let both = turn.then(&shift).expect("a motion");
        let plane = HalfSpace::new(DVec3::new(3.0, -4.0, 5.0), 7.0).expect("a plane");
        let moved = both.half_space(&plane).expect("in range");
        // (x, y, z) ↦ (1 − y, 2 + x, 3 + z)
        assert_eq!((moved.normal(), moved.offset()), (DVec3::new(4.0, 3.0, 5.0), 7.0 + 4.0 + 6.0 + 15.0));
    }

    #[test]
    fn a_plane_moves_with_its_points_even_when_mirrored() {
        let map = Transform::new(
            DMat3::from_cols(DVec3::new(1.0, 0.5, -2.0), DVec3::new(0.25, -3.0, 1.0), DVec3::new(4.0, 0.0, 1.5)),
            DVec3::new(-7.0, 0.5, 2.0),
        )
        .expect("a map");
        let plane = HalfSpace::new(DVec3::new(1.0, 2.0, -1.0), 3.0).expect("a plane");
        let moved = map.half_space(&plane).expect("in range");
        for (point, side) in [(DVec3::new(3.0, 0.0, 0.0), 0.0), (DVec3::ZERO, -1.0), (DVec3::new(9.0, 9.0, 0.0), 1.0)] {
            let distance = moved.signed_distance(map.point(point));
            assert!(distance.abs() < 1e-12 && side == 0.0 || distance * side > 1e-3, "{point} {distance}");
        }
    }

    #[test]
    fn flat_maps_are_refused() {
        let flat = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::X + DVec3::Y);
        assert_eq!(Transform::new(flat, DVec3::ZERO), Err(TransformError::Singular));
        assert_eq!(Transform::scale(DVec3::new(1.0, 0.0, 1.0)), Err(TransformError::Singular));
        assert_eq!(Transform::translation(DVec3::NAN), Err(TransformError::NotFinite));
    }
}
