//! The calls of an edit.

use planecut::csg::{Change as CoreChange, Edited};
use pyo3::prelude::*;

use super::Live;
use super::calls::{self, Call};
use super::tree::Node;
use crate::errors::Failure;
use crate::solid::Solid;

/// The calls of one edit; see Live.edit.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Edit {
    pub(super) live: Py<Live>,
}

impl Edit {
    /// Does a call that makes nothing with a number.
    fn apply(&self, py: Python<'_>, call: Call) -> PyResult<()> {
        self.applied(py, call).map(|_| ())
    }

    fn applied(&self, py: Python<'_>, call: Call) -> PyResult<Edited> {
        self.live.get().with(py, |state| state.apply(call))
    }

    fn copies(&self, py: Python<'_>, call: Call) -> PyResult<Vec<u64>> {
        Ok(self.applied(py, call)?.copies.into_iter().map(|copy| copy.0).collect())
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
        self.apply(py, calls::move_plane(brush, plane, offset))
    }

    /// Puts another half-space of shape (4,), outward normal and offset, in the place of a plane of a brush; the plane keeps its number.
    fn turn_plane(&self, py: Python<'_>, brush: u64, plane: usize, to: &Bound<'_, PyAny>) -> PyResult<()> {
        self.apply(py, calls::turn_plane(brush, plane, to)?)
    }

    /// Gives a brush another material, by its name; all of it, or one of its planes.
    #[pyo3(signature = (brush, material, plane=None))]
    fn set_material(&self, py: Python<'_>, brush: u64, material: String, plane: Option<usize>) -> PyResult<()> {
        self.apply(py, calls::set_material(brush, material, plane))
    }

    /// Gives a brush another name; None takes its name away.
    #[pyo3(signature = (brush, name))]
    fn rename_brush(&self, py: Python<'_>, brush: u64, name: Option<String>) -> PyResult<()> {
        self.apply(py, calls::rename_brush(brush, name))
    }

    /// Copies brushes to where an affine map takes them, a matrix of shape (3, 4) or (4, 4); each copy comes directly behind its
    /// original. Returns the numbers of the copies.
    fn copy_brushes(&self, py: Python<'_>, brushes: Vec<u64>, matrix: &Bound<'_, PyAny>) -> PyResult<Vec<u64>> {
        self.copies(py, calls::copy_brushes(brushes, matrix)?)
    }

    /// The same by the mirror image in a plane of shape (4,), normal and offset.
    fn mirror_brushes(&self, py: Python<'_>, brushes: Vec<u64>, plane: &Bound<'_, PyAny>) -> PyResult<Vec<u64>> {
        self.copies(py, calls::mirror_brushes(brushes, plane)?)
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
        self.copies(py, calls::array_brushes(brushes, matrix, count)?)
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
        let edited = self.applied(py, calls::add_plane(brush, plane, material)?)?;
        Ok(there_is(edited.plane, "plane")?.0)
    }

    /// Takes a plane out of a brush, which grows to what its other planes leave.
    fn remove_plane(&self, py: Python<'_>, brush: u64, plane: usize) -> PyResult<()> {
        self.apply(py, calls::remove_plane(brush, plane))
    }

    /// Adds a brush after all others. Returns its number.
    ///
    /// Args:
    ///     solid: A Solid of one convex body or closed mesh.
    ///     role: "add", "subtract" or "intersect".
    #[pyo3(signature = (solid, role="add"))]
    fn add_brush(&self, py: Python<'_>, solid: &Bound<'_, Solid>, role: &str) -> PyResult<u64> {
        let edited = self.applied(py, calls::add_brush(solid, role)?)?;
        Ok(there_is(edited.brush, "brush")?.0)
    }

    /// Takes a brush out.
    fn remove_brush(&self, py: Python<'_>, brush: u64) -> PyResult<()> {
        self.apply(py, calls::remove_brush(brush))
    }

