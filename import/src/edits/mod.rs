//! Reader and writer of lists of edits, one JSON object a line (`docs/command-line.md`).

use std::collections::HashMap;

use planecut_csg::{Brush, BrushFace, BrushId, Edit, Material, MaterialId, Role, Transform};
use planecut_kernel::{DMat3, DVec3, HalfSpace, PlaneIdx};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::source::without_byte_order_mark;

/// Material of brushes and planes of which nothing is said, where the model has none.
const DEFAULT: &str = "default";

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

/// A list of edits that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EditsImport {
    /// The edits, each with its line, counted from 1.
    pub edits: Vec<(u32, Edit)>,
    /// Materials that are named for the first time: they come after those that were known.
    pub materials: Vec<Material>,
}

/// An edit as it is written.
#[derive(Debug, Deserialize, Serialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
enum Record {
    AddPlane {
        brush: u64,
        plane: [f64; 4],
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<String>,
    },
    RemovePlane {
        brush: u64,
        plane: u32,
    },
    MovePlane {
        brush: u64,
        plane: u32,
        offset: f64,
    },
    AddBrush {
        planes: Vec<[f64; 4]>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<MaterialNames>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(default)]
        role: RoleName,
    },
    RemoveBrush {
        brush: u64,
    },
    ReplaceBrush {
        brush: u64,
        planes: Vec<[f64; 4]>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<MaterialNames>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    TransformBrush {
        brush: u64,
        matrix: Vec<[f64; 4]>,
    },
    SetRole {
        brush: u64,
        role: RoleName,
    },
    Undo {},
    Redo {},
}

/// One name for all faces, or one for each.
#[derive(Debug, Deserialize, Serialize)]
#[serde(untagged)]
enum MaterialNames {
    One(String),
    Each(Vec<String>),
}

#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
enum RoleName {
    #[default]
    Add,
    Subtract,
    Intersect,
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
    let mut names = Names {
        numbers: known.iter().zip(0..).map(|(material, k)| (material.name.clone(), MaterialId(k))).collect(),
        known: known.len() as u32,
        new: Vec::new(),
    };
    let mut edits = Vec::new();
    for (line, text) in (1..).zip(without_byte_order_mark(text).split(|byte| *byte == b'\n')) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        let fault = |Fault { found, expected }| EditsError { name: name.to_owned(), line, found, expected };
        edits.push((line, read_edit(text, &mut names).map_err(fault)?));
    }
    Ok(EditsImport { edits, materials: names.new })
}

/// Writes edits, a line each, as [`read_edits`] reads them. Those that put a closed mesh into the model have no such form, and are left out.
#[must_use]
pub fn write_edits<'a>(edits: impl IntoIterator<Item = &'a Edit>, materials: &[Material]) -> String {
    let name = |material: MaterialId| materials.get(material.0 as usize).map(|material| material.name.clone());
    let mut text = String::new();
    for edit in edits {
        let Some(record) = Record::of(edit, &name) else { continue };
        text += &serde_json::to_string(&record).expect("numbers are finite, keys are texts");
        text.push('\n');
    }
    text
}

/// What is wrong with a line.
struct Fault {
    found: String,
    expected: String,
}

impl Fault {
    fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { found: found.into(), expected: expected.into() }
    }
}

/// Materials by name.
struct Names {
    numbers: HashMap<String, MaterialId>,
    known: u32,
    new: Vec<Material>,
}

impl Names {
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

fn read_edit(text: &[u8], names: &mut Names) -> Result<Edit, Fault> {
    let record = serde_json::from_slice(text).map_err(|error| {
        // the place is that within the line
        let message = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let message = message.strip_suffix(&place).unwrap_or(&message);
        let found = format!("{message} (column {})", error.column());
        Fault::new(found, "an edit: a JSON object with \"op\" and what belongs to it")
    })?;
    Ok(match record {
        Record::AddPlane { brush, plane, material } => Edit::AddPlane {
            brush: BrushId(brush),
            half_space: half_space(plane)?,
            material: material.map(|name| names.number(&name)),
        },
        Record::RemovePlane { brush, plane } => {
            Edit::RemovePlane { brush: BrushId(brush), plane: PlaneIdx(plane as usize) }
        }
        Record::MovePlane { brush, plane, offset } => {
            Edit::MovePlane { brush: BrushId(brush), plane: PlaneIdx(plane as usize), offset }
        }
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
        Record::SetRole { brush, role } => Edit::SetRole { brush: BrushId(brush), role: role.into() },
        Record::Undo {} => Edit::Undo,
        Record::Redo {} => Edit::Redo,
    })
}

fn half_space([x, y, z, d]: [f64; 4]) -> Result<HalfSpace, Fault> {
    HalfSpace::new(DVec3::new(x, y, z), d)
        .map_err(|error| Fault::new(format!("plane {:?}", [x, y, z, d]), format!("a half-space: {error}")))
}

fn transform(rows: &[[f64; 4]]) -> Result<Transform, Fault> {
    const EXPECTED: &str = "3 or 4 rows of 4, the fourth [0, 0, 0, 1]";
    let (rows, last) = match rows {
        [a, b, c] => ([*a, *b, *c], [0.0, 0.0, 0.0, 1.0]),
        [a, b, c, d] => ([*a, *b, *c], *d),
        _ => return Err(Fault::new(format!("a matrix of {} rows", rows.len()), EXPECTED)),
    };
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(Fault::new(format!("a matrix whose last row is {last:?}"), EXPECTED));
    }
    let column = |column: usize| DVec3::new(rows[0][column], rows[1][column], rows[2][column]);
    Transform::new(DMat3::from_cols(column(0), column(1), column(2)), column(3))
        .map_err(|error| Fault::new(format!("matrix {rows:?}"), format!("an affine map that can be undone: {error}")))
}

