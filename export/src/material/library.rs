//! The materials of all parts of a file, each once, with a name of its own.

use planecut_csg::Material;
use rustc_hash::{FxHashMap, FxHashSet};

use super::looks;
use crate::Part;

/// What tells a material from others of its name.
type Look = [Option<u32>; 5];

/// Materials and their names in a file.
#[derive(Debug, Default)]
pub(crate) struct Library {
    materials: Vec<(String, Material)>,
    /// For each name of a material those that have it, by what tells them apart, and their places in the list.
    known: FxHashMap<String, Vec<(Look, u32)>>,
    taken: FxHashSet<String>,
}

impl Library {
    /// Those of some parts, in the order in which they come, and for each part the places in the list of its materials; `name` as for
    /// [`Library::add`].
    pub(crate) fn of(parts: &[Part<'_>], name: impl Fn(&str) -> String) -> (Self, Vec<Vec<u32>>) {
        let mut library = Self::default();
        let places = parts.iter().map(|part| library.add(&part.mesh.materials, &name)).collect();
        (library, places)
    }

    /// Adds materials that are not there yet and gives the places of all of these in the list. `name` makes a name that the format can hold,
    /// and what that gives twice for materials that differ is numbered.
    pub(crate) fn add(&mut self, materials: &[Material], name: impl Fn(&str) -> String) -> Vec<u32> {
        materials.iter().map(|material| self.add_one(material, &name)).collect()
    }

    fn add_one(&mut self, material: &Material, name: impl Fn(&str) -> String) -> u32 {
        let looks = looks(material);
        let mut known = self.known.get(&material.name).into_iter().flatten();
        if let Some((_, place)) = known.find(|(other, _)| *other == looks) {
            return *place;
        }
        let place = self.materials.len() as u32;
        self.known.entry(material.name.clone()).or_default().push((looks, place));
        self.materials.push((unique(&name(&material.name), &mut self.taken), material.clone()));
        place
    }

    /// Names and materials.
    pub(crate) fn materials(&self) -> &[(String, Material)] {
        &self.materials
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
        let (library, places) =
            Library::of(&[Part::new("", &one), Part::new("", &other)], |name| name.replace(' ', "_"));
        let names: Vec<&str> = library.materials().iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a_b", "a_b_2", "a_b_3"]);
        assert_eq!(places, [vec![0, 1, 2], vec![1, 0, 0]]);
    }
}
