//! Materials: those of the file, and the one of faces that name none.

use planecut_csg::{Brush, Material, MaterialId, Tree};
use rustc_hash::FxHashSet;

use super::error::Checked;
use super::json::{Document, Entry};
use super::names::{NamedMaterial, Names};
use super::values::Values;
use crate::Warning;
use crate::lines::LineTable;
use crate::source::shorten;

/// Stands for a material on faces that have none yet.
pub(super) const NO_MATERIAL: MaterialId = MaterialId(u32::MAX);
/// The material of faces that no node gives one.
pub(super) const DEFAULT: &str = "default";

/// The materials, by their numbers.
///
/// # Errors
/// A fault where a share is not between 0 and 1.
pub(super) fn read(names: &Names, values: &Values<'_, '_>) -> Checked<Vec<Material>> {
    names.materials.iter().map(|material| read_one(material, values)).collect()
}

fn read_one(named: &NamedMaterial, values: &Values<'_, '_>) -> Checked<Material> {
    let mut material = Material::named(named.name.clone());
    let Some(entry) = named.entry else { return Ok(material) };
    let member = |key| values.document.member(entry, key);
    let share = |key| member(key).map(|share| values.share(share)).transpose();
    if let Some(color) = member("color") {
        let mut channels = [0.0; 3];
        for (channel, item) in channels.iter_mut().zip(values.document.items(color)) {
            *channel = values.share(item)?;
        }
        material.color = Some(channels);
    }
    material.metallic = share("metallic")?;
    material.roughness = share("roughness")?;
    Ok(material)
}

/// Gives faces without a material the default one.
pub(super) fn fill(tree: &mut Tree, materials: &mut Vec<Material>) {
    if tree.brushes().iter().flat_map(Brush::materials).all(|material| material != NO_MATERIAL) {
        return;
    }
    let number = number_of_default(materials);
    if number.0 as usize == materials.len() {
        materials.push(Material::named(DEFAULT));
    }
    set_missing(tree, number);
}

/// The number of the default material; that of the next one where there is none of this name.
pub(super) fn number_of_default(materials: &[Material]) -> MaterialId {
    let known = materials.iter().position(|material| material.name == DEFAULT);
    MaterialId(known.unwrap_or(materials.len()) as u32)
}

/// Gives faces without a material this one.
fn set_missing(tree: &mut Tree, material: MaterialId) {
    tree.brushes_mut().iter_mut().for_each(|brush| {
        set_missing_of(brush, material);
    });
}

/// Gives faces of a brush without a material this one; whether there were any.
pub(super) fn set_missing_of(brush: &mut Brush, material: MaterialId) -> bool {
    let mut any = false;
    for own in brush.materials_mut().filter(|own| **own == NO_MATERIAL) {
        *own = material;
        any = true;
    }
    any
}

/// One warning for each material that nodes name and the file does not define.
pub(super) fn warn_of_unknown(document: &Document<'_>, lines: &LineTable, entries: &[Entry]) -> Vec<Warning> {
    let mut seen = FxHashSet::default();
    let mut entries: Vec<Entry> = entries.to_vec();
    entries.sort_unstable();
    let first = entries.into_iter().filter(|entry| seen.insert(document.text(*entry)));
    first
        .map(|entry| {
            let name = shorten(&document.text(entry));
            let message = format!("the file defines no material `{name}`; its colour is made up");
            Warning::note(lines.line_of(document.offset(entry)), message)
        })
        .collect()
}
