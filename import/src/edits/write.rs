//! Writes lists of edits.

use planecut_csg::{Brush, BrushId, Edit, Material, MaterialId, Transform, TreeOperand};
use planecut_kernel::PlaneIdx;

use super::record::{MaterialNames, Record};

/// Writes edits, a line each, as [`read_edits`](super::read_edits) reads them. Those that put a closed mesh into the model have no such form, and are left out.
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
    brush.faces.iter().map(|face| face.half_space.to_array()).collect()
}

impl Record {
    /// Nothing for an edit of a kind that has no form as a line.
    fn of(edit: &Edit, name: &impl Fn(MaterialId) -> Option<String>) -> Option<Self> {
        Some(match edit {
            Edit::AddPlane { brush, half_space, material } => {
                Self::AddPlane { brush: brush.0, plane: half_space.to_array(), material: material.and_then(name) }
            }
            Edit::RemovePlane { brush, plane } => Self::RemovePlane { brush: brush.0, plane: number(*plane)? },
            Edit::MovePlane { brush, plane, offset } => {
                Self::MovePlane { brush: brush.0, plane: number(*plane)?, offset: Some(*offset), to: None }
            }
            Edit::TurnPlane { brush, plane, half_space } => {
                let to = Some(half_space.to_array());
                Self::MovePlane { brush: brush.0, plane: number(*plane)?, offset: None, to }
            }
            Edit::SetMaterial { brush, plane, material } => Self::SetMaterial {
                brush: brush.0,
                plane: match plane {
                    Some(plane) => Some(number(*plane)?),
                    None => None,
                },
                material: name(*material)?,
            },
            Edit::RenameBrush { brush, name } => Self::RenameBrush { brush: brush.0, name: name.clone() },
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
                Self::TransformBrush { brush: brush.0, matrix: matrix(transform) }
            }
            Edit::SetRole { operand, role } => {
                let (brush, node) = match operand {
                    TreeOperand::Brush(id) => (Some(id.0), None),
                    TreeOperand::Node(id) => (None, Some(id.0)),
                };
                Self::SetRole { brush, node, role: (*role).into() }
            }
            Edit::CopyBrushes { brushes, transform } => {
                Self::CopyBrushes { brushes: numbers(brushes), matrix: matrix(transform) }
            }
            Edit::MirrorBrushes { brushes, plane } => {
                Self::MirrorBrushes { brushes: numbers(brushes), plane: plane.to_array() }
            }
            Edit::ArrayBrushes { brushes, transform, count } => Self::ArrayBrushes {
                brushes: numbers(brushes),
                matrix: matrix(transform),
                count: u32::try_from(*count).ok()?,
            },
            Edit::MoveBrushBefore { brush, before } => {
                Self::MoveBrushBefore { brush: brush.0, before: before.map(|brush| brush.0) }
            }
            Edit::MoveOperand { operand, to, before } => Self::MoveOperand {
                operand: (*operand).into(),
                to: to.map(|node| node.0),
                before: before.map(Into::into),
            },
            Edit::SetOperation { node, operation } => {
                Self::SetOperation { node: node.0, operation: (*operation).into() }
            }
            Edit::Wrap { operands, operation } => Self::Wrap {
                operands: operands.iter().map(|operand| (*operand).into()).collect(),
                operation: (*operation).into(),
            },
            Edit::Dissolve { node } => Self::Dissolve { node: node.0 },
            Edit::RemoveNode { node } => Self::RemoveNode { node: node.0 },
            Edit::BeginStep => Self::Begin {},
            Edit::CommitStep => Self::Commit {},
            Edit::CancelStep => Self::Cancel {},
            Edit::Undo => Self::Undo {},
            Edit::Redo => Self::Redo {},
            _ => return None,
        })
    }
}

fn number(plane: PlaneIdx) -> Option<u32> {
    u32::try_from(plane.0).ok()
}

fn numbers(brushes: &[BrushId]) -> Vec<u64> {
    brushes.iter().map(|brush| brush.0).collect()
}

fn matrix(transform: &Transform) -> Vec<[f64; 4]> {
    let (linear, offset) = (transform.linear(), transform.offset());
    (0..3).map(|row| linear.row(row).extend(offset[row]).to_array()).collect()
}
