//! A meeting point of three planes: exact by name, and where it is in plain numbers.

use glam::DVec3;
use planecut_kernel::HalfSpace;
use planecut_kernel::sign::{Homogeneous, Sign};

use crate::base::Bounds;
use crate::ids::{BodyId, CornerId, Id};

/// Three products and three sums, each rounded, and more.
const PLANE_VALUE_BOUND: f64 = 8.0 * f64::EPSILON;

/// A plane that many corners are held against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneFilter {
    normal: DVec3,
    offset: f64,
    /// The sum of the normal's magnitudes.
    reach: f64,
    /// For the rounding of the offset.
    room: f64,
}

impl PlaneFilter {
    pub(crate) fn new(half_space: &HalfSpace) -> Self {
        let (normal, offset) = (half_space.normal(), half_space.offset());
        Self { normal, offset, reach: normal.abs().element_sum(), room: PLANE_VALUE_BOUND * offset.abs() }
    }

    /// The components of the normal, the offset, the sum of the normal's magnitudes, and room for the rounding of the offset.
    pub(crate) fn numbers(&self) -> [f64; 6] {
        [self.normal.x, self.normal.y, self.normal.z, self.offset, self.reach, self.room]
    }

    /// On which side of the plane a corner certainly is; zero where that is not certain.
    pub(crate) fn side(&self, corner: &Corner) -> Sign {
        let value = self.normal.dot(corner.at) - self.offset;
        let bound = self.reach * corner.error + self.room;
        if value > bound {
            Sign::Positive
        } else if value < -bound {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }
}

/// A meeting point of three planes that are known where it is used: what it lies beside is told by them where plain numbers leave it open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Where it is, rounded a few times.
    pub(crate) at: DVec3,
    /// How far off each coordinate may be, with room for the rounding of a dot product with the coordinates; infinite where
    /// nothing is known.
    pub(crate) error: f64,
    /// The number of a body that it is known to lie in, or [`NOWHERE`](Self::NOWHERE).
    pub(crate) within: BodyId,
    /// A number that it has in its body, whichever face it is seen in; [`NEW`](Self::NEW) for a corner that cutting made.
    pub(crate) number: CornerId,
}

impl Corner {
    /// No body.
    pub(crate) const NOWHERE: BodyId = BodyId::NONE;
    /// No corner of a body.
    pub(crate) const NEW: CornerId = CornerId::NONE;

    pub(crate) fn new(point: &Homogeneous) -> Self {
        let [x, y, z, w] = point.value;
        let at = DVec3::new(x, y, z) / w;
        let permanent = DVec3::new(point.permanent[0], point.permanent[1], point.permanent[2]);
        // |x/w − X/W| ≤ ε (|X| perm + |x/w| Wperm) / |W|, with room in the factor
        let error = (permanent + at.abs() * point.permanent[3]) * (32.0 * f64::EPSILON) / w.abs();
        let is_known =
            at.is_finite() && error.is_finite() && point.permanent[3] * (16.0 * f64::EPSILON) <= 0.5 * w.abs();
        let error =
            if is_known { error.max_element() + PLANE_VALUE_BOUND * at.abs().max_element() } else { f64::INFINITY };
        Self { at, error, within: Self::NOWHERE, number: Self::NEW }
    }

    /// Whether its coordinates are right to ten digits; the bound for their error is far larger than the error.
    #[inline]
    pub(crate) fn is_well_known(&self) -> bool {
        const WELL: f64 = 1e-10;
        self.error <= WELL * self.at.abs().max_element()
    }
}

impl Bounds {
    /// The box grown so that it surely holds a meeting point.
    #[inline]
    #[must_use]
    pub fn with_point(self, point: &Homogeneous) -> Self {
        self.with_corner(&Corner::new(point))
    }

    /// The box grown so that it surely holds a corner.
    #[inline]
    pub(crate) fn with_corner(self, corner: &Corner) -> Self {
        if corner.error.is_infinite() {
            return Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let margin = DVec3::splat(corner.error);
        Self { min: self.min.min(corner.at - margin), max: self.max.max(corner.at + margin) }
    }
}