    /// Puts a Solid of one convex body or closed mesh in the place of a brush; its planes get new numbers.
    fn replace_brush(&self, py: Python<'_>, brush: u64, solid: &Bound<'_, Solid>) -> PyResult<()> {
        self.apply(py, calls::replace_brush(brush, solid))
    }

    /// Moves a brush by an affine map, a matrix of shape (3, 4) or (4, 4); its planes keep their numbers.
    fn transform_brush(&self, py: Python<'_>, brush: u64, matrix: &Bound<'_, PyAny>) -> PyResult<()> {
        self.apply(py, calls::transform_brush(brush, matrix)?)
    }

    /// Gives a brush, by its number, or a Node another role: "add", "subtract" or "intersect". Only parts of the model itself have
    /// one, not the operands of an operation.
    fn set_role(&self, py: Python<'_>, operand: &Bound<'_, PyAny>, role: &str) -> PyResult<()> {
        self.apply(py, calls::set_role(operand, role)?)
    }

    /// Makes another operation of an operation, on the same operands: "union", "intersection", "difference" (the others from the
    /// first), "xor" or "complement" (of the union).
    fn set_operation(&self, py: Python<'_>, node: &Bound<'_, Node>, operation: &str) -> PyResult<()> {
        self.apply(py, calls::set_operation(node, operation)?)
    }

    /// Makes operands of one operation, or parts of the model, those of a new operation, in the order in which they are there; it takes the place, and the role,
    /// of the first of them.
    ///
    /// Args:
    ///     operands: Numbers of brushes, and Nodes.
    ///     operation: "union", "intersection", "difference" (the others from the first), "xor" or "complement" (of the union).
    ///
    /// Returns:
    ///     The Node of the new operation.
    fn wrap(&self, py: Python<'_>, operands: Vec<Bound<'_, PyAny>>, operation: &str) -> PyResult<Node> {
        let edited = self.applied(py, calls::wrap(&operands, operation)?)?;
        Ok(Node::of(there_is(edited.node, "operation")?))
    }

    /// Puts the operands of an operation in its place. As parts of the model itself the first of them has the role of the operation;
    /// the others of a difference are subtracted, those of an intersection intersected, and all others have its role, too.
    fn dissolve(&self, py: Python<'_>, node: &Bound<'_, Node>) -> PyResult<()> {
        self.apply(py, calls::dissolve(node))
    }

    /// Moves a brush or an operation, with all below it, to another place in the tree. What it leaves closes up: the second operand
    /// of a difference may become the first. As a part of the model it has the role that it last had there, at first "add".
    ///
    /// Args:
    ///     operand: The number of a brush, or a Node.
    ///     to: The Node that it is to be an operand of; None makes it a part of the model itself.
    ///     before: The operand there, by number or Node, before which it goes; None makes it the last one.
    #[pyo3(signature = (operand, to=None, before=None))]
    fn move_operand(
        &self,
        py: Python<'_>,
        operand: &Bound<'_, PyAny>,
        to: Option<&Bound<'_, Node>>,
        before: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.apply(py, calls::move_operand(operand, to, before)?)
    }

    /// Moves a brush before another one, to where that one is in the tree; None makes it the last one where it is.
    #[pyo3(signature = (brush, before=None))]
    fn move_brush_before(&self, py: Python<'_>, brush: u64, before: Option<u64>) -> PyResult<()> {
        self.apply(py, calls::move_brush_before(brush, before))
    }

    /// Takes an operation out with all brushes and operations below it. Where others are taken from it, or it is intersected, a union
    /// of nothing stays in its place, so that no other operand gets another meaning.
    fn remove_node(&self, py: Python<'_>, node: &Bound<'_, Node>) -> PyResult<()> {
        self.apply(py, calls::remove_node(node))
    }
}

/// The number of what a call has added.
fn there_is<T>(number: Option<T>, what: &str) -> PyResult<T> {
    Ok(number.ok_or_else(|| Failure::bug(format!("found no number of the {what} that was added")))?)
}
