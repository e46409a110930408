//! What a line gets: one JSON object.

use crate::csg::{ConvexPiece, Edited, FaceId, LiveModel, PlaneRemoval, Preview, TreeOperand};
use crate::kernel::DVec3;
use serde_json::{Map, Value, json};

/// What is said of a line that asks for what can be done.
pub(super) fn success(id: Option<Value>, mut content: Map<String, Value>) -> Value {
    content.insert("ok".into(), true.into());
    content.extend(id.map(|id| ("id".into(), id)));
    content.into()
}

/// The answer to a message that is refused; `id` is what it is to repeat.
#[must_use]
pub fn refusal(id: Option<Value>, error: &str) -> Value {
    let mut content = Map::from_iter([("ok".into(), false.into()), ("error".into(), error.into())]);
    content.extend(id.map(|id| ("id".into(), id)));
    content.into()
}

/// The keys of an object.
pub(super) fn keys(object: Value) -> Map<String, Value> {
    match object {
        Value::Object(keys) => keys,
        other => Map::from_iter([("value".into(), other)]),
    }
}

/// What an edit has changed.
pub(super) fn edited(live: &LiveModel, edited: &Edited, buffers: bool) -> Map<String, Value> {
    let Edited { brush, plane, copies, node, change } = edited;
    let (undo, redo) = live.history_len();
    let mut content = keys(json!({
        "brushes": change.brushes.iter().map(|brush| brush.0).collect::<Vec<u64>>(),
        "removed": numbers(&change.removed),
        "added": numbers(&change.added),
        "undo": undo,
        "redo": redo,
        "step": live.is_step_open(),
    }));
    content.extend(brush.map(|brush| ("brush".into(), brush.0.into())));
    content.extend(plane.map(|plane| ("plane".into(), plane.0.into())));
    content.extend(node.map(|node| ("node".into(), node.0.into())));
    if !copies.is_empty() {
        content.insert("copies".into(), copies.iter().map(|brush| brush.0).collect());
    }
    if buffers {
        content.insert("faces".into(), faces(live, change.added.iter().copied()));
    }
    content
}

/// Faces that are there, with their triangles.
pub(super) fn faces(live: &LiveModel, faces: impl Iterator<Item = FaceId>) -> Value {
    faces.filter_map(|face| Some(Value::Object(self::face(live, face)?))).collect()
}

/// A face with its triangles, where it is there.
pub(super) fn face(live: &LiveModel, id: FaceId) -> Option<Map<String, Value>> {
    let face = live.face(id)?;
    let (positions, triangles) = face.indexed();
    let source = live.source_of_face(id);
    Some(keys(json!({
        "face": u32::from(id),
        "material": live.materials()[face.material().0 as usize].name,
        "brush": source.map(|(brush, _)| brush.0),
        "plane": source.map(|(_, plane)| plane.0),
        "normal": face.normal().to_array(),
        "positions": places(&positions),
        "triangles": triangles,
    })))
}

/// What an edit would change.
pub(super) fn preview(preview: &Preview, material: impl Fn(u32) -> String) -> Map<String, Value> {
    let face = |face: &crate::csg::PreviewFace| {
        json!({
            "material": material(face.material.0),
            "normal": face.normal.to_array(),
            "positions": places(&face.positions),
            "triangles": face.triangles,
        })
    };
    keys(json!({
        "volume_change": preview.volume_change,
        "brushes": preview.brushes.iter().map(|brush| brush.0).collect::<Vec<u64>>(),
        "removed": numbers(&preview.removed),
        "faces": preview.added.iter().map(face).collect::<Vec<Value>>(),
    }))
}

/// What a brush would gain.
pub(super) fn removal(removal: &PlaneRemoval) -> Map<String, Value> {
    keys(match removal {
        PlaneRemoval::Nothing => json!({"gain": "nothing"}),
        PlaneRemoval::Unbounded => json!({"gain": "unbounded"}),
        PlaneRemoval::Gains(ConvexPiece { half_spaces, positions, triangles, volume }) => json!({
            "gain": "piece",
            "volume": volume,
            "planes": half_spaces.iter().map(|half_space| half_space.to_array()).collect::<Vec<[f64; 4]>>(),
            "positions": places(positions),
            "triangles": triangles,
        }),
    })
}

pub(super) fn numbers(faces: &[FaceId]) -> Vec<u32> {
    faces.iter().map(|face| u32::from(*face)).collect()
}

fn places(positions: &[DVec3]) -> Vec<[f64; 3]> {
    positions.iter().map(DVec3::to_array).collect()
}

pub(super) fn operand(operand: TreeOperand) -> Value {
    match operand {
        TreeOperand::Brush(id) => json!({"brush": id.0}),
        TreeOperand::Node(id) => json!({"node": id.0}),
    }
}
