//! The calls that edits and previews have in common: each is written once, as what makes the edit of the library.

use std::sync::Arc;

use planecut::csg::{BrushId, Edit as CoreEdit, Material, Role, TreeOperand};
use planecut::expression::{self, EditMaterials};
use planecut::kernel::{HalfSpace, PlaneIdx};
use pyo3::prelude::*;

use super::tree::{Node, operand_of, operation_of};
use crate::arrays::row;
use crate::errors::{Failure, Outcome, refuse};
use crate::solid::{Solid, transform_of};

/// A call, which makes its edit once the materials of the model are known.
pub(super) struct Call(Box<MakeEdit>);

type MakeEdit = dyn FnOnce(&mut EditMaterials<'_>) -> Outcome<CoreEdit> + Send;

impl From<CoreEdit> for Call {
    fn from(edit: CoreEdit) -> Self {
        Self::of(move |_| Ok(edit))
    }
}

impl Call {
    fn of(make: impl FnOnce(&mut EditMaterials<'_>) -> Outcome<CoreEdit> + Send + 'static) -> Self {
        Self(Box::new(make))
    }

    /// The edit for a model of these materials, and those that it names for the first time.
    pub(super) fn edit_of(self, known: &[Material]) -> Outcome<(CoreEdit, Vec<Material>)> {
        let mut materials = EditMaterials::new(known);
        let edit = self.0(&mut materials)?;
        Ok((edit, materials.into_new()))
    }
}

pub(super) fn move_plane(brush: u64, plane: usize, offset: f64) -> Call {
    CoreEdit::MovePlane { brush: BrushId(brush), plane: PlaneIdx(plane), offset }.into()
}

pub(super) fn turn_plane(brush: u64, plane: usize, to: &Bound<'_, PyAny>) -> PyResult<Call> {
    let half_space = half_space_of(to, "to")?;
    Ok(CoreEdit::TurnPlane { brush: BrushId(brush), plane: PlaneIdx(plane), half_space }.into())
}

pub(super) fn set_material(brush: u64, material: String, plane: Option<usize>) -> Call {
    let (brush, plane) = (BrushId(brush), plane.map(PlaneIdx));
    Call::of(move |materials| Ok(CoreEdit::SetMaterial { brush, plane, material: materials.named(&material) }))
}

pub(super) fn rename_brush(brush: u64, name: Option<String>) -> Call {
    CoreEdit::RenameBrush { brush: BrushId(brush), name }.into()
}

pub(super) fn copy_brushes(brushes: Vec<u64>, matrix: &Bound<'_, PyAny>) -> PyResult<Call> {
    let transform = transform_of(matrix)?;
    Ok(CoreEdit::CopyBrushes { brushes: brush_ids(brushes), transform }.into())
}

pub(super) fn mirror_brushes(brushes: Vec<u64>, plane: &Bound<'_, PyAny>) -> PyResult<Call> {
    let plane = half_space_of(plane, "plane")?;
    Ok(CoreEdit::MirrorBrushes { brushes: brush_ids(brushes), plane }.into())
}

pub(super) fn array_brushes(brushes: Vec<u64>, matrix: &Bound<'_, PyAny>, count: usize) -> PyResult<Call> {
    let transform = transform_of(matrix)?;
    Ok(CoreEdit::ArrayBrushes { brushes: brush_ids(brushes), transform, count }.into())
}

pub(super) fn add_plane(brush: u64, plane: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<Call> {
    let (brush, half_space) = (BrushId(brush), half_space_of(plane, "plane")?);
    Ok(Call::of(move |materials| {
        let material = material.map(|name| materials.named(&name));
        Ok(CoreEdit::AddPlane { brush, half_space, material })
    }))
}

pub(super) fn remove_plane(brush: u64, plane: usize) -> Call {
    CoreEdit::RemovePlane { brush: BrushId(brush), plane: PlaneIdx(plane) }.into()
}

pub(super) fn add_brush(solid: &Bound<'_, Solid>, role: &str) -> PyResult<Call> {
    let (role, node) = (role_of(role)?, node_of(solid));
    Ok(Call::of(move |materials| Ok(CoreEdit::AddBrush { brush: materials.brush_of(&node)?, role })))
}

pub(super) fn remove_brush(brush: u64) -> Call {
    CoreEdit::RemoveBrush { brush: BrushId(brush) }.into()
}

pub(super) fn replace_brush(brush: u64, solid: &Bound<'_, Solid>) -> Call {
    let (brush, node) = (BrushId(brush), node_of(solid));
    Call::of(move |materials| Ok(CoreEdit::ReplaceBrush { brush, by: materials.brush_of(&node)? }))
}

pub(super) fn transform_brush(brush: u64, matrix: &Bound<'_, PyAny>) -> PyResult<Call> {
    let transform = transform_of(matrix)?;
    Ok(CoreEdit::TransformBrush { brush: BrushId(brush), transform }.into())
}

pub(super) fn set_role(operand: &Bound<'_, PyAny>, role: &str) -> PyResult<Call> {
    Ok(CoreEdit::SetRole { operand: operand_of(operand, "operand")?, role: role_of(role)? }.into())
}

pub(super) fn set_operation(node: &Bound<'_, Node>, operation: &str) -> PyResult<Call> {
    Ok(CoreEdit::SetOperation { node: node.get().id(), operation: operation_of(operation)? }.into())
}

pub(super) fn wrap(operands: &[Bound<'_, PyAny>], operation: &str) -> PyResult<Call> {
    let operands = operands.iter().map(|operand| operand_of(operand, "operands")).collect::<PyResult<_>>()?;
    Ok(CoreEdit::Wrap { operands, operation: operation_of(operation)? }.into())
}

pub(super) fn dissolve(node: &Bound<'_, Node>) -> Call {
    CoreEdit::Dissolve { node: node.get().id() }.into()
}

pub(super) fn move_operand(
    operand: &Bound<'_, PyAny>,
    to: Option<&Bound<'_, Node>>,
    before: Option<&Bound<'_, PyAny>>,
) -> PyResult<Call> {
    let operand = operand_of(operand, "operand")?;
    let before: Option<TreeOperand> = before.map(|before| operand_of(before, "before")).transpose()?;
    Ok(CoreEdit::MoveOperand { operand, to: to.map(|node| node.get().id()), before }.into())
}

pub(super) fn move_brush_before(brush: u64, before: Option<u64>) -> Call {
    CoreEdit::MoveBrushBefore { brush: BrushId(brush), before: before.map(BrushId) }.into()
}

pub(super) fn remove_node(node: &Bound<'_, Node>) -> Call {
    CoreEdit::RemoveNode { node: node.get().id() }.into()
}

/// A half-space of shape (4,).
pub(super) fn half_space_of(value: &Bound<'_, PyAny>, name: &str) -> PyResult<HalfSpace> {
    Ok(HalfSpace::from_array(row::<4>(value, name)?).map_err(Failure::of)?)
}

fn node_of(solid: &Bound<'_, Solid>) -> Arc<expression::Node> {
    Arc::clone(solid.get().node())
}

fn brush_ids(numbers: Vec<u64>) -> Vec<BrushId> {
    numbers.into_iter().map(BrushId).collect()
}

fn role_of(name: &str) -> PyResult<Role> {
    match name {
        "add" => Ok(Role::Add),
        "subtract" => Ok(Role::Subtract),
        "intersect" => Ok(Role::Intersect),
        found => Err(refuse(format!("role: found {found:?}, expected \"add\", \"subtract\" or \"intersect\""))),
    }
}
