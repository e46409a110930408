//! A live model that a program drives by messages: edits and queries as JSON objects, each answered by one. `planecut edit --serve` reads them line by line, a page
//! in a browser sends them to its worker. [Serving an editor](https://docs.rs/crate/planecut/latest/source/docs/command-line.md) has all of them.
//!
//! `request` is what a message asks for, `answer` what it gets, `measures` the longest of these.

mod answer;
mod measures;
mod request;

use std::path::Path;

use crate::csg::{
    BrushId, EditError, EvaluateError, FaceId, LiveModel, Material, NodeId, SnapOptions, SnapTarget, TreeOperand,
};
use crate::import::Warning;
use crate::import::edits::edit_of_keys;
use crate::kernel::{DVec3, HalfSpace, PlaneIdx};
use serde_json::{Map, Value, json};

pub use answer::refusal;
use answer::{keys, operand, success};
use measures::measures;
use request::{Asked, Query, Request};

/// A live model that is edited by messages.
///
/// ```
/// use planecut::csg::LiveModel;
/// use planecut::session::Session;
///
/// # fn main() -> Result<(), serde_json::Error> {
/// let mut session = Session::new(LiveModel::new(Vec::new()));
/// let box_of = r#"{"op": "add_brush", "planes": [[1, 0, 0, 2], [-1, 0, 0, 0], [0, 1, 0, 2], [0, -1, 0, 0], [0, 0, 1, 2], [0, 0, -1, 0]]}"#;
/// let answer = session.answer(box_of.as_bytes(), |_, _| Err("found a file, expected none".into()));
/// assert_eq!(answer.message["added"].as_array().map(Vec::len), Some(6));
/// let answer = session.answer(br#"{"query": "measures"}"#, |_, _| Err("found a file, expected none".into()));
/// assert_eq!(answer.message["volume"], 8.0);
/// # Ok(())
/// # }
/// ```
pub struct Session {
    live: LiveModel,
}

/// What a message gets.
pub struct Answer {
    /// The answer.
    pub message: Value,
    /// A bug that an edit has shown: the model cannot be trusted any more.
    pub bug: Option<EvaluateError>,
}

/// The content of an answer, or why there is none.
type Content = Result<Map<String, Value>, String>;

/// Writes a model to a file; gives what there is to warn of, or says what is wrong.
type Save<'a> = &'a mut dyn FnMut(&LiveModel, &Path) -> Result<Vec<Warning>, String>;

impl Session {
    /// A session on a model.
    #[must_use]
    pub fn new(live: LiveModel) -> Self {
        Self { live }
    }

    /// The model as it is now.
    #[must_use]
    pub fn live(&self) -> &LiveModel {
        &self.live
    }

    /// The model, for calls that no message makes.
    pub fn live_mut(&mut self) -> &mut LiveModel {
        &mut self.live
    }

    /// The answer to a message, a JSON object in UTF-8. `save` writes the model to a file, gives what there is to warn of, or says what is wrong.
    pub fn answer(
        &mut self,
        text: &[u8],
        mut save: impl FnMut(&LiveModel, &Path) -> Result<Vec<Warning>, String>,
    ) -> Answer {
        let Request { id, asked } = Request::read(text, self.live.materials());
        let mut bug = None;
        let content = match asked {
            Err(fault) => Err(fault),
            Ok(Asked::Query { query, buffers }) => self.query(query, buffers, &mut save),
            Ok(Asked::Edit { edit, materials, buffers }) => match self.live.apply_with(edit, materials) {
                Ok(edited) => Ok(answer::edited(&self.live, &edited, buffers)),
                Err(error) => {
                    let message = error.to_string();
                    if let EditError::Evaluate(source @ EvaluateError::Weld(_)) = error {
                        bug = Some(source);
                    }
                    Err(message)
                }
            },
        };
        let message = match content {
            Ok(content) => success(id, content),
            Err(error) => refusal(id, &error),
        };
        Answer { message, bug }
    }

