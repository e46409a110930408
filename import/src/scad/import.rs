//! `import`: a closed mesh beside the file.

use std::io::ErrorKind;
use std::path::Path;

use planecut_csg::{MaterialId, Tree};

use super::ScadOptions;
use super::arguments::Arguments;
use super::problem::Problem;
use super::syntax::Node;
use crate::file::{MAX_MESH, read_file};
use crate::mesh::{MeshFormat, SolidOptions, read_solid};

/// What a mesh file gives.
pub(super) enum Imported {
    /// Its solid, and what is to be said of it.
    Solid(Tree, Vec<String>),
    /// Nothing, and why.
    LeftOut(String),
}

/// The solid of a mesh file. Like OpenSCAD, goes on without a file that is not there or holds no solid.
///
/// # Errors
/// [`Problem`] for a format that is not supported.
pub(super) fn mesh(node: &Node<'_>, options: &ScadOptions, material: MaterialId) -> Result<Imported, Problem> {
    let arguments = Arguments::of(node, &["file"]);
    let file = arguments.text("file").unwrap_or_default();
    let format = Path::new(file).extension().and_then(|ending| MeshFormat::from_extension(ending.to_str()?));
    let Some(format) = format else {
        return Err(Problem::new(
            format!("an import of `{}`, which is not supported", file.escape_debug()),
            "a mesh: `.stl`, `.obj`, `.ply`, `.glb` or `.gltf`",
        ));
    };
    let path = options.folder.join(file);
    let bytes = match read_file(&path, MAX_MESH) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::FileTooLarge => {
            return Err(Problem::new(format!("`{}` of {error}", file.escape_debug()), "a file that is shorter"));
        }
        Err(error) => return Ok(Imported::LeftOut(format!("`{}` cannot be read ({error})", file.escape_debug()))),
    };
    let taken = SolidOptions { textures: options.textures, ..SolidOptions::default() };
    Ok(match read_solid(&bytes, format, file, &taken) {
        Ok(import) => {
            let messages = import.warnings.iter().map(|warning| format!("`{}`: {warning}", file.escape_debug()));
            // a line of the mesh file is none of this one
            let tree = import.model.tree.with_material(material).without_source_lines();
            Imported::Solid(tree, messages.collect())
        }
        Err(error) => Imported::LeftOut(error.to_string()),
    })
}
