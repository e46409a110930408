//! What is to be evaluated: brushes with a material on each face, and the tree of set operations over them.

mod brush;
mod cutaway;
mod leaves;
mod material;
mod mesh_body;
mod of_material;
mod parts;
#[cfg(feature = "serde")]
mod saved;
mod source;
mod stream;
mod texture;
mod transform;
mod tree;
mod used_materials;

pub use brush::{Brush, BrushFace};
pub use cutaway::{CutMaterial, Cutaway};
pub use material::{Material, MaterialId};
pub use mesh_body::MeshBody;
pub use source::FaceSource;
pub(crate) use stream::TreePiece;
pub use stream::{TreeBuilder, TreeSink};
pub use texture::{TextureAxes, TextureUnit};
pub use transform::{Transform, TransformError, sine_and_cosine};
#[cfg(test)]
pub(crate) use tree::holds_outside;
pub use tree::{Operation, Tree, TreeNode};
pub use used_materials::UsedMaterials;

/// A tree of brushes, and the materials that their faces name.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Model {
    /// The materials, each name once.
    pub materials: Vec<Material>,
    /// The brushes, in the input's order, and how they are combined.
    pub tree: Tree,
}
