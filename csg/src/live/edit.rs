//! What can be done to a live model.

use std::sync::Arc;

use planecut_kernel::{HalfSpace, PlaneIdx};

use super::history::New;
use super::operand::State;
use super::{BrushId, Change, EditError, LiveModel, Role};
use crate::model::{Brush, BrushFace, MaterialId, Transform};

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
        /// The brush.
        brush: BrushId,
        /// What it does from now on.
        role: Role,
    },
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
    /// What has changed.
    pub change: Change,
}

impl From<Change> for Edited {
    fn from(change: Change) -> Self {
        Self { change, ..Self::default() }
    }
}

impl LiveModel {
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
            Edit::AddBrush { brush, role } => {
                let (brush, change) = self.add_brush(brush, role)?;
                Edited { brush: Some(brush), ..change.into() }
            }
            Edit::RemoveBrush { brush } => self.remove_brush(brush)?.into(),
            Edit::ReplaceBrush { brush, by } => self.replace_brush(brush, by)?.into(),
            Edit::TransformBrush { brush, transform } => self.transform_brush(brush, &transform)?.into(),
            Edit::SetRole { brush, role } => self.set_role(brush, role)?.into(),
            Edit::Undo => self.undo()?.into(),
            Edit::Redo => self.redo()?.into(),
        })
    }

    /// Cuts a brush down to a half-space; gives the handle of the plane in the brush, which is never given to another one.
    /// [`LiveModel::remove_plane`] lets the brush grow back.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`], [`EditError::Evaluate`].
    pub fn add_plane(
        &mut self,
        brush: BrushId,
        half_space: HalfSpace,
        material: MaterialId,
    ) -> Result<(PlaneIdx, Change), EditError> {
        let mut state = State::clone(self.convex_state(brush)?);
        let plane = PlaneIdx(state.next_plane);
        state.next_plane += 1;
        state.planes.push(plane);
        state.brush.faces.push(BrushFace { half_space, material });
        self.check_materials(&state.brush)?;
        Ok((plane, self.edit_brush(brush, state)?))
    }

    /// Takes a plane out of a brush, which grows to what its other planes leave.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`], [`EditError::UnknownPlane`], [`EditError::Evaluate`].
    pub fn remove_plane(&mut self, brush: BrushId, plane: PlaneIdx) -> Result<Change, EditError> {
        let mut state = State::clone(self.convex_state(brush)?);
        let place = state.place_of(plane).ok_or(EditError::UnknownPlane { brush, plane })?;
        state.planes.remove(place);
        state.brush.faces.remove(place);
        self.edit_brush(brush, state)
    }

    /// Puts another half-space in the place of a plane of a brush, which keeps its handle and its material.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`], [`EditError::UnknownPlane`], [`EditError::Evaluate`].
    pub fn move_plane(&mut self, brush: BrushId, plane: PlaneIdx, half_space: HalfSpace) -> Result<Change, EditError> {
        let mut state = State::clone(self.convex_state(brush)?);
        let place = state.place_of(plane).ok_or(EditError::UnknownPlane { brush, plane })?;
        state.brush.faces[place].half_space = half_space;
        self.edit_brush(brush, state)
    }

    /// Adds a brush, which may be a closed mesh, after all others.
    ///
    /// # Errors
    /// [`EditError::Evaluate`].
    pub fn add_brush(&mut self, brush: Brush, role: Role) -> Result<(BrushId, Change), EditError> {
        let (ids, change) = self.add_brushes(vec![(brush, role)])?;
        Ok((ids[0], change))
    }

    /// Adds brushes after all others, in their order, as one edit.
    ///
    /// # Errors
    /// [`EditError::Evaluate`]; then none is added.
    pub fn add_brushes(&mut self, brushes: Vec<(Brush, Role)>) -> Result<(Vec<BrushId>, Change), EditError> {
        let first = self.next_id;
        let (change, before, after) = self.append(brushes.into_iter().map(|(brush, role)| State::new(brush, role)))?;
        self.history.note(before, after);
        Ok(((first..self.next_id).map(BrushId).collect(), change))
    }

    /// Adds brushes; also what they were before, and are now.
    pub(super) fn append(
        &mut self,
        brushes: impl IntoIterator<Item = State>,
    ) -> Result<(Change, Vec<New>, Vec<New>), EditError> {
        let state = |(id, state): (BrushId, State)| {
            self.check_materials(&state.brush)?;
            Ok((id, Some(Arc::new(state))))
        };
        let new: Vec<New> = (self.next_id..).map(BrushId).zip(brushes).map(state).collect::<Result<_, EditError>>()?;
        let end = self.next_id + new.len() as u64;
        let (change, before) = self.change(new.clone())?;
        self.next_id = end;
        Ok((change, before, new))
    }

    /// Takes a brush out.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Evaluate`].
    pub fn remove_brush(&mut self, id: BrushId) -> Result<Change, EditError> {
        self.state(id)?;
        self.edit(vec![(id, None)])
    }

    /// Puts another brush in the place of one; its planes get new handles.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Evaluate`].
    pub fn replace_brush(&mut self, id: BrushId, brush: Brush) -> Result<Change, EditError> {
        self.check_materials(&brush)?;
        let State { next_plane, role, .. } = **self.state(id)?;
        let count = brush.faces.len();
        let planes = (next_plane..next_plane + count).map(PlaneIdx).collect();
        self.edit_brush(id, State { brush, planes, next_plane: next_plane + count, role, line: None })
    }

    /// Moves a brush, or a closed mesh, by an affine map; planes keep their handles.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Transform`], [`EditError::Evaluate`].
    pub fn transform_brush(&mut self, id: BrushId, transform: &Transform) -> Result<Change, EditError> {
        let mut state = State::clone(self.state(id)?);
        state.brush = state.brush.transformed(transform)?;
        self.edit_brush(id, state)
    }

    /// Gives a brush another role.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Nested`], [`EditError::Evaluate`].
    pub fn set_role(&mut self, id: BrushId, role: Role) -> Result<Change, EditError> {
        let state = State { role, ..State::clone(self.state(id)?) };
        if !self.is_in_sequence(id) {
            return Err(EditError::Nested(id));
        }
        self.edit_brush(id, state)
    }

    /// What is said of a brush that has planes.
    fn convex_state(&self, id: BrushId) -> Result<&Arc<State>, EditError> {
        let state = self.state(id)?;
        if state.brush.is_mesh() { Err(EditError::Mesh(id)) } else { Ok(state) }
    }

    fn edit_brush(&mut self, id: BrushId, state: State) -> Result<Change, EditError> {
        self.edit(vec![(id, Some(Arc::new(state)))])
    }

    fn edit(&mut self, new: Vec<New>) -> Result<Change, EditError> {
        let (change, before) = self.change(new.clone())?;
        self.history.note(before, new);
        Ok(change)
    }
}
