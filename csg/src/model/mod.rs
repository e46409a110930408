//! What is to be evaluated: brushes with a material on each face, and the tree of set operations over them.

mod brush;
mod cutaway;
mod material;
mod source;
mod transform;
mod tree;

use crate::body::build_ahead;
pub use brush::{Brush, BrushFace};
pub use cutaway::{CutMaterial, Cutaway};
pub use material::{Material, MaterialId};
pub use source::{FaceSource, TextureAxes, TextureUnit};
pub use transform::{Transform, TransformError, sine_and_cosine};
pub use tree::{Operation, Tree, TreeNode};

/// A tree of brushes, and the materials that their faces name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// The materials, each name once.
    pub materials: Vec<Material>,
    /// The brushes, in the input's order, and how they are combined.
    pub tree: Tree,
}

impl Model {
    /// Builds the bodies of all brushes now, in parallel, so that evaluations of this model need not, nor those of models and
    /// live models that take clones of its brushes. Outcomes are the same with and without; the bodies take memory, some
    /// 150 bytes for each face.
    ///
    /// ```
    /// use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EvaluateError> {
    /// let block = Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0));
    /// let tool = Brush::cuboid(DVec3::ONE, DVec3::splat(3.0), MaterialId(0));
    /// let mut stock = Model { materials: vec![Material::named("steel")], tree: Tree::from(block) | tool.into() };
    /// stock.build_bodies();
    /// let [block, tool] = [0, 1].map(|k| Tree::from(stock.tree.brushes()[k].clone()));
    /// let cut = Model { materials: stock.materials.clone(), tree: block - tool };
    /// assert_eq!(evaluate(&cut)?.solid.volume, 7.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn build_bodies(&mut self) {
        build_ahead(self.tree.brushes_mut());
    }
}
