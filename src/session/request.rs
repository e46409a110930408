//! What a line asks for.

use std::path::PathBuf;

use crate::csg::{Edit, Material};
use crate::import::edits::edit_of_keys;
use serde::Deserialize;
use serde_json::{Map, Value};

/// Keys that may stand beside those of an edit or a query.
const BESIDE: [&str; 2] = ["id", "buffers"];

/// A line that was read.
pub(super) struct Request {
    /// What the answer is to repeat.
    pub(super) id: Option<Value>,
    /// What is asked for, or what is wrong with the line.
    pub(super) asked: Result<Asked, String>,
}

/// What is asked for.
pub(super) enum Asked {
    /// An edit, the materials that it names for the first time, and whether the triangles of new faces are wanted.
    Edit { edit: Edit, materials: Vec<Material>, buffers: bool },
    /// What is asked of the model, and whether triangles are wanted.
    Query { query: Query, buffers: bool },
}

/// A question about the model, which it does not change.
#[derive(Debug, Deserialize)]
#[serde(tag = "query", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Query {
    /// The numbers of all faces.
    Faces {},
    /// One face.
    Face { face: u32 },
    /// The first face that a ray meets.
    Pick { origin: [f64; 3], direction: [f64; 3] },
    /// Volume, area, box and counts, and the volume of each material where it is asked for.
    Measures {
        #[serde(default)]
        volumes: bool,
    },
    /// A brush with its planes.
    Brush { brush: u64 },
    /// How brushes are combined.
    Tree {},
    /// The materials.
    Materials {},
    /// Where a plane is meant to go.
    Snap { brush: u64, plane: u32, to: [f64; 4], grid: Option<f64>, planes: Option<f64>, vertices: Option<f64> },
    /// What an edit would change.
    Preview { edit: Map<String, Value> },
    /// What a brush would gain without a plane.
    PreviewRemovePlane { brush: u64, plane: u32 },
    /// Writes the model to a file.
    Save { output: PathBuf },
}

impl Request {
    /// Reads a line, which may name some of the materials that are known, or new ones.
    pub(super) fn read(text: &[u8], known: &[Material]) -> Self {
        let mut keys: Map<String, Value> = match serde_json::from_slice(text) {
            Ok(keys) => keys,
            Err(error) => return Self { id: None, asked: Err(not_one(&error)) },
        };
        let id = keys.get("id").cloned();
        let buffers = match keys.get("buffers") {
            None => false,
            Some(Value::Bool(buffers)) => *buffers,
            Some(other) => {
                return Self { id, asked: Err(format!("found \"buffers\": {other}, expected true or false")) };
            }
        };
        if !keys.contains_key("query") {
            keys.retain(|key, _| !BESIDE.contains(&key.as_str()));
            let edit = edit_of_keys(keys, known);
            let edit = edit.map(|(edit, materials)| Asked::Edit { edit, materials, buffers });
            return Self { id, asked: edit.map_err(|fault| fault.to_string()) };
        }
        keys.retain(|key, _| !BESIDE.contains(&key.as_str()));
        let query = Query::deserialize(Value::Object(keys)).map(|query| Asked::Query { query, buffers });
        Self { id, asked: query.map_err(|error| not_one(&error)) }
    }
}

fn not_one(error: &serde_json::Error) -> String {
    format!("found {error}, expected a JSON object with \"op\" or \"query\" and what belongs to it")
}
