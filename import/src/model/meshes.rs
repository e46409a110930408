//! Closed meshes in files beside the model.

use std::io::ErrorKind;
use std::path::{Component, Path};

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, Transform, Tree, WindingRule};
use rustc_hash::FxHashMap;

use super::error::{Checked, Fault};
use super::json::Entry;
use super::materials::{DEFAULT, NO_MATERIAL};
use super::names::Names;
use super::values::Values;
use crate::file::{MAX_MESH, read_file};
use crate::mesh::{MeshFormat, MeshImport, SolidOptions, read_solid};
use crate::source::shorten;

/// Mesh files that were read, and the materials that they brought.
pub(super) struct Meshes<'n> {
    folder: &'n Path,
    /// Whether texture coordinates are kept.
    textures: bool,
    names: &'n Names,
    /// What each file gave, by its name and how it was taken: copies share it.
    read: FxHashMap<(String, WindingRule, u64), Tree>,
    /// Those that the model does not define.
    materials: Vec<Material>,
}

impl<'n> Meshes<'n> {
    /// Nothing read yet; files lie in this folder.
    pub(super) fn new(folder: &'n Path, textures: bool, names: &'n Names) -> Self {
        Self { folder, textures, names, read: FxHashMap::default(), materials: Vec::new() }
    }

    /// The materials, so far, that are numbered after those of the model.
    pub(super) fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The materials that are numbered after those of the model.
    pub(super) fn into_materials(self) -> Vec<Material> {
        self.materials
    }

    /// The solid of a mesh file, and what is to be said of it. Faces have the materials of the file, those of the model where these have the same
    /// names; where the file names none they have none yet.
    ///
    /// # Errors
    /// [`Fault`] of the name of a file that is none, or gives no solid.
    pub(super) fn tree(&mut self, values: &Values<'_, '_>, value: Entry) -> Checked<(Tree, Vec<String>)> {
        let member = |key| values.document.member(value, key);
        let file = member("file").unwrap_or(value);
        let name = values.document.text(file).into_owned();
        let rule = rule_of(values, value);
        let positive = |key| member(key).map(|entry| above_zero(values, entry)).transpose();
        let close = positive("close")?.unwrap_or(0.0);
        let scale = positive("scale")?;
        let key = (name, rule, close.to_bits());
        let mut messages = Vec::new();
        if !self.read.contains_key(&key) {
            let import = self.import(&key.0, file, &SolidOptions { rule, close, textures: self.textures })?;
            let message = |warning| format!("`{}`: {warning}", shorten(&key.0));
            messages = import.warnings.iter().map(message).collect();
            let tree = self.renamed(import);
            self.read.insert(key.clone(), tree);
        }
        let tree = self.read[&key].clone();
        let Some(scale) = scale else { return Ok((tree, messages)) };
        let entry = member("scale").unwrap_or(value);
        let scaled = Transform::scale(DVec3::splat(scale)).and_then(|map| tree.transformed(&map));
        Ok((values.accept(entry, scaled)?, messages))
    }

    fn import(&self, name: &str, entry: Entry, options: &SolidOptions) -> Checked<MeshImport> {
        let path = Path::new(name);
        let is_below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !is_below || name.is_empty() {
            let expected = "the name of a mesh file beside the model, or in a folder there";
            return Err(Fault::new(entry, format!("\"{}\"", shorten(name)), expected));
        }
        let format = path.extension().and_then(|ending| MeshFormat::from_extension(ending.to_str()?));
        let Some(format) = format else {
            let expected = "the name of a mesh: `.obj`, `.stl`, `.ply`, `.glb` or `.gltf`";
            return Err(Fault::new(entry, format!("\"{}\"", shorten(name)), expected));
        };
        let bytes = read_file(&self.folder.join(path), MAX_MESH).map_err(|error| {
            let reason = match error.kind() {
                ErrorKind::NotFound => "no such file".to_owned(),
                ErrorKind::IsADirectory => "a folder".to_owned(),
                _ => error.to_string(),
            };
            let place = if self.folder.as_os_str().is_empty() { "the working folder" } else { "the model's folder" };
            let expected = format!("a file that can be read, its name taken from {place}");
            Fault::new(entry, format!("\"{}\" ({reason})", shorten(name)), expected)
        })?;
        read_solid(&bytes, format, name, options).map_err(|error| {
            let expected = if error.is_open() {
                "a closed mesh, or the key `close`, a distance within which vertices are joined"
            } else {
                "a closed mesh"
            };
            Fault::new(entry, format!("a mesh that is no solid ({error})"), expected)
        })
    }

    /// The tree of a file with the numbers of materials that they have here.
    fn renamed(&mut self, import: MeshImport) -> Tree {
        let numbers: Vec<MaterialId> = import.model.materials.iter().map(|material| self.number(material)).collect();
        let mut tree = import.model.tree.without_source_lines();
        let used = tree.brushes_mut().iter_mut().flat_map(Brush::materials_mut);
        used.for_each(|material| *material = numbers[material.0 as usize]);
        tree
    }

    fn number(&mut self, material: &Material) -> MaterialId {
        if self.names.defines_material(&material.name) {
            return MaterialId(self.names.number_of_material(&material.name));
        }
        if *material == Material::named(DEFAULT) {
            return NO_MATERIAL;
        }
        let known = self.materials.iter().position(|other| other.name == material.name);
        let place = known.unwrap_or_else(|| {
            self.materials.push(material.clone());
            self.materials.len() - 1
        });
        MaterialId((self.names.materials.len() + place) as u32)
    }
}

/// Which winding numbers of a mesh are inside.
pub(super) fn rule_of(values: &Values<'_, '_>, mesh: Entry) -> WindingRule {
    match values.document.member(mesh, "rule").map(|rule| values.document.text(rule)).as_deref() {
        Some("nonzero") => WindingRule::NonZero,
        Some("odd") => WindingRule::Odd,
        _ => WindingRule::Positive,
    }
}

/// A number that must be above zero.
fn above_zero(values: &Values<'_, '_>, entry: Entry) -> Checked<f64> {
    let value = values.number(entry)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(Fault::new(entry, values.describe_number(entry), "a number above 0"))
}
