//! Reader and writer of lists of edits, one JSON object a line (`docs/command-line.md`).

mod record;
mod write;

use std::collections::HashMap;

use planecut_csg::{Brush, BrushFace, BrushId, Edit, Material, MaterialId, NodeId, Transform, TreeOperand};
use planecut_kernel::{DMat3, DVec3, HalfSpace, PlaneIdx};
use serde::Deserialize;
use thiserror::Error;

use crate::source::without_byte_order_mark;
use record::{MaterialNames, Record};
pub use write::write_edits;

/// Material of brushes and planes of which nothing is said, where the model has none.
const DEFAULT: &str = "default";

/// What a line should be.
const EXPECTED: &str = "an edit: a JSON object with \"op\" and what belongs to it";

/// Why a list of edits could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{name}:{line}: found {found}, expected {expected}")]
pub struct EditsError {
    /// The file.
    pub name: String,
    /// The line, counted from 1.
    pub line: u32,
    /// What stands there.
    pub found: String,
    /// What may stand there.
    pub expected: String,
}

/// What is wrong with an edit.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("found {found}, expected {expected}")]
pub struct EditFault {
    /// What stands there.
    pub found: String,
    /// What may stand there.
    pub expected: String,
}

/// A list of edits that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EditsImport {
    /// The edits, each with its line, counted from 1.
    pub edits: Vec<(u32, Edit)>,
    /// Materials that are named for the first time: they come after those that were known.
    pub materials: Vec<Material>,
}

/// Reads edits of a model whose materials are known; `name` is what errors call the text. Empty lines say nothing.
///
/// ```
/// use planecut_csg::{BrushId, Edit, Material};
/// use planecut_import::edits::read_edits;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let text = br#"{"op": "remove_brush", "brush": 7}
/// {"op": "undo"}"#;
/// let import = read_edits(text, "edits.jsonl", &[Material::named("stone")])?;
/// assert_eq!(import.edits, [(1, Edit::RemoveBrush { brush: BrushId(7) }), (2, Edit::Undo)]);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`EditsError`] for the first line that is no edit, or has a plane or a matrix that cannot be.
pub fn read_edits(text: &[u8], name: &str, known: &[Material]) -> Result<EditsImport, EditsError> {
    let mut names = Names::new(known);
    let mut edits = Vec::new();
    for (line, text) in (1..).zip(without_byte_order_mark(text).split(|byte| *byte == b'\n')) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        let fault = |EditFault { found, expected }| EditsError { name: name.to_owned(), line, found, expected };
        let edit = read_record(text).and_then(|record| edit_of(record, &mut names));
        edits.push((line, edit.map_err(fault)?));
    }
    Ok(EditsImport { edits, materials: names.new })
}

/// Reads one edit of the keys of a JSON object; also the materials that it names for the first time, which come after those that are known.
///
/// # Errors
/// [`EditFault`] for keys that are no edit, or a plane or a matrix that cannot be.
pub fn edit_of_keys(
    keys: serde_json::Map<String, serde_json::Value>,
    known: &[Material],
) -> Result<(Edit, Vec<Material>), EditFault> {
    let record = Record::deserialize(serde_json::Value::Object(keys));
    let record = record.map_err(|error| EditFault::new(error.to_string(), EXPECTED))?;
    let mut names = Names::new(known);
    let edit = edit_of(record, &mut names)?;
    Ok((edit, names.new))
}

impl EditFault {
    fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { found: found.into(), expected: expected.into() }
    }

    /// Of two keys both are there, or neither.
    fn of_two(both: bool, one: &str, other: &str) -> Self {
        let found = if both { format!("{one} and {other}") } else { format!("neither {one} nor {other}") };
        Self::new(found, format!("either {one} or {other}"))
    }
}

/// Materials by name.
struct Names {
    numbers: HashMap<String, MaterialId>,
    known: u32,
    new: Vec<Material>,
}

impl Names {
    fn new(known: &[Material]) -> Self {
        Self {
            numbers: known.iter().zip(0..).map(|(material, k)| (material.name.clone(), MaterialId(k))).collect(),
            known: known.len() as u32,
            new: Vec::new(),
        }
    }

    fn number(&mut self, name: &str) -> MaterialId {
        if let Some(known) = self.numbers.get(name) {
            return *known;
        }
        let number = MaterialId(self.known + self.new.len() as u32);
        self.new.push(Material::named(name));
        self.numbers.insert(name.to_owned(), number);
        number
    }

