//! The calls of an edit.

use std::sync::Arc;

use planecut::csg::{BrushId, Change as CoreChange, Edit as CoreEdit, Role};
use planecut::kernel::{HalfSpace, PlaneIdx};
use pyo3::prelude::*;

use super::Live;
use crate::arrays::row;
use crate::errors::{Failure, refuse};
use crate::solid::{Solid, transform_of};

/// The calls of one edit; see Live.edit.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Edit {
    pub(super) live: Py<Live>,
}

impl Edit {
    fn apply(&self, py: Python<'_>, edit: CoreEdit) -> PyResult<(Option<BrushId>, Option<PlaneIdx>)> {
        self.live.get().with(py, |state| state.apply(edit))
    }
}

#[pymethods]
impl Edit {
    fn __enter__<'py>(slf: Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, Self>> {
        slf.get().live.get().with(py, |state| {
            state.refuse_while_open("edit")?;
            state.model.begin_step()?;
            state.open = Some(CoreChange::default());
            Ok(())
        })?;
        Ok(slf)
    }

    fn __exit__(
        &self,
        py: Python<'_>,
        exception: &Bound<'_, PyAny>,
        _value: &Bound<'_, PyAny>,
        _traceback: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let is_failed = !exception.is_none();
        self.live.get().with(py, |state| {
            let Some(change) = state.open.take() else { return Ok(()) };
            if is_failed {
                state.model.cancel_step()?;
            } else {
                state.model.commit_step()?;
                state.change = change;
            }
            Ok(())
        })
    }

    /// Moves a plane of a brush along its normal, to an offset for the normal as it was given.
    fn move_plane(&self, py: Python<'_>, brush: u64, plane: usize, offset: f64) -> PyResult<()> {
        let (brush, plane) = (BrushId(brush), PlaneIdx(plane));
        self.apply(py, CoreEdit::MovePlane { brush, plane, offset }).map(|_| ())
    }

    /// Cuts a brush down to a half-space of shape (4,): outward normal and offset. Returns the number of the plane in the brush.
    #[pyo3(signature = (brush, plane, material=None))]
    fn add_plane(
        &self,
        py: Python<'_>,
        brush: u64,
        plane: &Bound<'_, PyAny>,
        material: Option<String>,
    ) -> PyResult<usize> {
        let half_space = HalfSpace::from_array(row::<4>(plane, "plane")?).map_err(Failure::of)?;
        let brush = BrushId(brush);
        let (_, plane) = self.live.get().with(py, |state| {
            let material = material.map(|name| state.material_named(name));
            state.apply(CoreEdit::AddPlane { brush, half_space, material })
        })?;
        plane.map(|plane| plane.0).ok_or_else(|| Failure::bug("found no number of a plane that was added").into())
    }

    /// Takes a plane out of a brush, which grows to what its other planes leave.
    fn remove_plane(&self, py: Python<'_>, brush: u64, plane: usize) -> PyResult<()> {
        self.apply(py, CoreEdit::RemovePlane { brush: BrushId(brush), plane: PlaneIdx(plane) }).map(|_| ())
    }

    /// Adds a brush after all others. Returns its number.
    ///
    /// Args:
    ///     solid: A Solid of one convex body or closed mesh.
    ///     role: "add", "subtract" or "intersect".
    #[pyo3(signature = (solid, role="add"))]
    fn add_brush(&self, py: Python<'_>, solid: &Bound<'_, Solid>, role: &str) -> PyResult<u64> {
        let (role, node) = (role_of(role)?, Arc::clone(solid.get().node()));
        let (brush, _) = self.live.get().with(py, |state| {
            let brush = state.brush_of(&node)?;
            state.apply(CoreEdit::AddBrush { brush, role })
        })?;
        brush.map(|brush| brush.0).ok_or_else(|| Failure::bug("found no number of a brush that was added").into())
    }

    /// Takes a brush out.
    fn remove_brush(&self, py: Python<'_>, brush: u64) -> PyResult<()> {
        self.apply(py, CoreEdit::RemoveBrush { brush: BrushId(brush) }).map(|_| ())
    }

    /// Puts a Solid of one convex body or closed mesh in the place of a brush; its planes get new numbers.
    fn replace_brush(&self, py: Python<'_>, brush: u64, solid: &Bound<'_, Solid>) -> PyResult<()> {
        let node = Arc::clone(solid.get().node());
        self.live.get().with(py, |state| {
            let by = state.brush_of(&node)?;
            state.apply(CoreEdit::ReplaceBrush { brush: BrushId(brush), by }).map(|_| ())
        })
    }

    /// Moves a brush by an affine map, a matrix of shape (3, 4) or (4, 4); its planes keep their numbers.
    fn transform_brush(&self, py: Python<'_>, brush: u64, matrix: &Bound<'_, PyAny>) -> PyResult<()> {
        let transform = transform_of(matrix)?;
        self.apply(py, CoreEdit::TransformBrush { brush: BrushId(brush), transform }).map(|_| ())
    }

    /// Gives a brush another role: "add", "subtract" or "intersect".
    fn set_role(&self, py: Python<'_>, brush: u64, role: &str) -> PyResult<()> {
        let role = role_of(role)?;
        self.apply(py, CoreEdit::SetRole { operand: BrushId(brush).into(), role }).map(|_| ())
    }
}

fn role_of(name: &str) -> PyResult<Role> {
    match name {
        "add" => Ok(Role::Add),
        "subtract" => Ok(Role::Subtract),
        "intersect" => Ok(Role::Intersect),
        found => Err(refuse(format!("role: found {found:?}, expected \"add\", \"subtract\" or \"intersect\""))),
    }
}
