//! Materials that look alike are one.

use planecut_csg::{Material, Mesh};
use rustc_hash::FxHashMap;

/// For each material of a mesh the first one that has its name and looks like it.
#[derive(Debug)]
pub(crate) struct Looks {
    first: Vec<u32>,
}

impl Looks {
    pub(crate) fn of(materials: &[Material]) -> Self {
        let mut known: FxHashMap<(&str, [Option<u32>; 5]), u32> = FxHashMap::default();
        let first = (0..).zip(materials);
        let first = first.map(|(number, material)| *known.entry((&material.name, looks(material))).or_insert(number));
        Self { first: first.collect() }
    }

    /// The material that stands for a face's.
    pub(crate) fn of_face(&self, mesh: &Mesh, face: u32) -> u32 {
        self.first[mesh.faces[face as usize].material.0 as usize]
    }
}

/// What tells a material from others of its name.
pub(crate) fn looks(material: &Material) -> [Option<u32>; 5] {
    let [r, g, b] = [0, 1, 2].map(|k| material.color.map(|color| color[k]));
    [r, g, b, material.metallic, material.roughness].map(|value| value.map(f32::to_bits))
}