    fn default(&mut self) -> MaterialId {
        if self.known + self.new.len() as u32 == 0 { self.number(DEFAULT) } else { MaterialId(0) }
    }
}

fn read_record(text: &[u8]) -> Result<Record, EditFault> {
    serde_json::from_slice(text).map_err(|error| {
        // the place is that within the line
        let message = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let message = message.strip_suffix(&place).unwrap_or(&message);
        let found = format!("{message} (column {})", error.column());
        EditFault::new(found, EXPECTED)
    })
}

fn edit_of(record: Record, names: &mut Names) -> Result<Edit, EditFault> {
    Ok(match record {
        Record::AddPlane { brush, plane, material } => Edit::AddPlane {
            brush: BrushId(brush),
            half_space: half_space(plane)?,
            material: material.map(|name| names.number(&name)),
        },
        Record::RemovePlane { brush, plane } => {
            Edit::RemovePlane { brush: BrushId(brush), plane: PlaneIdx(plane as usize) }
        }
        Record::MovePlane { brush, plane, offset, to } => {
            let (brush, plane) = (BrushId(brush), PlaneIdx(plane as usize));
            match (offset, to) {
                (Some(offset), None) => Edit::MovePlane { brush, plane, offset },
                (None, Some(to)) => Edit::TurnPlane { brush, plane, half_space: half_space(to)? },
                (offset, _) => return Err(EditFault::of_two(offset.is_some(), "\"offset\"", "\"to\"")),
            }
        }
        Record::SetMaterial { brush, plane, material } => Edit::SetMaterial {
            brush: BrushId(brush),
            plane: plane.map(|plane| PlaneIdx(plane as usize)),
            material: names.number(&material),
        },
        Record::RenameBrush { brush, name } => Edit::RenameBrush { brush: BrushId(brush), name },
        Record::AddBrush { planes, material, name, role } => {
            Edit::AddBrush { brush: brush(&planes, material, name, names)?, role: role.into() }
        }
        Record::RemoveBrush { brush } => Edit::RemoveBrush { brush: BrushId(brush) },
        Record::ReplaceBrush { brush: id, planes, material, name } => {
            Edit::ReplaceBrush { brush: BrushId(id), by: brush(&planes, material, name, names)? }
        }
        Record::TransformBrush { brush, matrix } => {
            Edit::TransformBrush { brush: BrushId(brush), transform: transform(&matrix)? }
        }
        Record::SetRole { brush, node, role } => {
            let operand = match (brush, node) {
                (Some(brush), None) => TreeOperand::Brush(BrushId(brush)),
                (None, Some(node)) => TreeOperand::Node(NodeId(node)),
                (brush, _) => return Err(EditFault::of_two(brush.is_some(), "\"brush\"", "\"node\"")),
            };
            Edit::SetRole { operand, role: role.into() }
        }
        Record::CopyBrushes { brushes, matrix } => {
            Edit::CopyBrushes { brushes: ids(brushes), transform: transform(&matrix)? }
        }
        Record::MirrorBrushes { brushes, plane } => {
            Edit::MirrorBrushes { brushes: ids(brushes), plane: half_space(plane)? }
        }
        Record::ArrayBrushes { brushes, matrix, count } => {
            Edit::ArrayBrushes { brushes: ids(brushes), transform: transform(&matrix)?, count: count as usize }
        }
        Record::MoveBrushBefore { brush, before } => {
            Edit::MoveBrushBefore { brush: BrushId(brush), before: before.map(BrushId) }
        }
        Record::MoveOperand { operand, to, before } => {
            Edit::MoveOperand { operand: operand.into(), to: to.map(NodeId), before: before.map(Into::into) }
        }
        Record::SetOperation { node, operation } => {
            Edit::SetOperation { node: NodeId(node), operation: operation.into() }
        }
        Record::Wrap { operands, operation } => {
            Edit::Wrap { operands: operands.into_iter().map(Into::into).collect(), operation: operation.into() }
        }
        Record::Dissolve { node } => Edit::Dissolve { node: NodeId(node) },
        Record::RemoveNode { node } => Edit::RemoveNode { node: NodeId(node) },
        Record::Begin {} => Edit::BeginStep,
        Record::Commit {} => Edit::CommitStep,
        Record::Cancel {} => Edit::CancelStep,
        Record::Undo {} => Edit::Undo,
        Record::Redo {} => Edit::Redo,
    })
}

