//! Axis-aligned boxes that are sure to hold what they bound.

use glam::DVec3;
use planecut_kernel::sign::Homogeneous;

use crate::corner::Corner;

/// A box; empty where a minimum exceeds its maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

/// Relative widening of each coordinate: far above the error of a well-conditioned quotient. An ill-conditioned point is
/// bounded by its permanents instead.
const WIDENING: f64 = 1e-9;

impl Bounds {
    pub(crate) const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box grown so that it surely holds a meeting point.
    pub(crate) fn with_point(self, point: &Homogeneous) -> Self {
        self.with_corner(&Corner::new(*point))
    }

    /// The box grown so that it surely holds a corner.
    pub(crate) fn with_corner(self, corner: &Corner) -> Self {
        if corner.error.is_infinite() {
            return Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let margin = corner.at.abs() * WIDENING + corner.error;
        Self { min: self.min.min(corner.at - margin), max: self.max.max(corner.at + margin) }
    }

    pub(crate) fn union(self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub(crate) fn touches(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Bounds of `normal·x − offset` over the box, with room for rounding.
    pub(crate) fn extent_along(&self, normal: DVec3, offset: f64) -> (f64, f64) {
        let (a, b) = (self.min * normal, self.max * normal);
        let magnitude = a.abs().max(b.abs()).element_sum() + offset.abs();
        let margin = 16.0 * f64::EPSILON * magnitude;
        (a.min(b).element_sum() - offset - margin, a.max(b).element_sum() - offset + margin)
    }

    pub(crate) fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }
}
