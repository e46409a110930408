//! A closed half-space `n·x ≤ d`, checked once at the boundary.

use glam::DVec3;
use thiserror::Error;

/// Largest accepted magnitude of a normal component (`2^400`).
pub const MAX_NORMAL: f64 = f64::from_bits((1023 + 400) << 52);
/// Smallest accepted magnitude of a normal's largest component (`2^-400`).
pub const MIN_NORMAL: f64 = f64::from_bits((1023 - 400) << 52);
/// A non-zero normal component may be at most `2^200` times smaller than the largest one.
pub const MAX_NORMAL_RATIO: f64 = f64::from_bits((1023 + 200) << 52);
/// A non-zero offset may be at most `2^200` times larger or smaller than the largest normal component.
pub const MAX_OFFSET_RATIO: f64 = f64::from_bits((1023 + 200) << 52);

/// Why a plane was not accepted. `normal.to_array()` gives the three numbers without naming `glam`.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HalfSpaceError {
    /// A coefficient is NaN or infinite.
    #[error("plane coefficients must be finite, found normal {normal} and offset {offset}")]
    NotFinite {
        /// The normal that was given.
        normal: DVec3,
        /// The offset that was given.
        offset: f64,
    },
    /// The normal is the zero vector.
    #[error("the normal of a plane must not be zero")]
    ZeroNormal,
    /// A coefficient is outside the accepted range.
    #[error("plane coefficients outside the accepted range: normal {:?}, offset {offset:?}", .normal.to_array())]
    OutOfRange {
        /// The normal that was given.
        normal: DVec3,
        /// The offset that was given.
        offset: f64,
    },
}

/// The closed half-space `normal·x ≤ offset`; the normal points out of the body and need not have unit length.
///
/// # Guarantees
/// All coefficients are finite, the normal is not zero, and the magnitudes are within the accepted range
/// ([`MIN_NORMAL`], [`MAX_NORMAL`], [`MAX_NORMAL_RATIO`], [`MAX_OFFSET_RATIO`]): inside it no product that a sign forms under- or overflows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "[f64; 4]", into = "[f64; 4]"))]
pub struct HalfSpace {
    /// The normal and the offset.
    coefficients: [f64; 4],
}

impl HalfSpace {
    /// The half-space `normal·x ≤ offset`.
    ///
    /// # Errors
    /// [`HalfSpaceError`] where a coefficient is not finite, the normal is zero, or the magnitudes are out of range.
    ///
    /// ```
    /// use planecut_kernel::HalfSpace;
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let half_space = HalfSpace::new([0.0, 0.0, 2.0], 3.0)?;
    /// assert_eq!(half_space.normal().to_array(), [0.0, 0.0, 2.0]);
    /// # Ok(())
    /// # }
    /// ```
    pub fn new(normal: impl Into<DVec3>, offset: f64) -> Result<Self, HalfSpaceError> {
        Self::checked(normal.into(), offset)
    }

    /// The half-space `nx·x + ny·y + nz·z ≤ d` of the four numbers `[nx, ny, nz, d]`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    ///
    /// ```
    /// use planecut_kernel::{HalfSpace, HalfSpaceError};
    ///
    /// # fn main() -> Result<(), HalfSpaceError> {
    /// assert_eq!(HalfSpace::from_array([1.0, 2.0, 3.0, 4.0])?.to_array(), [1.0, 2.0, 3.0, 4.0]);
    /// assert_eq!(HalfSpace::from_array([0.0, 0.0, 0.0, 4.0]), Err(HalfSpaceError::ZeroNormal));
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_array([nx, ny, nz, d]: [f64; 4]) -> Result<Self, HalfSpaceError> {
        Self::checked(DVec3::new(nx, ny, nz), d)
    }

    fn checked(normal: DVec3, offset: f64) -> Result<Self, HalfSpaceError> {
        if !normal.is_finite() || !offset.is_finite() {
            return Err(HalfSpaceError::NotFinite { normal, offset });
        }
        let largest = normal.abs().max_element();
        if largest == 0.0 {
            return Err(HalfSpaceError::ZeroNormal);
        }
        let too_small = |v: f64, ratio: f64| v != 0.0 && v.abs() * ratio < largest;
        let out_of_range = !(MIN_NORMAL..=MAX_NORMAL).contains(&largest)
            || normal.to_array().into_iter().any(|v| too_small(v, MAX_NORMAL_RATIO))
            || too_small(offset, MAX_OFFSET_RATIO)
            || offset.abs() > largest * MAX_OFFSET_RATIO;
        if out_of_range {
            return Err(HalfSpaceError::OutOfRange { normal, offset });
        }
        Ok(Self { coefficients: [normal.x, normal.y, normal.z, offset] })
    }

    /// The outward normal, as given (not normalised).
    #[inline]
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        let [x, y, z, _] = self.coefficients;
        DVec3::new(x, y, z)
    }

    /// The offset `d` of `n·x ≤ d`, as given.
    #[inline]
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.coefficients[3]
    }

    /// The four numbers `[nx, ny, nz, d]`, as given.
    #[inline]
    #[must_use]
    pub fn to_array(&self) -> [f64; 4] {
        self.coefficients
    }

    /// The four numbers `[nx, ny, nz, d]`, where they are.
    #[inline(always)]
    pub(crate) fn coefficients(&self) -> &[f64; 4] {
        &self.coefficients
    }

    /// The half-space of numbers that are those of one, scaled or with its sides exchanged: within the accepted range.
    #[inline(always)]
    pub(crate) fn of_valid(coefficients: [f64; 4]) -> Self {
        debug_assert!(Self::from_array(coefficients).is_ok());
        Self { coefficients }
    }

    /// The complement's closure, `-n·x ≤ -d`.
    #[inline]
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self { coefficients: self.coefficients.map(|v| -v) }
    }

    /// Signed Euclidean distance of a point from the plane, positive outside. For display, never for decisions.
    #[must_use]
    pub fn signed_distance(&self, point: impl Into<DVec3>) -> f64 {
        (self.normal().dot(point.into()) - self.offset()) / self.normal().length()
    }
}

impl TryFrom<[f64; 4]> for HalfSpace {
    type Error = HalfSpaceError;

    fn try_from(coefficients: [f64; 4]) -> Result<Self, HalfSpaceError> {
        Self::from_array(coefficients)
    }
}

impl From<HalfSpace> for [f64; 4] {
    fn from(half_space: HalfSpace) -> Self {
        half_space.to_array()
    }
}
