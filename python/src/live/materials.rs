//! The materials that a call of an edit names.

use planecut::csg::{Brush, Material, MaterialId, Model, Tree};

use crate::errors::{Failure, Outcome};
use crate::expression::Node;

/// The materials of a model, and those that a call names for the first time, which come after them. The model has these only once the edit is done.
pub(super) struct Materials<'a> {
    known: &'a [Material],
    new: Vec<Material>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(known: &'a [Material]) -> Self {
        Self { known, new: Vec::new() }
    }

    /// Those that were named for the first time.
    pub(super) fn into_new(self) -> Vec<Material> {
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
    pub(super) fn named(&mut self, name: &str) -> MaterialId {
        self.number(|material| material.name == name, || Material::named(name))
    }

    /// The only body of a solid, of materials of the model.
    pub(super) fn brush_of(&mut self, node: &Node) -> Outcome<Brush> {
        let Model { materials, tree } = node.model()?;
        if tree.brushes().len() != 1 || !tree.is_union() {
            let found = tree.brushes().len();
            return Err(Failure::of(format!(
                "solid: found one of {found} bodies, expected one convex body or closed mesh"
            )));
        }
        let numbers: Vec<MaterialId> =
            materials.iter().map(|material| self.number(|known| known == material, || material.clone())).collect();
        let mut brush = Tree::into_brushes(tree).remove(0);
        brush.materials_mut().for_each(|own| *own = numbers[own.0 as usize]);
        Ok(brush)
    }
}