    fn query(&mut self, query: Query, buffers: bool, save: Save<'_>) -> Content {
        match query {
            Query::Faces {} => {
                let all = || self.live.faces().map(|(id, _)| id);
                let faces = match buffers {
                    true => answer::faces(&self.live, all()),
                    false => all().map(u32::from).collect(),
                };
                Ok(keys(json!({"faces": faces})))
            }
            Query::Face { face } => answer::face(&self.live, FaceId::from(face))
                .ok_or_else(|| format!("found face {face}, expected one that is part of the boundary")),
            Query::Pick { origin, direction } => Ok(keys(json!({"hit": self.pick(origin.into(), direction.into())}))),
            Query::Measures { volumes } => measures(&mut self.live, volumes).map_err(|error| error.to_string()),
            Query::Brush { brush } => self.brush(BrushId(brush)).map_err(|error| error.to_string()),
            Query::Tree {} => self.tree().map_err(|error| error.to_string()),
            Query::Materials {} => {
                Ok(keys(json!({"materials": self.live.materials().iter().map(material).collect::<Vec<Value>>()})))
            }
            Query::Snap { brush, plane, to, grid, planes, vertices } => {
                let options = SnapOptions { grid, planes, vertices };
                self.snap(BrushId(brush), PlaneIdx(plane as usize), to, &options)
            }
            Query::Preview { edit } => {
                let (edit, materials) = edit_of_keys(edit, self.live.materials()).map_err(|fault| fault.to_string())?;
                let names: Vec<String> =
                    self.live.materials().iter().chain(&materials).map(|material| material.name.clone()).collect();
                let preview = self.live.preview_with(edit, materials).map_err(|error| error.to_string())?;
                Ok(answer::preview(&preview, |material| names[material as usize].clone()))
            }
            Query::PreviewRemovePlane { brush, plane } => {
                let removal = self.live.preview_remove_plane(BrushId(brush), PlaneIdx(plane as usize));
                Ok(answer::removal(&removal.map_err(|error| error.to_string())?))
            }
            Query::Save { output } => {
                let warnings = save(&self.live, &output)?;
                let warnings: Vec<String> = warnings.into_iter().map(|warning| warning.message).collect();
                Ok(keys(json!({"output": output.display().to_string(), "warnings": warnings})))
            }
        }
    }

    fn pick(&self, origin: DVec3, direction: DVec3) -> Value {
        let Some((face, distance)) = self.live.pick(origin, direction) else { return Value::Null };
        let source = self.live.source_of_face(face);
        let point = origin + distance * direction.normalize_or_zero();
        json!({
            "face": u32::from(face),
            "distance": distance,
            "point": point.to_array(),
            "brush": source.map(|(brush, _)| brush.0),
            "plane": source.map(|(_, plane)| plane.0),
        })
    }

    fn brush(&self, id: BrushId) -> Result<Map<String, Value>, EditError> {
        let (brush, role) = self.live.brush(id)?;
        let materials = self.live.materials();
        let planes = self.live.planes(id)?.iter().zip(&brush.faces).map(|(plane, face)| {
            json!({
                "plane": plane.0,
                "half_space": face.half_space.to_array(),
                "material": materials[face.material.0 as usize].name,
            })
        });
        Ok(keys(json!({
            "brush": id.0,
            "name": brush.name,
            "role": role.name(),
            "parent": self.live.parent(id)?.map(|node| node.0),
            "planes": planes.collect::<Vec<Value>>(),
        })))
    }

    fn tree(&self) -> Result<Map<String, Value>, EditError> {
        let live = &self.live;
        let operands = |of: Option<NodeId>| Ok::<_, EditError>(live.operands(of)?.map(operand).collect::<Vec<Value>>());
        let mut parts = Vec::new();
        for part in live.operands(None)? {
            let role = match part {
                TreeOperand::Brush(id) => live.brush(id)?.1,
                TreeOperand::Node(id) => live.node(id)?.role,
            };
            let mut part = operand(part);
            part["role"] = role.name().into();
            parts.push(part);
        }
        let mut nodes = Vec::new();
        for id in live.nodes() {
            let node = live.node(id)?;
            nodes.push(json!({
                "node": id.0,
                "operation": node.operation.name(),
                "parent": node.parent.map(|node| node.0),
                "operands": operands(Some(id))?,
            }));
        }
        Ok(keys(json!({"parts": parts, "nodes": nodes})))
    }

    fn snap(&self, brush: BrushId, plane: PlaneIdx, to: [f64; 4], options: &SnapOptions) -> Content {
        let half_space =
            HalfSpace::from_array(to).map_err(|error| format!("found plane {to:?}, expected a half-space: {error}"))?;
        let snap = self.live.snap_plane(brush, plane, &half_space, options).map_err(|error| error.to_string())?;
        let snap = snap.map(|snap| {
            let target = match snap.to {
                SnapTarget::Plane { brush, plane } => json!({"brush": brush.0, "plane": plane.0}),
                SnapTarget::Vertex(at) => json!({"vertex": at.to_array()}),
                SnapTarget::Grid => json!({"grid": options.grid}),
            };
            json!({"to": snap.half_space.to_array(), "distance": snap.distance, "target": target})
        });
        Ok(keys(json!({"snap": snap})))
    }
}

fn material(material: &Material) -> Value {
    let Material { name, color, metallic, roughness } = material;
    json!({"name": name, "color": color, "metallic": metallic, "roughness": roughness})
}
