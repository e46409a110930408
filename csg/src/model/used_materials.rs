//! The few materials of a long list that a part uses.

use crate::ids::number32;

use super::{Brush, Material, MaterialId, Model, Tree};

/// The materials that something uses, renumbered in the order that they have. Where each triangle of a mesh has a material of its own, so that one knows
/// where it comes from, no part of it can hold them all.
///
/// ```
/// use planecut_csg::{MaterialId, UsedMaterials};
///
/// let used = UsedMaterials::of([7, 2, 7].map(MaterialId));
/// assert_eq!(used.select(&["a", "b", "c", "d", "e", "f", "g", "h"]), ["c", "h"]);
/// assert_eq!(used.number(MaterialId(7)), MaterialId(1));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UsedMaterials {
    /// Rising, each once.
    numbers: Vec<MaterialId>,
}

impl UsedMaterials {
    /// Those of a list that may name some several times.
    #[must_use]
    pub fn of(used: impl IntoIterator<Item = MaterialId>) -> Self {
        let mut numbers: Vec<MaterialId> = used.into_iter().collect();
        numbers.sort_unstable();
        numbers.dedup();
        Self { numbers }
    }

    /// Of the things that there are one of for each material, those of the materials that are used.
    #[must_use]
    pub fn select<T: Clone>(&self, all: &[T]) -> Vec<T> {
        self.numbers.iter().filter_map(|number| all.get(number.0 as usize)).cloned().collect()
    }

    /// The new number of a material. One that is not used has a number that no material has.
    #[must_use]
    pub fn number(&self, old: MaterialId) -> MaterialId {
        self.numbers.binary_search(&old).map_or(MaterialId(u32::MAX), |place| MaterialId(number32(place)))
    }
}

impl Tree {
    /// A model of the tree with those of some materials that it uses, and which these are.
    #[must_use]
    pub fn with_used_materials(mut self, materials: &[Material]) -> (Model, UsedMaterials) {
        let used = UsedMaterials::of(self.brushes().iter().flat_map(Brush::materials));
        let own = self.brushes_mut().iter_mut().flat_map(Brush::materials_mut);
        own.for_each(|material| *material = used.number(*material));
        (Model { materials: used.select(materials), tree: self }, used)
    }
}
