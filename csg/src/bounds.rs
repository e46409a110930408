//! Axis-aligned boxes that are sure to hold what they bound.

use glam::DVec3;
use planecut_kernel::sign::Homogeneous;

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
        let [x, y, z, w] = point.value;
        let permanent = DVec3::new(point.permanent[0], point.permanent[1], point.permanent[2]);
        // |x/w − X/W| ≤ ε (|X| perm + |x/w| Wperm) / |W|, with room in the factor
        let position = DVec3::new(x, y, z) / w;
        let error = (permanent + position.abs() * point.permanent[3]) * (16.0 * f64::EPSILON) / w.abs();
        if !position.is_finite() || !error.is_finite() || point.permanent[3] * (16.0 * f64::EPSILON) > 0.5 * w.abs() {
            return Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let margin = 2.0 * error + position.abs() * WIDENING;
        Self { min: self.min.min(position - margin), max: self.max.max(position + margin) }
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
