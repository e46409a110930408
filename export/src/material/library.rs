//! The materials of all parts of a file, each once, with a name of its own.

use planecut_csg::{Material, MaterialId};
use rustc_hash::{FxHashMap, FxHashSet};

use super::looks;
use crate::Part;

/// Materials and their names in a file.
#[derive(Debug)]
pub(crate) struct Library<'a> {
    materials: Vec<(String, &'a Material)>,
    /// For each part the place in the list of each of its materials.
    places: Vec<Vec<u32>>,
}

impl<'a> Library<'a> {
    /// Those of some parts, in the order in which they come; `name` makes a name that the format can hold, and what that gives twice for
    /// materials that differ is numbered.
    pub(crate) fn of(parts: &[Part<'a>], name: impl Fn(&str) -> String) -> Self {
        let mut known = FxHashMap::default();
        let mut taken = FxHashSet::default();
        let mut materials: Vec<(String, &Material)> = Vec::new();
        let mut place_of = |material: &'a Material| {
            *known.entry((material.name.as_str(), looks(material))).or_insert_with(|| {
                materials.push((unique(&name(&material.name), &mut taken), material));
                materials.len() as u32 - 1
            })
        };
        let places = parts.iter().map(|part| part.mesh.materials.iter().map(&mut place_of).collect()).collect();
        Self { materials, places }
    }

    /// Names and materials.
    pub(crate) fn materials(&self) -> &[(String, &'a Material)] {
        &self.materials
    }

    /// The place in the list of a part's material.
    pub(crate) fn place(&self, part: usize, material: MaterialId) -> u32 {
        self.places[part][material.0 as usize]
    }
}

/// A name for each material, each one once: what `name` makes of the material's own, numbered where that is taken.
pub(crate) fn unique_names(materials: &[Material], name: impl Fn(&str) -> String) -> Vec<String> {
    let mut taken = FxHashSet::default();
    materials.iter().map(|material| unique(&name(&material.name), &mut taken)).collect()
}

/// The name, numbered where it is taken.
pub(crate) fn unique(wanted: &str, taken: &mut FxHashSet<String>) -> String {
    let mut name = wanted.to_owned();
    let mut copy = 2;
    while !taken.insert(name.clone()) {
        name = format!("{wanted}_{copy}");
        copy += 1;
    }
    name
}

#[cfg(test)]
mod tests {
    use planecut_csg::Mesh;

    use super::*;

    #[test]
    fn names_are_distinct_and_materials_that_look_alike_are_one() {
        let red = Material { color: Some([1.0, 0.0, 0.0]), ..Material::named("a b") };
        let materials = |materials: Vec<Material>| Mesh { materials, ..Mesh::default() };
        let one = materials(vec![Material::named("a b"), red.clone(), Material::named("a_b")]);
        let other = materials(vec![red, Material::named("a b"), Material::named("a b")]);
        let library = Library::of(&[Part::new("", &one), Part::new("", &other)], |name| name.replace(' ', "_"));
        let names: Vec<&str> = library.materials().iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a_b", "a_b_2", "a_b_3"]);
        assert_eq!(library.places, [vec![0, 1, 2], vec![1, 0, 0]]);
    }
}
