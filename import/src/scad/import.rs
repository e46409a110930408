//! `import`: a closed mesh beside the file.

use std::io::ErrorKind;
use std::path::Path;

use planecut_csg::{MaterialId, Tree};

use super::arguments::Arguments;
use super::problem::Problem;
use super::syntax::Node;
use crate::file::{MAX_MESH, read_file};
use crate::mesh::{MeshFormat, read_solid};

/// The solid of a mesh file, and what is to be said of it. Like OpenSCAD, goes on without a file that is not there or holds no
/// solid.
///
/// # Errors
/// [`Problem`] for a format that is not supported.
pub(super) fn mesh(node: &Node<'_>, folder: &Path, material: MaterialId) -> Result<(Tree, Option<String>), Problem> {
    let arguments = Arguments::of(node, &["file"]);
    let file = arguments.text("file").unwrap_or_default();
    let format = Path::new(file).extension().and_then(|ending| MeshFormat::from_extension(ending.to_str()?));
    let Some(format) = format else {
        return Err(Problem::new(
            format!("an import of `{}`, which is not supported", file.escape_debug()),
            "a mesh: `.stl`, `.obj`, `.ply`, `.glb` or `.gltf`",
        ));
    };
    let path = folder.join(file);
    let left_out = |why: &str| (Tree::empty(), Some(format!("an import is left out: {why}")));
    let bytes = match read_file(&path, MAX_MESH) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::FileTooLarge => {
            return Err(Problem::new(format!("`{}` of {error}", file.escape_debug()), "a file that is shorter"));
        }
        Err(error) => return Ok(left_out(&format!("`{}` cannot be read ({error})", file.escape_debug()))),
    };
    match read_solid(&bytes, format, file) {
        Ok(import) => {
            let message = import.warnings.first().map(|warning| format!("`{}`: {warning}", file.escape_debug()));
            // a line of the mesh file is none of this one
            Ok((import.model.tree.with_material(material).without_source_lines(), message))
        }
        Err(error) => Ok(left_out(&error.to_string())),
    }
}
