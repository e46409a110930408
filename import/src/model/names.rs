//! What a file defines by name.

use planecut_csg::MaterialId;
use rustc_hash::FxHashMap;

use super::error::{Checked, Fault};
use super::expression::{FUNCTIONS, PI, is_name};
use super::json::{Document, Entry, Kind};
use crate::source::shorten;

/// Definitions of one kind, numbered in the order of the file.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) names: Vec<String>,
    /// What each name stands for.
    pub(super) entries: Vec<Entry>,
    pub(super) by_name: FxHashMap<String, u32>,
}

/// A material's name, and where the file defines it.
#[derive(Debug)]
pub(super) struct NamedMaterial {
    pub(super) name: String,
    pub(super) entry: Option<Entry>,
}

/// All definitions of a file.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub(super) parameters: Table,
    pub(super) parts: Table,
    pub(super) outlines: Table,
    pub(super) materials: Vec<NamedMaterial>,
    material_numbers: FxHashMap<String, u32>,
}

impl Table {
    /// The definitions in the object `entry`, if there is one.
    fn read(document: &Document<'_>, entry: Option<Entry>, what: &str) -> Checked<Self> {
        let mut table = Self::default();
        let Some(entry) = entry else { return Ok(table) };
        if document.kind(entry) != Kind::Object {
            return document.refuse(entry, format!("an object of names and {what}"));
        }
        for (key, value) in document.members(entry) {
            let name = document.text(key).into_owned();
            table.by_name.insert(name.clone(), table.names.len() as u32);
            table.names.push(name);
            table.entries.push(value);
        }
        Ok(table)
    }

    /// The names, in a list for people.
    pub(super) fn known(&self) -> String {
        const MOST: usize = 12;
        if self.names.is_empty() {
            return "the file defines none".to_owned();
        }
        let shown: Vec<String> = self.names.iter().take(MOST).map(|name| shorten(name)).collect();
        let ellipsis = if self.names.len() > MOST { ", …" } else { "" };
        format!("{}{ellipsis}", shown.join(", "))
    }
}

impl Names {
    /// Reads the four tables of the outermost object; their values are not looked at yet.
    ///
    /// # Errors
    /// [`Fault`] where one of them is no object, or a parameter has a name that expressions could not use.
    pub(super) fn read(document: &Document<'_>) -> Checked<Self> {
        let table = |key, what| Table::read(document, document.member(document.root(), key), what);
        let parameters = table("parameters", "numbers")?;
        for (name, entry) in parameters.names.iter().zip(&parameters.entries) {
            if !is_name(name) || name == PI || FUNCTIONS.iter().any(|(function, _)| function == name) {
                let found = format!("the name `{}`", shorten(name));
                let expected = "letters a to z, digits and `_`, a letter first, and no function's name";
                return Err(Fault::new(*entry, found, expected));
            }
        }
        let materials = table("materials", "materials")?;
        let mut names = Self {
            parameters,
            parts: table("parts", "nodes")?,
            outlines: table("outlines", "outlines")?,
            ..Self::default()
        };
        for (name, entry) in materials.names.into_iter().zip(materials.entries) {
            names.material(&name);
            names.materials.last_mut().expect("one was added").entry = Some(entry);
        }
        Ok(names)
    }

    /// The number of a material, a new one where its name was not seen before.
    pub(super) fn material(&mut self, name: &str) -> u32 {
        if let Some(number) = self.material_numbers.get(name) {
            return *number;
        }
        let number = self.materials.len() as u32;
        self.materials.push(NamedMaterial { name: name.to_owned(), entry: None });
        self.material_numbers.insert(name.to_owned(), number);
        number
    }

    /// The number of a material that is known.
    pub(super) fn number_of_material(&self, name: &str) -> u32 {
        self.material_numbers.get(name).copied().unwrap_or(0)
    }

    /// The numbers of the materials that a list names, `other` where it has null.
    pub(super) fn numbers_of_materials<'n>(
        &'n self,
        document: &'n Document<'_>,
        list: Entry,
        other: MaterialId,
    ) -> impl Iterator<Item = MaterialId> + 'n {
        document.items(list).map(move |item| match document.kind(item) {
            Kind::Text => MaterialId(self.number_of_material(&document.text(item))),
            _ => other,
        })
    }

    /// Whether the file itself defines a material.
    pub(super) fn defines_material(&self, name: &str) -> bool {
        self.material_numbers.contains_key(name)
    }

    /// The number of a part among all definitions; the model itself is 0.
    pub(super) fn part_vertex(&self, part: usize) -> usize {
        1 + part
    }

    /// The number of an outline among all definitions.
    pub(super) fn outline_vertex(&self, outline: usize) -> usize {
        1 + self.parts.names.len() + outline
    }

    /// How many definitions there are, the model included.
    pub(super) fn vertices(&self) -> usize {
        1 + self.parts.names.len() + self.outlines.names.len()
    }

    /// What the definition of a number is called.
    pub(super) fn vertex_name(&self, vertex: usize) -> &str {
        let mut names = self.parts.names.iter().chain(&self.outlines.names);
        vertex.checked_sub(1).and_then(|at| names.nth(at)).map_or("model", String::as_str)
    }
}
