//! What is drawn: a triangle mesh whose faces have colours, as plain arrays.

use std::borrow::Cow;

use glam::DVec3;

use super::bounds::box_around;

/// A face of a mesh: one or more triangles in one plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Unit normal, outward.
    pub normal: [f64; 3],
    /// Index of its paint.
    pub paint: u32,
}

/// What faces look like.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Paint {
    /// The colour.
    pub tint: Tint,
    /// Cut surfaces are hatched, as cuts through a material are in drawings: paints of different numbers in different directions, as far
    /// as there are enough. `None` for all other surfaces.
    pub hatching: Option<u32>,
}

/// The colour of a [`Paint`]: linear RGB, each channel from 0 to 1. Each style mixes it with a colour of its own, clay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Tint {
    /// No colour: clay alone.
    #[default]
    Clay,
    /// A colour that only tells materials apart; little of it is seen.
    Derived([f32; 3]),
    /// A colour that the material has; most of it is seen.
    Stated([f32; 3]),
}

impl From<Tint> for Paint {
    fn from(tint: Tint) -> Self {
        Self { tint, hatching: None }
    }
}

/// A triangle mesh with faces and their paints.
///
/// Nothing is checked here; whoever draws it refuses indices out of range and numbers that are not finite. It need be neither closed nor
/// manifold. Only the front sides of triangles are seen, from where they are counter-clockwise.
#[derive(Debug, Clone, Default)]
pub struct PaintedMesh<'a> {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Cow<'a, [[u32; 3]]>,
    pub(crate) triangle_faces: Cow<'a, [u32]>,
    pub(crate) faces: Vec<Face>,
    pub(crate) paints: Vec<Paint>,
}

impl<'a> PaintedMesh<'a> {
    /// A mesh of vertex positions, in any unit, z up; the vertex indices of triangles, counter-clockwise as seen from outside; for each
    /// triangle the index of its face; the faces; and the paints that they name.
    #[must_use]
    pub fn new(
        positions: impl IntoIterator<Item = [f64; 3]>,
        triangles: impl Into<Cow<'a, [[u32; 3]]>>,
        triangle_faces: impl Into<Cow<'a, [u32]>>,
        faces: Vec<Face>,
        paints: Vec<Paint>,
    ) -> Self {
        Self {
            positions: positions.into_iter().map(DVec3::from).collect(),
            triangles: triangles.into(),
            triangle_faces: triangle_faces.into(),
            faces,
            paints,
        }
    }

    /// The faces, as [`Buffers`](crate::Buffers) number them.
    #[must_use]
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The paints that faces name.
    #[must_use]
    pub fn paints(&self) -> &[Paint] {
        &self.paints
    }

    /// The paints, to be changed.
    #[must_use]
    pub fn paints_mut(&mut self) -> &mut [Paint] {
        &mut self.paints
    }

    /// The box around the vertices that triangles use.
    pub(crate) fn bounds(&self) -> Option<[DVec3; 2]> {
        box_around(self.triangles.iter().flatten().map(|&corner| self.positions[corner as usize]))
    }
}
