//! Edits of a live model as values, to be kept in a list.

use planecut_kernel::{HalfSpace, PlaneIdx};

use super::{BrushId, Change, EditError, LiveModel, NodeId, Role, TreeOperand};
use crate::model::{Brush, Material, MaterialId, Operation, Transform};

/// An edit, to be kept in a list and applied again: see [`LiveModel::apply`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// [`LiveModel::add_plane`].
    AddPlane {
        /// The brush.
        brush: BrushId,
        /// What its body is cut down to.
        half_space: HalfSpace,
        /// What the face on the plane is made of; where nothing is said, that of the first face of the brush.
        material: Option<MaterialId>,
    },
    /// [`LiveModel::remove_plane`].
    RemovePlane {
        /// The brush.
        brush: BrushId,
        /// The plane.
        plane: PlaneIdx,
    },
    /// [`LiveModel::move_plane`], along its normal.
    MovePlane {
        /// The brush.
        brush: BrushId,
        /// The plane.
        plane: PlaneIdx,
        /// The new offset, for the normal as it was given.
        offset: f64,
    },
    /// [`LiveModel::move_plane`], to another normal as well.
    TurnPlane {
        /// The brush.
        brush: BrushId,
        /// The plane.
        plane: PlaneIdx,
        /// What is to be in its place.
        half_space: HalfSpace,
    },
    /// [`LiveModel::set_material`].
    SetMaterial {
        /// The brush.
        brush: BrushId,
        /// The plane; where none is named, all of the brush.
        plane: Option<PlaneIdx>,
        /// What it is made of from now on.
        material: MaterialId,
    },
    /// [`LiveModel::rename_brush`].
    RenameBrush {
        /// The brush.
        brush: BrushId,
        /// Its name, if it is to have one.
        name: Option<String>,
    },
    /// [`LiveModel::add_brush`].
    AddBrush {
        /// The brush.
        brush: Brush,
        /// What it does.
        role: Role,
    },
    /// [`LiveModel::remove_brush`].
    RemoveBrush {
        /// The brush.
        brush: BrushId,
    },
    /// [`LiveModel::replace_brush`].
    ReplaceBrush {
        /// The brush.
        brush: BrushId,
        /// What takes its place.
        by: Brush,
    },
    /// [`LiveModel::transform_brush`].
    TransformBrush {
        /// The brush.
        brush: BrushId,
        /// The map.
        transform: Transform,
    },
    /// [`LiveModel::set_role`].
    SetRole {
        /// The brush or the operation.
        operand: TreeOperand,
        /// What it does from now on.
        role: Role,
    },
    /// [`LiveModel::copy_brushes`].
    CopyBrushes {
        /// The brushes.
        brushes: Vec<BrushId>,
        /// Where the copies go.
        transform: Transform,
    },
    /// [`LiveModel::mirror_brushes`].
    MirrorBrushes {
        /// The brushes.
        brushes: Vec<BrushId>,
        /// The plane; either side of it means the same.
        plane: HalfSpace,
    },
    /// [`LiveModel::array_brushes`].
    ArrayBrushes {
        /// The brushes.
        brushes: Vec<BrushId>,
        /// The way from each copy to the next one.
        transform: Transform,
        /// How many copies of each.
        count: usize,
    },
    /// [`LiveModel::move_operand`].
    MoveOperand {
        /// What is to go elsewhere.
        operand: TreeOperand,
        /// The operation that it is to be an operand of; `None` is the model itself.
        to: Option<NodeId>,
        /// The operand before which it goes; the last one where there is none.
        before: Option<TreeOperand>,
    },
    /// [`LiveModel::move_brush_before`].
    MoveBrushBefore {
        /// The brush.
        brush: BrushId,
        /// The other brush; where there is none, it is the last one.
        before: Option<BrushId>,
    },
    /// [`LiveModel::set_operation`].
    SetOperation {
        /// The operation.
        node: NodeId,
        /// What it does from now on.
        operation: Operation,
    },
    /// [`LiveModel::wrap`].
    Wrap {
        /// What is to be the operands.
        operands: Vec<TreeOperand>,
        /// What to do with them.
        operation: Operation,
    },
    /// [`LiveModel::dissolve`].
    Dissolve {
        /// The operation.
        node: NodeId,
    },
    /// [`LiveModel::remove_node`].
    RemoveNode {
        /// The operation.
        node: NodeId,
    },
    /// [`LiveModel::begin_step`].
    BeginStep,
    /// [`LiveModel::commit_step`].
    CommitStep,
    /// [`LiveModel::cancel_step`].
    CancelStep,
    /// [`LiveModel::undo`].
    Undo,
    /// [`LiveModel::redo`].
    Redo,
}