fn half_space([x, y, z, d]: [f64; 4]) -> Result<HalfSpace, EditFault> {
    HalfSpace::new(DVec3::new(x, y, z), d)
        .map_err(|error| EditFault::new(format!("plane {:?}", [x, y, z, d]), format!("a half-space: {error}")))
}

fn transform(rows: &[[f64; 4]]) -> Result<Transform, EditFault> {
    const EXPECTED: &str = "3 or 4 rows of 4, the fourth [0, 0, 0, 1]";
    let (rows, last) = match rows {
        [a, b, c] => ([*a, *b, *c], [0.0, 0.0, 0.0, 1.0]),
        [a, b, c, d] => ([*a, *b, *c], *d),
        _ => return Err(EditFault::new(format!("a matrix of {} rows", rows.len()), EXPECTED)),
    };
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(EditFault::new(format!("a matrix whose last row is {last:?}"), EXPECTED));
    }
    let column = |column: usize| DVec3::new(rows[0][column], rows[1][column], rows[2][column]);
    Transform::new(DMat3::from_cols(column(0), column(1), column(2)), column(3)).map_err(|error| {
        EditFault::new(format!("matrix {rows:?}"), format!("an affine map that can be undone: {error}"))
    })
}

fn brush(
    planes: &[[f64; 4]],
    material: Option<MaterialNames>,
    name: Option<String>,
    names: &mut Names,
) -> Result<Brush, EditFault> {
    let count = planes.len();
    let materials: Vec<MaterialId> = match material {
        None => vec![names.default(); count],
        Some(MaterialNames::One(name)) => vec![names.number(&name); count],
        Some(MaterialNames::Each(each)) if each.len() == count => each.iter().map(|name| names.number(name)).collect(),
        Some(MaterialNames::Each(each)) => {
            let found = format!("{} materials", each.len());
            return Err(EditFault::new(found, format!("one, or one for each of {count} planes")));
        }
    };
    let face = |(plane, material): (&[f64; 4], MaterialId)| Ok(BrushFace { half_space: half_space(*plane)?, material });
    let faces = planes.iter().zip(materials).map(face).collect::<Result<_, EditFault>>()?;
    Ok(Brush { faces, name, mesh: None })
}

fn ids(brushes: Vec<u64>) -> Vec<BrushId> {
    brushes.into_iter().map(BrushId).collect()
}

#[cfg(test)]
mod tests {
    use planecut_csg::Role;

    use super::*;

    const MATERIALS: [&str; 2] = ["stone", "wood"];

    fn known() -> Vec<Material> {
        MATERIALS.map(Material::named).to_vec()
    }

