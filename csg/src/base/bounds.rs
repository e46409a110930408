//! Axis-aligned boxes that are sure to hold what they bound. The kernel's `BoundingBox` is another promise: correctly rounded, so that it
//! may lie half a unit in the last place inside the set.

use glam::{BVec3, DVec3};
use planecut_kernel::HalfSpace;

/// A box; empty where a minimum exceeds its maximum, as at first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The smallest coordinates.
    pub min: DVec3,
    /// The largest coordinates.
    pub max: DVec3,
}

/// Whether something holds along all axes, without a branch for each.
#[inline]
fn is_everywhere(holds: BVec3) -> bool {
    holds.bitmask() == 0b111
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds {
    /// A box of nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The least box around two points.
    #[inline]
    #[must_use]
    pub fn around(a: DVec3, b: DVec3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The least box around both.
    #[inline]
    #[must_use]
    pub fn union(self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// What both have in common.
    #[inline]
    #[must_use]
    pub fn intersection(self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether the closed boxes have a point in common.
    #[inline]
    #[must_use]
    pub fn touches(&self, other: &Self) -> bool {
        is_everywhere(self.min.cmple(other.max)) & is_everywhere(other.min.cmple(self.max))
    }

    /// Whether another box lies in the closed box.
    #[inline]
    #[must_use]
    pub fn holds(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// Whether what lies in both boxes may have an area: boxes that touch in an edge or a corner alone have none in common.
    #[inline]
    #[must_use]
    pub fn may_share_area(&self, other: &Self) -> bool {
        let (low, high) = (self.min.max(other.min), self.max.min(other.max));
        // a bit for each number with more than one of three bits
        const SEVERAL: u32 = 0b1110_1000;
        let is_long = low.cmplt(high).bitmask();
        // without a branch
        is_everywhere(low.cmple(high)) & (SEVERAL >> is_long & 1 != 0)
    }

    /// The part of the box within a half-space whose plane is perpendicular to an axis; all of it for other half-spaces.
    #[must_use]
    pub fn within(mut self, half_space: &HalfSpace) -> Self {
        let normal = half_space.normal();
        let axis = normal.abs().max_position();
        // a sum would be rounded
        if normal.cmpne(DVec3::ZERO).bitmask().count_ones() > 1 {
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
    #[inline]
    #[must_use]
    pub fn extent_along(&self, normal: DVec3, offset: f64) -> (f64, f64) {
        let (a, b) = (self.min * normal, self.max * normal);
        let magnitude = a.abs().max(b.abs()).element_sum() + offset.abs();
        let margin = 16.0 * f64::EPSILON * magnitude;
        (a.min(b).element_sum() - offset - margin, a.max(b).element_sum() - offset + margin)
    }

    /// A slightly larger box, so that points in it are not beside the larger one for rounding.
    #[inline]
    #[must_use]
    pub fn with_room(self) -> Self {
        const ROOM: f64 = 1e-9;
        let room = DVec3::splat(ROOM * self.min.abs().max(self.max.abs()).max_element());
        Self { min: self.min - room, max: self.max + room }
    }

    /// The middle.
    #[inline]
    #[must_use]
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }
}
