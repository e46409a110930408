//! Why an empty set is empty.

use crate::polytope::infinity::is_infinity;
use crate::polytope::{IncrementalPolytope, PlaneIdx, external};
use crate::sign::{Sign, orient3};

impl IncrementalPolytope {
    /// At most four planes whose half-spaces have no interior in common, none of which could be left out; `None` where the
    /// set has an interior.
    ///
    /// A non-negative combination of their normals is zero, and the same combination of their offsets is not positive
    /// (Farkas).
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut set = IncrementalPolytope::new();
    /// let below = set.add_plane(HalfSpace::new(DVec3::Z, 0.0)?).plane();
    /// set.add_plane(HalfSpace::new(DVec3::X, 5.0)?);
    /// assert_eq!(set.emptiness_witness(), None);
    /// let above = set.add_plane(HalfSpace::new(-DVec3::Z, -1.0)?).plane();
    /// assert_eq!(set.emptiness_witness(), Some(vec![below, above]));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn emptiness_witness(&self) -> Option<Vec<PlaneIdx>> {
        if !self.is_empty() {
            return None;
        }
        let [a, b, c, violated] = self.witness;
        let opposite = self.row(violated).flipped();
        let [ra, rb, rc] = [a, b, c].map(|plane| self.row(plane));
        // The multipliers in −n = λa·na + λb·nb + λc·nc by Cramer's rule; a plane with multiplier zero takes no part.
        let multipliers = [orient3(&opposite, rb, rc), orient3(ra, &opposite, rc), orient3(ra, rb, &opposite)];
        let mut planes: Vec<u32> = [a, b, c]
            .into_iter()
            .zip(multipliers)
            .filter(|(plane, multiplier)| *multiplier != Sign::Zero && !is_infinity(*plane))
            .map(|(plane, _)| plane)
            .collect();
        planes.push(violated);
        planes.sort_unstable();
        Some(planes.into_iter().map(external).collect())
    }
}