    #[test]
    fn what_is_written_is_read_again() {
        let text = br#"{"op": "add_plane", "brush": 12, "plane": [0.0, 0.6, 0.8, 64.0], "material": "wood"}
{"op": "remove_plane", "brush": 12, "plane": 3}
{"op": "move_plane", "brush": 12, "plane": 0, "offset": 80.0}

{"op": "add_brush", "planes": [[1,0,0,1], [-1,0,0,1], [0,1,0,1], [0,-1,0,1], [0,0,1,1], [0,0,-1,1]], "role": "subtract", "material": "glass"}
{"op": "add_brush", "planes": [[1,0,0,1], [-1,0,0,1]], "material": ["wood", "stone"], "name": "slab"}
{"op": "remove_brush", "brush": 7}
{"op": "replace_brush", "brush": 3, "planes": [[1,2,3,4]]}
{"op": "transform_brush", "brush": 7, "matrix": [[1,0,0,16],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}
{"op": "set_role", "brush": 7, "role": "intersect"}
{"op": "move_plane", "brush": 12, "plane": 0, "to": [0.0, 0.6, 0.8, 64.0]}
{"op": "set_material", "brush": 3, "plane": 2, "material": "wood"}
{"op": "set_material", "brush": 3, "material": "stone"}
{"op": "rename_brush", "brush": 3, "name": "wall"}
{"op": "rename_brush", "brush": 3}
{"op": "set_role", "node": 7, "role": "subtract"}
{"op": "copy_brushes", "brushes": [1, 2], "matrix": [[1,0,0,16],[0,1,0,0],[0,0,1,0]]}
{"op": "mirror_brushes", "brushes": [1], "plane": [1,0,0,16]}
{"op": "array_brushes", "brushes": [1], "matrix": [[1,0,0,16],[0,1,0,0],[0,0,1,0]], "count": 5}
{"op": "move_brush_before", "brush": 1, "before": 4}
{"op": "move_brush_before", "brush": 1}
{"op": "move_operand", "operand": {"brush": 1}, "to": 3, "before": {"node": 4}}
{"op": "move_operand", "operand": {"node": 1}}
{"op": "set_operation", "node": 2, "operation": "difference"}
{"op": "wrap", "operands": [{"brush": 1}, {"node": 2}], "operation": "xor"}
{"op": "dissolve", "node": 2}
{"op": "remove_node", "node": 2}
{"op": "begin"}
{"op": "commit"}
{"op": "cancel"}
{"op": "undo"}
{"op": "redo"}"#;
        let import = read_edits(text, "e", &known()).unwrap();
        let lines: Vec<u32> = import.edits.iter().map(|edit| edit.0).collect();
        assert_eq!(lines, [1, 2, 3].into_iter().chain(5..=32).collect::<Vec<u32>>());
        assert_eq!(import.materials, [Material::named("glass")]);
        let materials = [known(), import.materials.clone()].concat();
        let written = write_edits(import.edits.iter().map(|edit| &edit.1), &materials);
        let again = read_edits(written.as_bytes(), "e", &materials).unwrap();
        assert!(again.materials.is_empty());
        let edits = |import: &EditsImport| import.edits.iter().map(|edit| edit.1.clone()).collect::<Vec<Edit>>();
        assert_eq!(edits(&again), edits(&import));
        let Edit::AddBrush { brush, role: Role::Subtract } = &import.edits[3].1 else { panic!("{import:?}") };
        assert!(brush.faces.iter().all(|face| face.material == MaterialId(2)));
    }

    #[test]
    fn errors_name_file_and_line() {
        let cases: [(&str, &str); 12] = [
            (r#"{"op": "explode"}"#, "unknown variant `explode`"),
            (r#"{"op": "undo", "brush": 1}"#, "unknown field `brush`"),
            (r#"{"op": "remove_brush"}"#, "missing field `brush`"),
            (r#"{"op": "remove_brush", "brush": -1}"#, "invalid value: integer `-1`"),
            (r#"{"op": "add_plane", "brush": 0, "plane": [0, 0, 0, 1]}"#, "plane [0.0, 0.0, 0.0, 1.0]"),
            (r#"{"op": "add_plane", "brush": 0, "plane": [0, 0, NaN, 1]}"#, "expected value"),
            (r#"{"op": "transform_brush", "brush": 0, "matrix": [[1,0,0,0]]}"#, "a matrix of 1 rows"),
            (r#"{"op": "transform_brush", "brush": 0, "matrix": [[0,0,0,0],[0,1,0,0],[0,0,1,0]]}"#, "matrix [[0.0"),
            (r#"{"op": "add_brush", "planes": [[1,0,0,1]], "material": ["a", "b"]}"#, "2 materials"),
            (r#"{"op": "move_plane", "brush": 0, "plane": 0}"#, "neither \"offset\" nor \"to\""),
            (r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 1, "to": [1,0,0,1]}"#, "\"offset\" and \"to\""),
            (r#"{"op": "set_role", "brush": 0, "node": 0, "role": "add"}"#, "\"brush\" and \"node\""),
        ];
        for (text, found) in cases {
            let text = format!("{{\"op\": \"undo\"}}\n\n{text}\n");
            let error = read_edits(text.as_bytes(), "some.jsonl", &known()).unwrap_err();
            assert_eq!((error.line, error.name.as_str()), (3, "some.jsonl"), "{error}");
            assert!(error.found.starts_with(found), "{error}");
        }
        assert!(read_edits(b"\xff", "e", &[]).is_err());
        assert_eq!(read_edits(b"", "e", &[]).unwrap(), EditsImport::default());
    }

    #[test]
    fn an_edit_is_read_of_the_keys_of_an_object() {
        let keys = |text: &str| serde_json::from_str(text).unwrap();
        let (edit, new) =
            edit_of_keys(keys(r#"{"op": "set_material", "brush": 0, "material": "glass"}"#), &known()).unwrap();
        let expected = Edit::SetMaterial { brush: BrushId(0), plane: None, material: MaterialId(2) };
        assert_eq!((edit, new), (expected, vec![Material::named("glass")]));
        let fault = edit_of_keys(keys(r#"{"op": "undo", "buffers": true}"#), &known()).unwrap_err();
        assert!(fault.to_string().starts_with("found unknown field `buffers`"), "{fault}");
    }
}