fn brush(
    planes: &[[f64; 4]],
    material: Option<MaterialNames>,
    name: Option<String>,
    names: &mut Names,
) -> Result<Brush, Fault> {
    let count = planes.len();
    let materials: Vec<MaterialId> = match material {
        None => vec![names.default(); count],
        Some(MaterialNames::One(name)) => vec![names.number(&name); count],
        Some(MaterialNames::Each(each)) if each.len() == count => each.iter().map(|name| names.number(name)).collect(),
        Some(MaterialNames::Each(each)) => {
            let found = format!("{} materials", each.len());
            return Err(Fault::new(found, format!("one, or one for each of {count} planes")));
        }
    };
    let face = |(plane, material): (&[f64; 4], MaterialId)| Ok(BrushFace { half_space: half_space(*plane)?, material });
    let faces = planes.iter().zip(materials).map(face).collect::<Result<_, Fault>>()?;
    Ok(Brush { faces, name, mesh: None })
}

/// The names of the materials of a brush, as short as may be.
fn material_names(brush: &Brush, name: &impl Fn(MaterialId) -> Option<String>) -> Option<MaterialNames> {
    let names: Vec<String> = brush.faces.iter().filter_map(|face| name(face.material)).collect();
    let (first, others) = names.split_first()?;
    if others.iter().all(|other| other == first) {
        return Some(MaterialNames::One(first.clone()));
    }
    (names.len() == brush.faces.len()).then_some(MaterialNames::Each(names))
}

fn planes(brush: &Brush) -> Vec<[f64; 4]> {
    brush.faces.iter().map(|face| plane(&face.half_space)).collect()
}

impl Record {
    /// Nothing for an edit of a kind that has no form as a line.
    fn of(edit: &Edit, name: &impl Fn(MaterialId) -> Option<String>) -> Option<Self> {
        Some(match edit {
            Edit::AddPlane { brush, half_space, material } => {
                Self::AddPlane { brush: brush.0, plane: plane(half_space), material: material.and_then(name) }
            }
            Edit::RemovePlane { brush, plane } => {
                Self::RemovePlane { brush: brush.0, plane: u32::try_from(plane.0).ok()? }
            }
            Edit::MovePlane { brush, plane, offset } => {
                Self::MovePlane { brush: brush.0, plane: u32::try_from(plane.0).ok()?, offset: *offset }
            }
            Edit::AddBrush { brush, .. } | Edit::ReplaceBrush { by: brush, .. } if brush.is_mesh() => return None,
            Edit::AddBrush { brush, role } => Self::AddBrush {
                planes: planes(brush),
                material: material_names(brush, name),
                name: brush.name.clone(),
                role: (*role).into(),
            },
            Edit::RemoveBrush { brush } => Self::RemoveBrush { brush: brush.0 },
            Edit::ReplaceBrush { brush, by } => Self::ReplaceBrush {
                brush: brush.0,
                planes: planes(by),
                material: material_names(by, name),
                name: by.name.clone(),
            },
            Edit::TransformBrush { brush, transform } => {
                let (linear, offset) = (transform.linear(), transform.offset());
                let rows = (0..3).map(|row| linear.row(row).extend(offset[row]).to_array());
                Self::TransformBrush { brush: brush.0, matrix: rows.collect() }
            }
            Edit::SetRole { brush, role } => Self::SetRole { brush: brush.0, role: (*role).into() },
            Edit::Undo => Self::Undo {},
            Edit::Redo => Self::Redo {},
            _ => return None,
        })
    }
}

fn plane(half_space: &HalfSpace) -> [f64; 4] {
    half_space.normal().extend(half_space.offset()).to_array()
}

impl From<RoleName> for Role {
    fn from(name: RoleName) -> Self {
        match name {
            RoleName::Add => Self::Add,
            RoleName::Subtract => Self::Subtract,
            RoleName::Intersect => Self::Intersect,
        }
    }
}

impl From<Role> for RoleName {
    fn from(role: Role) -> Self {
        match role {
            Role::Add => Self::Add,
            Role::Subtract => Self::Subtract,
            Role::Intersect => Self::Intersect,
        }
    }
}

#[cfg(test)]
mod tests {
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
{"op": "undo"}
{"op": "redo"}"#;
        let import = read_edits(text, "e", &known()).unwrap();
        let lines: Vec<u32> = import.edits.iter().map(|edit| edit.0).collect();
        assert_eq!(lines, [1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12]);
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
        let cases: [(&str, &str); 9] = [
            (r#"{"op": "explode"}"#, "unknown variant `explode`"),
            (r#"{"op": "undo", "brush": 1}"#, "unknown field `brush`"),
            (r#"{"op": "remove_brush"}"#, "missing field `brush`"),
            (r#"{"op": "remove_brush", "brush": -1}"#, "invalid value: integer `-1`"),
            (r#"{"op": "add_plane", "brush": 0, "plane": [0, 0, 0, 1]}"#, "plane [0.0, 0.0, 0.0, 1.0]"),
            (r#"{"op": "add_plane", "brush": 0, "plane": [0, 0, NaN, 1]}"#, "expected value"),
            (r#"{"op": "transform_brush", "brush": 0, "matrix": [[1,0,0,0]]}"#, "a matrix of 1 rows"),
            (r#"{"op": "transform_brush", "brush": 0, "matrix": [[0,0,0,0],[0,1,0,0],[0,0,1,0]]}"#, "matrix [[0.0"),
            (r#"{"op": "add_brush", "planes": [[1,0,0,1]], "material": ["a", "b"]}"#, "2 materials"),
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
}
