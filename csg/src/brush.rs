//! What a model is made of: convex bodies with a material on each face.

use planecut_kernel::HalfSpace;

/// Index into [`Model::materials`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub u32);

/// A named material; faces refer to it by [`MaterialId`].
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name, in a Quake map that of the texture.
    pub name: String,
    /// Linear RGB base colour where the input states one; otherwise the exporter derives a colour from the name.
    pub color: Option<[f32; 3]>,
}

/// One bounding plane of a [`Brush`] and what its face is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrushFace {
    /// The body lies inside this half-space.
    pub half_space: HalfSpace,
    /// The material of the face.
    pub material: MaterialId,
}

/// A convex body: the intersection of the half-spaces of its faces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Brush {
    /// The bounding planes, in the input's order.
    pub faces: Vec<BrushFace>,
    /// A name, where the input gives one.
    pub name: Option<String>,
    /// Line of the input on which the brush begins, counted from 1; 0 where there is none.
    pub line: u32,
}

/// A list of brushes whose union is the solid, and the materials that they name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// The materials, each name once.
    pub materials: Vec<Material>,
    /// The brushes, in the input's order.
    pub brushes: Vec<Brush>,
}
