//! The table of materials, and what brushes call them.

use planecut_csg::{Material, MaterialId};
use rustc_hash::{FxHashMap, FxHashSet};

use super::text::{Text, quoted};
use crate::ExportError;

/// The names of materials in the file.
pub(super) struct MaterialNames {
    /// For each material the place of its name.
    places: Vec<usize>,
    /// The names, in quotes, each once.
    names: Vec<String>,
    /// For each name the first material that has it.
    firsts: Vec<usize>,
}

impl MaterialNames {
    /// One name for materials of one name that look alike. Others of that name are numbered; names that are there stay as they are.
    ///
    /// # Errors
    /// [`ExportError::MaterialRange`] for a number that no file can hold.
    pub(super) fn of(materials: &[Material]) -> Result<Self, ExportError> {
        materials.iter().try_for_each(check)?;
        let mut taken: FxHashSet<String> = materials.iter().map(|material| material.name.clone()).collect();
        // those of each name that look different
        let mut known: FxHashMap<&str, Vec<usize>> = FxHashMap::default();
        let mut all = Self { places: Vec::with_capacity(materials.len()), names: Vec::new(), firsts: Vec::new() };
        for (number, material) in materials.iter().enumerate() {
            let alike = known.entry(&material.name).or_default();
            let place = match alike.iter().find(|place| materials[all.firsts[**place]] == *material) {
                Some(place) => *place,
                None => {
                    let name =
                        if alike.is_empty() { material.name.clone() } else { numbered(&material.name, &mut taken) };
                    all.names.push(quoted(&name));
                    all.firsts.push(number);
                    alike.push(all.firsts.len() - 1);
                    all.firsts.len() - 1
                }
            };
            all.places.push(place);
        }
        Ok(all)
    }

    /// The place of a material's name; `None` for one that is not in the list. Materials with one place are one in the file.
    pub(super) fn place(&self, material: MaterialId) -> Option<usize> {
        self.places.get(material.0 as usize).copied()
    }

    /// The name at a place, in quotes.
    pub(super) fn name(&self, place: usize) -> &str {
        &self.names[place]
    }

    /// How many materials there are.
    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    /// Writes the table, a material a line; nothing where there is none.
    ///
    /// # Errors
    /// [`ExportError::Io`].
    pub(super) fn write(&self, materials: &[Material], text: &mut Text<'_>) -> Result<(), ExportError> {
        if self.names.is_empty() {
            return Ok(());
        }
        text.push("  \"materials\": {");
        for (place, (name, first)) in self.names.iter().zip(&self.firsts).enumerate() {
            text.push(if place > 0 { ",\n    " } else { "\n    " });
            text.push(name);
            text.push(": ");
            write_look(&materials[*first], text);
            text.spill()?;
        }
        text.push("\n  },\n");
        Ok(())
    }
}

fn write_look(material: &Material, text: &mut Text<'_>) {
    let mut separator = "{";
    let mut key = |text: &mut Text<'_>, key: &str| {
        text.push(std::mem::replace(&mut separator, ", "));
        text.push(&format!("\"{key}\": "));
    };
    if let Some(color) = material.color {
        key(text, "color");
        text.list(color, |text, channel| text.push(&single(channel)));
    }
    for (name, share) in [("metallic", material.metallic), ("roughness", material.roughness)] {
        if let Some(share) = share {
            key(text, name);
            text.push(&single(share));
        }
    }
    text.push(if separator == "{" { "{}" } else { "}" });
}

/// The shortest decimal that reads back as the same number in single precision, also where a reader rounds it to double precision first.
fn single(value: f32) -> String {
    let short = if value == 0.0 { "0".to_owned() } else { format!("{value}") };
    if short.parse::<f64>().is_ok_and(|read| read as f32 == value) { short } else { format!("{}", f64::from(value)) }
}

/// A name that is not taken: the name, and a number.
fn numbered(name: &str, taken: &mut FxHashSet<String>) -> String {
    let mut number = 2;
    loop {
        let candidate = format!("{name} {number}");
        if taken.insert(candidate.clone()) {
            return candidate;
        }
        number += 1;
    }
}

/// Sees that the numbers of a material are those that a file can hold.
fn check(material: &Material) -> Result<(), ExportError> {
    let shares = material.color.into_iter().flatten().chain(material.metallic).chain(material.roughness);
    // NaN is in no range
    match shares.into_iter().find(|share| !(0.0..=1.0).contains(share)) {
        Some(value) => Err(ExportError::MaterialRange { material: material.name.clone(), value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn shares_read_back_as_the_same_number() {
        let mut rng = Rng::new(1);
        let random = std::iter::repeat_with(|| f32::from_bits(rng.bits() as u32));
        for value in [0.0, 1.0, 0.1, 1e-45, 0.999_999_94].into_iter().chain(random.take(20_000)) {
            if (0.0..=1.0).contains(&value) {
                let text = single(value);
                let read: f64 = serde_json::from_str(&text).expect("a number as JSON has them");
                assert_eq!(read as f32, value, "{text}");
            }
        }
        assert_eq!(single(0.56), "0.56");
    }

    #[test]
    fn materials_of_one_name_are_one_where_they_look_alike() {
        let red = |name: &str| Material { color: Some([1.0, 0.0, 0.0]), ..Material::named(name) };
        let materials =
            [Material::named("a"), red("a"), Material::named("a 2"), Material::named("a"), red("a"), red("b")];
        let names = MaterialNames::of(&materials).expect("in range");
        let shown: Vec<&str> =
            (0..6).map(|number| names.name(names.place(MaterialId(number)).expect("in the list"))).collect();
        assert_eq!(shown, ["\"a\"", "\"a 3\"", "\"a 2\"", "\"a\"", "\"a 3\"", "\"b\""]);
        assert_eq!(names.place(MaterialId(6)), None);
    }
}
