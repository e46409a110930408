//! Edits of brushes and their planes.

use std::sync::Arc;

use planecut_kernel::{HalfSpace, PlaneIdx};
use rustc_hash::FxHashSet;

use super::history::States;
use super::operand::State;
use super::tree::Room;
use super::{BrushId, Change, EditError, LiveModel, Role};
use crate::evaluate::check_materials;
use crate::model::{Brush, BrushFace, MaterialId, Transform};

impl LiveModel {
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
        for (brush, _) in &brushes {
            self.check_materials(brush)?;
        }
        let new: Vec<State> = brushes.into_iter().map(|(brush, role)| State::new(brush, role)).collect();
        let ids: Vec<BrushId> = (self.next_id..).map(BrushId).take(new.len()).collect();
        let (_, change) = self.edit_in_order(|model| {
            let places = model.places_before(None, None, &FxHashSet::default(), ids.len(), Room::Behind)?;
            Ok(places.map(|places| {
                let placed =
                    new.iter().zip(places).map(|(state, place)| Some(Arc::new(State { place, ..state.clone() })));
                ((), States { brushes: ids.iter().copied().zip(placed).collect(), ..States::default() })
            }))
        })?;
        self.next_id += ids.len() as u64;
        Ok((ids, change))
    }

    /// Takes a brush out. In its place stays nothing: where the brush is what an operation takes something from, or one of those that it intersects, an operation on nothing
    /// is put there, so that no other operand gets another meaning.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Evaluate`].
    pub fn remove_brush(&mut self, id: BrushId) -> Result<Change, EditError> {
        let place = self.state(id)?.place;
        let mut new = States::of_brush(id, None);
        self.leave_nothing(place, &mut new);
        self.edit(new)
    }

    /// Puts another brush in the place of one; its planes get new handles.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Evaluate`].
    pub fn replace_brush(&mut self, id: BrushId, brush: Brush) -> Result<Change, EditError> {
        self.check_materials(&brush)?;
        let State { next_plane, role, place, .. } = **self.state(id)?;
        let count = brush.faces.len();
        let planes = (next_plane..next_plane + count).map(PlaneIdx).collect();
        self.edit_brush(id, State { brush, planes, next_plane: next_plane + count, role, place, line: None })
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

    /// Makes a plane of a brush, or all of it, of another material. A closed mesh has no planes.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`] for a plane of a mesh, [`EditError::UnknownPlane`], [`EditError::Evaluate`] for an unknown material.
    pub fn set_material(
        &mut self,
        brush: BrushId,
        plane: Option<PlaneIdx>,
        material: MaterialId,
    ) -> Result<Change, EditError> {
        let mut state = State::clone(self.state(brush)?);
        match plane {
            None => state.brush.materials_mut().for_each(|own| *own = material),
            Some(plane) => {
                let place = self.convex_state(brush)?.place_of(plane);
                let place = place.ok_or(EditError::UnknownPlane { brush, plane })?;
                state.brush.faces[place].material = material;
            }
        }
        check_materials([material].into_iter(), self.materials().len())?;
        self.edit_brush(brush, state)
    }

    /// Gives a brush another name, or none.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn rename_brush(&mut self, id: BrushId, name: Option<String>) -> Result<Change, EditError> {
        let mut state = State::clone(self.state(id)?);
        state.brush.name = name;
        self.edit_brush(id, state)
    }

    /// What is said of a brush that has planes.
    pub(super) fn convex_state(&self, id: BrushId) -> Result<&Arc<State>, EditError> {
        let state = self.state(id)?;
        if state.brush.is_mesh() { Err(EditError::Mesh(id)) } else { Ok(state) }
    }

    fn edit_brush(&mut self, id: BrushId, state: State) -> Result<Change, EditError> {
        self.edit(States::of_brush(id, Some(Arc::new(state))))
    }

    /// Does an edit and notes it.
    pub(super) fn edit(&mut self, new: States) -> Result<Change, EditError> {
        let (change, before) = self.change(new.clone())?;
        self.history.note(before, new);
        Ok(change)
    }
}
