//! The calls of an edit.

use std::sync::Arc;

use planecut::csg::{BrushId, Change as CoreChange, Edit as CoreEdit, Role};
use planecut::kernel::{HalfSpace, PlaneIdx};
use pyo3::prelude::*;

use super::{Applied, Live};
use crate::arrays::row;
use crate::errors::{Failure, refuse};
use crate::solid::{Solid, transform_of};

/// The calls of one edit; see Live.edit.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Edit {
    pub(super) live: Py<Live>,
}

impl Edit {
    fn apply(&self, py: Python<'_>, edit: CoreEdit) -> PyResult<Applied> {
        self.live.get().with(py, |state| state.apply(edit))
    }

    fn copies(&self, py: Python<'_>, edit: CoreEdit) -> PyResult<Vec<u64>> {
        Ok(self.apply(py, edit)?.copies.into_iter().map(|copy| copy.0).collect())
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

    /// Puts another half-space of shape (4,), outward normal and offset, in the place of a plane of a brush; the plane keeps its number.
    fn turn_plane(&self, py: Python<'_>, brush: u64, plane: usize, to: &Bound<'_, PyAny>) -> PyResult<()> {
        let half_space = half_space_of(to, "to")?;
        let (brush, plane) = (BrushId(brush), PlaneIdx(plane));
        self.apply(py, CoreEdit::TurnPlane { brush, plane, half_space }).map(|_| ())
    }

    /// Gives a brush another material, by its name; all of it, or one of its planes.
    #[pyo3(signature = (brush, material, plane=None))]
    fn set_material(&self, py: Python<'_>, brush: u64, material: String, plane: Option<usize>) -> PyResult<()> {
        let (brush, plane) = (BrushId(brush), plane.map(PlaneIdx));
        self.live.get().with(py, |state| {
            let material = state.material_named(material);
            state.apply(CoreEdit::SetMaterial { brush, plane, material }).map(|_| ())
        })
    }

    /// Gives a brush another name; None takes its name away.
    #[pyo3(signature = (brush, name))]
    fn rename_brush(&self, py: Python<'_>, brush: u64, name: Option<String>) -> PyResult<()> {
        self.apply(py, CoreEdit::RenameBrush { brush: BrushId(brush), name }).map(|_| ())
    }

    /// Copies brushes to where an affine map takes them, a matrix of shape (3, 4) or (4, 4); each copy comes directly behind its
    /// original. Returns the numbers of the copies.
    fn copy_brushes(&self, py: Python<'_>, brushes: Vec<u64>, matrix: &Bound<'_, PyAny>) -> PyResult<Vec<u64>> {
        let transform = transform_of(matrix)?;
        self.copies(py, CoreEdit::CopyBrushes { brushes: brush_ids(brushes), transform })
    }

    /// The same by the mirror image in a plane of shape (4,), normal and offset.
    fn mirror_brushes(&self, py: Python<'_>, brushes: Vec<u64>, plane: &Bound<'_, PyAny>) -> PyResult<Vec<u64>> {
        let plane = half_space_of(plane, "plane")?;
        self.copies(py, CoreEdit::MirrorBrushes { brushes: brush_ids(brushes), plane })
    }

    /// Copies brushes several times, each copy moved on by an affine map, a matrix of shape (3, 4) or (4, 4), from the one before it.
    /// Returns the numbers of the first copies of all, then of the second ones, and so on.
    fn array_brushes(
        &self,
        py: Python<'_>,
        brushes: Vec<u64>,
        matrix: &Bound<'_, PyAny>,
        count: usize,
    ) -> PyResult<Vec<u64>> {
        let transform = transform_of(matrix)?;
        self.copies(py, CoreEdit::ArrayBrushes { brushes: brush_ids(brushes), transform, count })
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
        let half_space = half_space_of(plane, "plane")?;
        let brush = BrushId(brush);
        let Applied { plane, .. } = self.live.get().with(py, |state| {
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
        let Applied { brush, .. } = self.live.get().with(py, |state| {
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

fn brush_ids(numbers: Vec<u64>) -> Vec<BrushId> {
    numbers.into_iter().map(BrushId).collect()
}

/// A half-space of shape (4,).
pub(super) fn half_space_of(value: &Bound<'_, PyAny>, name: &str) -> PyResult<HalfSpace> {
    Ok(HalfSpace::from_array(row::<4>(value, name)?).map_err(Failure::of)?)
}

fn role_of(name: &str) -> PyResult<Role> {
    match name {
        "add" => Ok(Role::Add),
        "subtract" => Ok(Role::Subtract),
        "intersect" => Ok(Role::Intersect),
        found => Err(refuse(format!("role: found {found:?}, expected \"add\", \"subtract\" or \"intersect\""))),
    }
}
