//! Measures of a solid.

use glam::DVec3;

/// Measures of a solid, taken from its boundary before triangulation; lengths in the input's units. A part thinner than
/// rounding counts here, also where the mesh leaves it out as noise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SolidMeasures {
    /// Volume.
    pub volume: f64,
    /// Area of the boundary.
    pub area: f64,
    /// Centroid; the origin for an empty solid.
    pub centroid: DVec3,
    /// Smallest coordinates; the origin for an empty solid.
    pub min: DVec3,
    /// Largest coordinates; the origin for an empty solid.
    pub max: DVec3,
}
