//! The materials that an edit of a live model names.

use planecut_csg::{Brush, Material, MaterialId, Model, Tree};

use super::{ExpressionError, Node};

/// The materials of a model, and those that an edit names for the first time, which come after them. The model has these only once the edit is done.
#[derive(Debug)]
pub struct EditMaterials<'a> {
    known: &'a [Material],
    new: Vec<Material>,
}

impl<'a> EditMaterials<'a> {
    /// Those of a model.
    #[must_use]
    pub fn new(known: &'a [Material]) -> Self {
        Self { known, new: Vec::new() }
    }

    /// Those that were named for the first time.
    #[must_use]
    pub fn into_new(self) -> Vec<Material> {
        self.new
    }

    /// The number of the material that is meant; where there is none, that of a new one.
    fn number(&mut self, is_meant: impl Fn(&Material) -> bool, new: impl FnOnce() -> Material) -> MaterialId {
        let place = self.known.iter().chain(&self.new).position(is_meant).unwrap_or_else(|| {
            self.new.push(new());
            self.known.len() + self.new.len() - 1
        });
        MaterialId(place as u32)
    }

    /// A material by its name.
    pub fn named(&mut self, name: &str) -> MaterialId {
        self.number(|material| material.name == name, || Material::named(name))
    }

    /// The only body of a solid, of materials of the model.
    ///
    /// # Errors
    /// [`ExpressionError::NotOneBody`], and others as for [`Node::model`].
    pub fn brush_of(&mut self, node: &Node) -> Result<Brush, ExpressionError> {
        let Model { materials, tree } = node.model()?;
        if tree.brushes().len() != 1 || !tree.is_union() {
            return Err(ExpressionError::NotOneBody { found: tree.brushes().len() });
        }
        let numbers: Vec<MaterialId> =
            materials.iter().map(|material| self.number(|known| known == material, || material.clone())).collect();
        let mut brush = Tree::into_brushes(tree).remove(0);
        brush.materials_mut().for_each(|own| *own = numbers[own.0 as usize]);
        Ok(brush)
    }
}
