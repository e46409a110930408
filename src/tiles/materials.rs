//! The materials of all blocks under one number each.

use planecut_csg::Material;
use rustc_hash::FxHashMap;

/// What tells a material from others: its name, and the bits of its numbers.
type Key = (String, [Option<u32>; 5]);

/// Materials of all blocks.
#[derive(Debug, Default)]
pub(super) struct Materials {
    pub(super) all: Vec<Material>,
    numbers: FxHashMap<Key, u32>,
}

impl Materials {
    /// Adds those of a block that are not there yet.
    pub(super) fn add(&mut self, materials: &[Material]) {
        for material in materials {
            let next = self.all.len() as u32;
            let number = *self.numbers.entry(key(material)).or_insert(next);
            if number == next {
                self.all.push(material.clone());
            }
        }
    }

    /// The numbers of materials that were added.
    pub(super) fn numbers(&self, materials: &[Material]) -> Vec<u32> {
        materials.iter().map(|material| self.numbers.get(&key(material)).copied().unwrap_or(0)).collect()
    }
}

fn key(material: &Material) -> Key {
    let [r, g, b] = [0, 1, 2].map(|k| material.color.map(|color| color[k]));
    (material.name.clone(), [r, g, b, material.metallic, material.roughness].map(|value| value.map(f32::to_bits)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_for_what_looks_alike() {
        let red = Material { color: Some([1.0, 0.0, 0.0]), ..Material::named("a") };
        let mut materials = Materials::default();
        materials.add(&[Material::named("b"), red.clone()]);
        materials.add(&[Material::named("a"), red.clone(), Material::named("b")]);
        assert_eq!(materials.numbers(&[Material::named("a"), red, Material::named("b")]), [2, 1, 0]);
        assert_eq!(materials.all.len(), 3);
    }
}
