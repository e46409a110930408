//! Convex bodies with a material on each face.

use glam::DVec3;
use planecut_kernel::HalfSpace;

use super::MaterialId;

/// One bounding plane of a [`Brush`] and what its face is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BrushFace {
    /// The body lies inside this half-space.
    pub half_space: HalfSpace,
    /// The material of the face.
    pub material: MaterialId,
}

/// A convex body: the intersection of the half-spaces of its faces.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Brush {
    /// The bounding planes, in the input's order.
    pub faces: Vec<BrushFace>,
    /// A name, where the input gives one.
    pub name: Option<String>,
}

impl Brush {
    /// The body of all points within every half-space; may be unbounded or empty.
    #[must_use]
    pub fn from_half_spaces(half_spaces: impl IntoIterator<Item = HalfSpace>, material: MaterialId) -> Self {
        let faces = half_spaces.into_iter().map(|half_space| BrushFace { half_space, material }).collect();
        Self { faces, ..Self::default() }
    }

    /// The half-spaces whose intersection the brush is, in the order of its faces.
    pub fn half_spaces(&self) -> impl Iterator<Item = &HalfSpace> + Clone {
        self.faces.iter().map(|face| &face.half_space)
    }

    /// The box between two corners; empty where a minimum is not below its maximum, as any brush is empty whose half-spaces have no
    /// common volume. The primitive `planecut_shapes::primitives::cuboid` is for sizes that a user gives: it refuses such corners.
    ///
    /// # Panics
    /// Where a coordinate is not finite or beyond `±2^200`.
    #[must_use]
    pub fn cuboid(min: impl Into<DVec3>, max: impl Into<DVec3>, material: MaterialId) -> Self {
        let (min, max) = (min.into(), max.into());
        let sides = DVec3::AXES.into_iter().flat_map(|axis| [(axis, axis.dot(max)), (-axis, -axis.dot(min))]);
        let half_spaces =
            sides.map(|(normal, offset)| HalfSpace::new(normal, offset).expect("finite corners, not too far away"));
        Self::from_half_spaces(half_spaces, material)
    }
}
