//! What faces and triangles are made of, and meshes, whose triangles a file may list.

use super::Checker;
use crate::model::error::{Checked, Fault};
use crate::model::form::mesh_fields;
use crate::model::json::{Entry, Kind};

impl Checker<'_, '_> {
    /// The name of a mesh file, or an object with it, or with triangles.
    pub(super) fn mesh(&mut self, entry: Entry) -> Checked<()> {
        match self.document.kind(entry) {
            Kind::Text => {
                self.findings.has_mesh_files = true;
                Ok(())
            }
            Kind::Object => {
                self.object(entry, mesh_fields(self.document, entry))?;
                match self.document.member(entry, "triangles") {
                    Some(triangles) => self.a_material_for_each(entry, triangles, "triangles"),
                    None => {
                        self.findings.has_mesh_files = true;
                        Ok(())
                    }
                }
            }
            _ => self.document.refuse(
                entry,
                "the name of a mesh file, or an object with the key file, or with the keys vertices and triangles",
            ),
        }
    }

    /// The name of a material.
    pub(super) fn material(&mut self, entry: Entry) -> Checked<()> {
        self.is(entry, self.document.kind(entry) == Kind::Text, "the name of a material")?;
        if !self.names.defines_material(&self.document.text(entry)) {
            self.findings.unknown_materials.push(entry);
        }
        Ok(())
    }

    /// A list of names of materials, or null in their place.
    pub(super) fn material_names(&mut self, entry: Entry) -> Checked<()> {
        self.is(entry, self.length(entry).is_some(), "a list of names of materials, or null")?;
        let document = self.document;
        document.items(entry).try_for_each(|item| match document.kind(item) {
            Kind::Null => Ok(()),
            Kind::Text => self.material(item),
            _ => document.refuse(item, "the name of a material, or null"),
        })
    }

    /// Whether the materials that an object lists, if it does, are as many as `things`, which are called `what`.
    pub(super) fn a_material_for_each(&self, object: Entry, things: Entry, what: &str) -> Checked<()> {
        let Some(materials) = self.document.member(object, "materials") else { return Ok(()) };
        let (found, expected) = (self.document.items(materials).count(), self.document.items(things).count());
        if found == expected {
            return Ok(());
        }
        let expected = format!("as many as {what}, {expected}");
        Err(Fault::new(materials, format!("a list of {found} materials"), expected))
    }
}