/// What an [`Edit`] came to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Edited {
    /// The number of a brush that was added.
    pub brush: Option<BrushId>,
    /// The handle of a plane that was added.
    pub plane: Option<PlaneIdx>,
    /// The numbers of copies that were made, one after another of each set of brushes.
    pub copies: Vec<BrushId>,
    /// The number of an operation that was added.
    pub node: Option<NodeId>,
    /// What has changed.
    pub change: Change,
}

impl From<Change> for Edited {
    fn from(change: Change) -> Self {
        Self { change, ..Self::default() }
    }
}

impl Edited {
    fn of_copies((copies, change): (Vec<BrushId>, Change)) -> Self {
        Self { copies, ..change.into() }
    }
}

impl LiveModel {
    /// Does an edit which names materials that are new: they come after those that are known. Where it is refused, they are not added either.
    ///
    /// # Errors
    /// As of [`apply`](Self::apply).
    pub fn apply_with(&mut self, edit: Edit, materials: Vec<Material>) -> Result<Edited, EditError> {
        let known = self.materials().len();
        for material in materials {
            self.add_material(material);
        }
        let outcome = self.apply(edit);
        if outcome.is_err() {
            self.keep_materials(known);
        }
        outcome
    }

    /// Does an edit.
    ///
    /// # Errors
    /// Those of the method that the edit stands for.
    pub fn apply(&mut self, edit: Edit) -> Result<Edited, EditError> {
        Ok(match edit {
            Edit::AddPlane { brush, half_space, material } => {
                let first = |brush: &Brush| brush.faces.first().map(|face| face.material);
                let material = material.or(first(self.brush(brush)?.0)).unwrap_or(MaterialId(0));
                let (plane, change) = self.add_plane(brush, half_space, material)?;
                Edited { plane: Some(plane), ..change.into() }
            }
            Edit::RemovePlane { brush, plane } => self.remove_plane(brush, plane)?.into(),
            Edit::MovePlane { brush, plane, offset } => {
                let state = self.convex_state(brush)?;
                let place = state.place_of(plane).ok_or(EditError::UnknownPlane { brush, plane })?;
                let normal = state.brush.faces[place].half_space.normal();
                let half_space = HalfSpace::new(normal, offset).map_err(|_| EditError::Offset(offset))?;
                self.move_plane(brush, plane, half_space)?.into()
            }
            Edit::TurnPlane { brush, plane, half_space } => self.move_plane(brush, plane, half_space)?.into(),
            Edit::SetMaterial { brush, plane, material } => self.set_material(brush, plane, material)?.into(),
            Edit::RenameBrush { brush, name } => self.rename_brush(brush, name)?.into(),
            Edit::AddBrush { brush, role } => {
                let (brush, change) = self.add_brush(brush, role)?;
                Edited { brush: Some(brush), ..change.into() }
            }
            Edit::RemoveBrush { brush } => self.remove_brush(brush)?.into(),
            Edit::ReplaceBrush { brush, by } => self.replace_brush(brush, by)?.into(),
            Edit::TransformBrush { brush, transform } => self.transform_brush(brush, &transform)?.into(),
            Edit::SetRole { operand, role } => self.set_role(operand, role)?.into(),
            Edit::CopyBrushes { brushes, transform } => Edited::of_copies(self.copy_brushes(&brushes, &transform)?),
            Edit::MirrorBrushes { brushes, plane } => Edited::of_copies(self.mirror_brushes(&brushes, &plane)?),
            Edit::ArrayBrushes { brushes, transform, count } => {
                Edited::of_copies(self.array_brushes(&brushes, &transform, count)?)
            }
            Edit::MoveOperand { operand, to, before } => self.move_operand(operand, to, before)?.into(),
            Edit::MoveBrushBefore { brush, before } => self.move_brush_before(brush, before)?.into(),
            Edit::SetOperation { node, operation } => self.set_operation(node, operation)?.into(),
            Edit::Wrap { operands, operation } => {
                let (node, change) = self.wrap(&operands, operation)?;
                Edited { node: Some(node), ..change.into() }
            }
            Edit::Dissolve { node } => self.dissolve(node)?.into(),
            Edit::RemoveNode { node } => self.remove_node(node)?.into(),
            Edit::BeginStep => {
                self.begin_step()?;
                Edited::default()
            }
            Edit::CommitStep => {
                self.commit_step()?;
                Edited::default()
            }
            Edit::CancelStep => self.cancel_step()?.into(),
            Edit::Undo => self.undo()?.into(),
            Edit::Redo => self.redo()?.into(),
        })
    }
}
