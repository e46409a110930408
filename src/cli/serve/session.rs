//! A live model, and what is done to it and asked of it.

use planecut::csg::{
    BrushId, EditError, EvaluateError, FaceId, LiveModel, Material, NodeId, SnapOptions, SnapTarget, TreeOperand,
};
use planecut::import::edits::edit_of_keys;
use planecut::kernel::{DVec3, HalfSpace, PlaneIdx};
use serde_json::{Map, Value, json};

use super::answer::{self, keys, operand, refusal, success};
use super::measures::measures;
use super::request::{Asked, Query, Request};
use super::save::save;
use crate::cli::args::EditArgs;
use crate::cli::error::CliError;
use crate::cli::input::{Input, InputKind};

/// A live model that is edited, and the arguments by which it is written.
pub(super) struct Session<'a> {
    live: LiveModel,
    args: &'a EditArgs,
    input: &'a Input,
    kind: InputKind,
}

/// The content of an answer, or why there is none.
type Content = Result<Map<String, Value>, String>;

impl<'a> Session<'a> {
    pub(super) fn new(live: LiveModel, args: &'a EditArgs, input: &'a Input, kind: InputKind) -> Self {
        Self { live, args, input, kind }
    }

    /// The answer to a line; after a bug the session cannot go on.
    pub(super) fn answer(&mut self, text: &[u8]) -> (Value, Result<(), CliError>) {
        let Request { id, asked } = Request::read(text, self.live.materials());
        let mut outcome = Ok(());
        let content = match asked {
            Err(fault) => Err(fault),
            Ok(Asked::Query { query, buffers }) => self.query(query, buffers),
            Ok(Asked::Edit { edit, materials, buffers }) => match self.live.apply_with(edit, materials) {
                Ok(edited) => Ok(answer::edited(&self.live, &edited, buffers)),
                Err(error) => {
                    if let EditError::Evaluate(source @ EvaluateError::Weld(_)) = error {
                        outcome = Err(CliError::of_evaluation(&self.input.path, source));
                    }
                    Err(error.to_string())
                }
            },
        };
        let answer = match content {
            Ok(content) => success(id, content),
            Err(error) => refusal(id, &error),
        };
        (answer, outcome)
    }

    fn query(&mut self, query: Query, buffers: bool) -> Content {
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
                let warnings =
                    save(&self.live, self.args, self.input, self.kind, &output).map_err(|error| error.to_string())?;
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
