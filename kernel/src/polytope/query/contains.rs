//! Whether a point belongs to the set.

use glam::DVec3;

use crate::polytope::IncrementalPolytope;
use crate::sign::{Sign, side_of_point};

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Location {
    /// Strictly inside every half-space.
    Inside,
    /// On the boundary.
    On,
    /// Strictly outside some half-space, or the set is empty, or the point is not finite.
    Outside,
}

impl IncrementalPolytope {
    /// Whether the closed set contains a point, exactly for the numbers given; a point that is not finite lies outside.
    ///
    /// Asks the planes that have a face, a few nanoseconds each.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut half = IncrementalPolytope::new();
    /// half.add_plane(HalfSpace::new(DVec3::new(1.0, 1.0, 0.0), 0.3)?);
    /// assert!(half.contains(DVec3::new(0.1, 0.1, 9.0)));
    /// // 0.1 and 0.2 are both a little more than a tenth and two tenths: their exact sum exceeds the number 0.3
    /// assert!(!half.contains(DVec3::new(0.1, 0.2, 0.0)));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn contains(&self, point: impl Into<DVec3>) -> bool {
        self.contains_point(point.into())
    }

    fn contains_point(&self, point: DVec3) -> bool {
        !self.is_empty()
            && point.is_finite()
            && self.face_slots().all(|plane| side_of_point(self.row(plane), point) != Sign::Positive)
    }

    /// Whether a point lies inside, on the boundary or outside, exactly for the numbers given.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, Location};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut half = IncrementalPolytope::new();
    /// half.add_plane(HalfSpace::new(DVec3::Z, 1.0)?);
    /// assert_eq!(half.classify(DVec3::ZERO), Location::Inside);
    /// assert_eq!(half.classify(DVec3::Z), Location::On);
    /// assert_eq!(half.classify(DVec3::splat(f64::NAN)), Location::Outside);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn classify(&self, point: impl Into<DVec3>) -> Location {
        self.location(point.into())
    }

    fn location(&self, point: DVec3) -> Location {
        if self.is_empty() || !point.is_finite() {
            return Location::Outside;
        }
        let mut location = Location::Inside;
        for plane in self.face_slots() {
            match side_of_point(self.row(plane), point) {
                Sign::Positive => return Location::Outside,
                Sign::Zero => location = Location::On,
                Sign::Negative => {}
            }
        }
        location
    }
}
