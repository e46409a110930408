//! Volume, area, centroid and inertia of a bounded polytope, as those of its exact corners.
//!
//! The sums run over the cones between a corner and the faces, these cut into fans of triangles. Two tiers, each with an error
//! bound that is checked: about 100 bits ([`corners`], [`double`]), which is enough but for slivers; integers of as many bits
//! as it takes ([`wide`]). [`moments`] makes figures from the sums.

#[cfg(test)]
mod bounds;
mod corners;
mod double;
mod moments;
mod wide;

use glam::{DMat3, DVec3};

use super::{IncrementalPolytope, PlaneIdx};
use moments::Figures;

/// Volume, area, centroid and inertia of a bounded polytope, in the units of its planes.
///
/// # Guarantees
/// The true figures are those of the polytope of the planes as given, whose corners are rational. Each figure is within one
/// unit in the last place of the true one, with one exception for what comes out near zero by symmetry: with `V` the
/// volume and `e` the extents of the set along the axes,
///
/// - coordinate `i` of the centroid may instead be off by up to `2⁻⁷⁵·eᵢ`;
/// - the product of inertia of the axes `i` and `j` may instead be off by up to `2⁻⁷⁵·V·eᵢ·eⱼ`.
///
/// This holds wherever the body lies: the extents are its own, not its distance from the origin. Figures outside the range of
/// normal numbers are exempt.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Measures {
    /// Volume; zero where the set is empty.
    pub volume: f64,
    /// Area of the boundary.
    pub area: f64,
    /// Centroid; the origin where the set is empty.
    pub centroid: DVec3,
    /// The inertia tensor about the centroid for unit density, `∫ (|r|²·I − r·rᵀ) dV` with `r` counted from the centroid:
    /// moments on the diagonal, products `−∫ x·y dV` beside it.
    pub inertia: DMat3,
}

/// Bits behind the binary point of the wide tier, one try after the other.
const WIDTHS: [usize; 6] = [160, 256, 512, 1088, 2560, 6144];

impl IncrementalPolytope {
    /// Volume, area, centroid and inertia; `None` where the set is unbounded.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut block = IncrementalPolytope::new();
    /// for (axis, length) in DVec3::AXES.into_iter().zip([1.0, 2.0, 3.0]) {
    ///     block.add_plane(HalfSpace::new(axis, length)?);
    ///     block.add_plane(HalfSpace::new(-axis, 0.0)?);
    /// }
    /// let measures = block.measures().expect("a block is bounded");
    /// assert_eq!((measures.volume, measures.area), (6.0, 22.0));
    /// assert_eq!(measures.centroid, DVec3::new(0.5, 1.0, 1.5));
    /// // m·(b² + c²)/12
    /// assert_eq!(measures.inertia.x_axis, DVec3::new(6.5, 0.0, 0.0));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn measures(&self) -> Option<Measures> {
        if !self.is_bounded() {
            return None;
        }
        if self.is_empty() {
            return Some(Measures { volume: 0.0, area: 0.0, centroid: DVec3::ZERO, inertia: DMat3::ZERO });
        }
        let (mut figures, mut area) = (Figures::default(), None);
        if let Some(double) = self.double_sums() {
            (figures, area) = (figures.or(&double.sums), double.area);
        }
        let mut widths = WIDTHS.into_iter();
        loop {
            if let Figures { volume: Some(volume), centroid: Some(centroid), inertia: Some(inertia) } = figures
                && let Some(area) = area
            {
                return Some(Measures { volume, area, centroid, inertia });
            }
            let wide = self.wide_corners(widths.next()?);
            if !figures.are_complete() {
                figures = wide.sums(self).map_or(figures, |sums| figures.or(&sums));
            }
            area = area.or_else(|| wide.area(self, None));
        }
    }

    /// The area of a plane's face, within one unit in the last place; zero where the plane has no face, `None` where there
    /// is no such plane or the set is unbounded.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut corner = IncrementalPolytope::new();
    /// for axis in DVec3::AXES {
    ///     corner.add_plane(HalfSpace::new(-axis, 0.0)?);
    /// }
    /// let lid = corner.add_plane(HalfSpace::new(DVec3::ONE, 1.0)?).plane();
    /// assert_eq!(corner.face_area(lid), Some(0.75f64.sqrt()));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn face_area(&self, plane: PlaneIdx) -> Option<f64> {
        let slot = self.live(plane).filter(|_| self.is_bounded())?;
        if self.is_empty() || self.face_polygon(plane).is_none() {
            return Some(0.0);
        }
        let wide = || WIDTHS.into_iter().find_map(|width| self.wide_corners(width).area(self, Some(slot)));
        self.double_face_area(slot).or_else(wide)
    }
}
