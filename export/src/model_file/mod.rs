//! The project's own model file: a tree of operations with all that is known of its brushes.
//!
//! - `nesting`: the tree as nodes within nodes, from the outermost to the innermost, one after another.
//! - `leaves`: a brush in one line.
//! - `materials`: the table of materials, and the names that brushes call them by.
//! - `limits`: what readers of the format take at most.
//! - `text`: the parts of JSON, handed on before they become long.

mod leaves;
mod limits;
mod materials;
mod nesting;
mod text;

use std::io::Write;

use planecut_csg::{Model, Operation};

use crate::ExportError;
use leaves::Leaves;
use materials::MaterialNames;
use nesting::{NOTHING, Piece, pieces};
use text::Text;

/// Writes a model as the project's own model file (`docs/model-file.md`), all coordinates times `scale`: the tree of operations, and of each brush its planes or its mesh,
/// its name, and the material of each face. Text goes out piece by piece: the whole file is never in memory.
///
/// With a scale of 1 the reader gives the same model back: every number bit for bit, brushes and materials in the same order. What differs:
///
/// - The tree is flattened where that says the same: unions directly within unions, intersections within intersections, `xor` within `xor`, and a difference that is
///   the first operand of a difference. An operation without operands, a brush without planes and a mesh without triangles become nothing or all of space,
///   without a brush; nothing is left out where it changes nothing.
/// - Materials of one name that look alike are one. Those that do not are called `name 2`, `name 3`, ….
/// - Surfaces of meshes are numbered by the first triangle that is made of them.
/// - Source lines are those of the new file.
///
/// The format has no texture coordinates of meshes ([`MeshBody::textures`](planecut_csg::MeshBody::textures)): they are not written. Of the parameters, parts, shapes and
/// copies of the file that a model was read from, it holds the outcome. Of more than 1,048,576 brushes the reader has to be told that it may read them.
///
/// ```
/// use planecut_csg::{Brush, Material, MaterialId, Model, Tree};
/// use planecut_export::write_model;
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
/// let model = Model { materials: vec![Material::named("brick")], tree: block(0.0, 3.0) - block(1.0, 2.0) };
/// let mut text = Vec::new();
/// write_model(&model, 1.0, &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.starts_with("{\n  \"planecut\": 1,\n  \"materials\": {\n    \"brick\": {}\n  },\n  \"model\":\n    {\"difference\": [\n"));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ExportError::Scale`] for a scale that is not between 1e-30 and 1e30; [`ExportError::ModelLimit`] where the file could not be read, as it would be nested too deep, be too long,
/// or have too many brushes or planes; [`ExportError::MaterialRange`] for a material whose colour, metalness or roughness is not between 0 and 1. [`ExportError::UnknownMaterial`] and
/// [`ExportError::ModelRange`] name the brush by its number; [`ExportError::Io`] where `out` refuses. Part of the text may have been written by then.
pub fn write_model(model: &Model, scale: f64, out: &mut dyn Write) -> Result<(), ExportError> {
    // NaN fails this comparison as well.
    if !(1e-30..=1e30).contains(&scale) {
        return Err(ExportError::Scale(scale));
    }
    let names = MaterialNames::of(&model.materials)?;
    let leaves = Leaves { brushes: model.tree.brushes(), names: &names, scale };
    let pieces = pieces(&model.tree);
    limits::check(&pieces, model.tree.brushes())?;
    let mut text = Text::new(out);
    text.push("{\n  \"planecut\": 1,\n");
    names.write(&model.materials, &mut text)?;
    text.push("  \"model\":");
    write_pieces(&pieces, &leaves, &mut text)?;
    text.push("\n}\n");
    text.end()
}

fn write_pieces(pieces: &[Piece], leaves: &Leaves<'_>, text: &mut Text<'_>) -> Result<(), ExportError> {
    let mut open: Vec<Operation> = Vec::new();
    let mut is_first = true;
    for piece in pieces {
        if *piece == Piece::Close {
            let ending = if open.pop() == Some(Operation::Complement) { "}" } else { "]}" };
            text.line(open.len());
            text.push(ending);
            is_first = false;
            continue;
        }
        if !is_first {
            text.push(",");
        }
        text.line(open.len());
        is_first = false;
        match *piece {
            Piece::Open(operation) => {
                let bracket = if operation == Operation::Complement { "" } else { " [" };
                text.push(&format!("{{\"{}\":{bracket}", operation.name()));
                open.push(operation);
                is_first = true;
            }
            Piece::Leaf(number) => leaves.write(number, text)?,
            Piece::Nothing => text.push(NOTHING),
            Piece::Close => {}
        }
        text.spill()?;
    }
    Ok(())
}
