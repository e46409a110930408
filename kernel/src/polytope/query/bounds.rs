//! The smallest box around the set.

use glam::DVec3;

use super::support::Support;
use crate::polytope::IncrementalPolytope;

/// A box `min ≤ x ≤ max`; components are infinite where the set goes on for ever.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundingBox {
    /// The smallest coordinates.
    pub min: DVec3,
    /// The largest coordinates.
    pub max: DVec3,
}

impl IncrementalPolytope {
    /// The smallest box around the set, by six climbs; `None` where the set is empty.
    ///
    /// Each bound is correctly rounded to the nearest number, so that it can lie half a unit in the last place inside the
    /// set, and equals the coordinate of the vertex that makes it.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut slab = IncrementalPolytope::new();
    /// slab.add_plane(HalfSpace::new(DVec3::Z, 2.0)?);
    /// slab.add_plane(HalfSpace::new(-DVec3::Z, 1.0)?);
    /// let bounds = slab.bounding_box().expect("it is not empty");
    /// assert_eq!((bounds.min.z, bounds.max.z, bounds.max.x), (-1.0, 2.0, f64::INFINITY));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn bounding_box(&self) -> Option<BoundingBox> {
        let mut bounds = BoundingBox { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        for (axis, direction) in DVec3::AXES.into_iter().enumerate() {
            for upper in [false, true] {
                let bound = match self.support(if upper { direction } else { -direction })? {
                    Support::Empty => return None,
                    Support::Unbounded { .. } => continue,
                    Support::Vertex { position, .. } => position[axis],
                    Support::Flat { point } => point[axis],
                };
                let corner = if upper { &mut bounds.max } else { &mut bounds.min };
                corner[axis] = bound;
            }
        }
        Some(bounds)
    }
}
