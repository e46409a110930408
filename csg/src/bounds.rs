//! Axis-aligned boxes that are sure to hold what they bound.

use glam::DVec3;
use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Homogeneous;

use crate::corner::Corner;

/// A box; empty where a minimum exceeds its maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

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
        let margin = DVec3::splat(corner.error);
        Self { min: self.min.min(corner.at - margin), max: self.max.max(corner.at + margin) }
    }

    pub(crate) fn union(self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub(crate) fn intersection(self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    pub(crate) fn touches(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether what lies in both boxes may have an area: boxes that touch in an edge or a corner alone have none in common.
    pub(crate) fn may_share_area(&self, other: &Self) -> bool {
        let (low, high) = (self.min.max(other.min), self.max.min(other.max));
        low.cmple(high).all() && low.cmplt(high).bitmask().count_ones() > 1
    }

    /// The part of the box within a half-space whose plane is perpendicular to an axis; all of it for other half-spaces.
    pub(crate) fn within(mut self, half_space: &HalfSpace) -> Self {
        let normal = half_space.normal();
        let axis = normal.abs().max_position();
        if normal.abs().element_sum() > normal[axis].abs() {
            return self;
        }
        let at = half_space.offset() / normal[axis];
        // division by a power of two is exact, but for what underflows
        let is_power_of_two = normal[axis].to_bits().trailing_zeros() >= f64::MANTISSA_DIGITS - 1;
        let is_rounded = !is_power_of_two || at * normal[axis] != half_space.offset();
        if normal[axis] > 0.0 {
            let at = if is_rounded { at.next_up() } else { at };
            self.max[axis] = self.max[axis].min(at);
        } else {
            let at = if is_rounded { at.next_down() } else { at };
            self.min[axis] = self.min[axis].max(at);
        }
        self
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
