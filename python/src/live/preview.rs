//! What an edit would change, without doing it.

use planecut::csg::{BrushId, PlaneRemoval, Preview as CorePreview, PreviewFace};
use planecut::kernel::PlaneIdx;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::calls::{self, Call};
use super::face::{Face, face_number};
use super::tree::Node;
use super::{Live, State};
use crate::cells::Cell;
use crate::errors::{Failure, Outcome};
use crate::solid::Solid;

/// What an edit would change; see Live.preview.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Preview {
    volume_change: f64,
    brushes: Vec<u64>,
    removed: Vec<i64>,
    added: Vec<Py<Face>>,
}

/// What `Preview._unpickle` takes.
type Parts = (f64, Vec<u64>, Vec<i64>, Vec<Py<Face>>);

#[pymethods]
impl Preview {
    /// By how much the volume would grow; negative where it would shrink.
    #[getter]
    fn volume_change(&self) -> f64 {
        self.volume_change
    }

    /// The numbers of the brushes that would come, go or change.
    #[getter]
    fn brushes(&self) -> Vec<u64> {
        self.brushes.clone()
    }

    /// The numbers of the faces that would be no more.
    #[getter]
    fn removed(&self) -> Vec<i64> {
        self.removed.clone()
    }

    /// The faces that would be new, a list of Face. They have no numbers, and tell of no brush and no plane.
    #[getter]
    fn added(&self, py: Python<'_>) -> Vec<Py<Face>> {
        self.added.iter().map(|face| face.clone_ref(py)).collect()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts)> {
        let preview = slf.get();
        let parts = (preview.volume_change, preview.brushes(), preview.removed(), preview.added(slf.py()));
        Ok((slf.get_type().getattr("_unpickle")?, parts))
    }

    /// A preview that was pickled.
    #[staticmethod]
    fn _unpickle(volume_change: f64, brushes: Vec<u64>, removed: Vec<i64>, added: Vec<Py<Face>>) -> Self {
        Self { volume_change, brushes, removed, added }
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Preview: {} faces removed, {} added>", self.removed.len(), self.added.len())
    }
}

/// The calls of an edit, each of which says what it would change instead of doing it; see Live.preview.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Previewer {
    live: Py<Live>,
}

impl State {
    fn preview(&self, call: Call) -> Outcome<(CorePreview, Vec<String>)> {
        let (edit, new) = call.edit_of(self.model.materials())?;
        let names = self.model.materials().iter().chain(&new).map(|material| material.name.clone()).collect();
        Ok((self.model.preview_with(edit, new)?, names))
    }

    /// What the removal of a plane would do to its brush, and the material of the plane.
    fn preview_remove_plane(&self, brush: BrushId, plane: PlaneIdx) -> Outcome<(PlaneRemoval, String)> {
        let removal = self.model.preview_remove_plane(brush, plane)?;
        let (planes, faces) = (self.model.planes(brush)?, &self.model.brush(brush)?.0.faces);
        let face = planes.iter().zip(faces).find(|(other, _)| **other == plane).map(|(_, face)| face);
        let face = face.ok_or_else(|| Failure::bug("found a plane without a face"))?;
        Ok((removal, self.model.materials()[face.material.0 as usize].name.clone()))
    }
}

#[pymethods]
impl Live {
    /// An object with the calls of an edit, each of which returns a Preview of what it would change and does nothing: `live.preview.move_plane(0, 0, 4.0)`.
    ///
    /// The model stays as it is, its undo steps and materials too. A preview is of the model as it is now, also within an edit. It is worked out on a copy, which takes time and memory with the size of
    /// the model: what is dragged is better shown by edits and `undo`. What an edit refuses, its preview refuses as well.
    ///
    /// >>> import planecut as pc
    /// >>> live = pc.Live(pc.box([0, 0, 0], [2, 2, 2]))
    /// >>> preview = live.preview.move_plane(0, 0, 3.0)
    /// >>> preview.volume_change, len(preview.removed), len(preview.added)
    /// (4.0, 5, 5)
    /// >>> live.volume
    /// 8.0
    #[getter]
    fn preview(slf: Bound<'_, Self>) -> Previewer {
        Previewer { live: slf.unbind() }
    }

    /// What a brush would gain without one of its planes: the part of what its other planes leave that lies beyond that plane. The model
    /// stays as it is; the cost is that of the brush alone, whatever else the model holds. `live.preview.remove_plane` is about the whole model instead.
    ///
    /// Returns:
    ///     None where the brush would stay as it is (other planes bound it there, or nothing is left of it either way), the text "unbounded" where it would reach infinity, otherwise a Cell:
    ///     the convex body that it would gain, with planes of shape (k, 4), vertices, triangles and volume, of the material of the plane.
    fn preview_remove_plane(&self, py: Python<'_>, brush: u64, plane: usize) -> PyResult<Py<PyAny>> {
        let (brush, plane) = (BrushId(brush), PlaneIdx(plane));
        let (removal, material) = self.with(py, |state| state.preview_remove_plane(brush, plane))?;
        match removal {
            PlaneRemoval::Nothing => Ok(py.None()),
            PlaneRemoval::Unbounded => "unbounded".into_py_any(py),
            PlaneRemoval::Gains(piece) => Cell::of_piece(piece, material).into_py_any(py),
        }
    }
}

impl Previewer {
    fn preview(&self, py: Python<'_>, call: Call) -> PyResult<Preview> {
        let (preview, names) = self.live.get().with(py, |state| state.preview(call))?;
        let face = |face: PreviewFace| {
            let PreviewFace { material, normal, positions: vertices, triangles } = face;
            let (material, normal) = (names[material.0 as usize].clone(), normal.to_array());
            Py::new(py, Face { brush: None, plane: None, material, normal, vertices, triangles })
        };
        let CorePreview { volume_change, brushes, removed, added } = preview;
        Ok(Preview {
            volume_change,
            brushes: brushes.into_iter().map(|brush| brush.0).collect(),
            removed: removed.into_iter().map(face_number).collect(),
            added: added.into_iter().map(face).collect::<PyResult<_>>()?,
        })
    }
}

#[pymethods]
impl Previewer {
    /// What `Edit.move_plane` would change.
    fn move_plane(&self, py: Python<'_>, brush: u64, plane: usize, offset: f64) -> PyResult<Preview> {
        self.preview(py, calls::move_plane(brush, plane, offset))
    }

    /// What `Edit.turn_plane` would change; `to` has the shape (4,).
    fn turn_plane(&self, py: Python<'_>, brush: u64, plane: usize, to: &Bound<'_, PyAny>) -> PyResult<Preview> {
        self.preview(py, calls::turn_plane(brush, plane, to)?)
    }

    /// What `Edit.set_material` would change.
    #[pyo3(signature = (brush, material, plane=None))]
    fn set_material(&self, py: Python<'_>, brush: u64, material: String, plane: Option<usize>) -> PyResult<Preview> {
        self.preview(py, calls::set_material(brush, material, plane))
    }

    /// What `Edit.rename_brush` would change.
    #[pyo3(signature = (brush, name))]
    fn rename_brush(&self, py: Python<'_>, brush: u64, name: Option<String>) -> PyResult<Preview> {
        self.preview(py, calls::rename_brush(brush, name))
    }

    /// What `Edit.copy_brushes` would change; the matrix has the shape (3, 4) or (4, 4).
    fn copy_brushes(&self, py: Python<'_>, brushes: Vec<u64>, matrix: &Bound<'_, PyAny>) -> PyResult<Preview> {
        self.preview(py, calls::copy_brushes(brushes, matrix)?)
    }

    /// What `Edit.mirror_brushes` would change; the plane has the shape (4,).
    fn mirror_brushes(&self, py: Python<'_>, brushes: Vec<u64>, plane: &Bound<'_, PyAny>) -> PyResult<Preview> {
        self.preview(py, calls::mirror_brushes(brushes, plane)?)
    }

    /// What `Edit.array_brushes` would change; the matrix has the shape (3, 4) or (4, 4).
    fn array_brushes(
        &self,
        py: Python<'_>,
        brushes: Vec<u64>,
        matrix: &Bound<'_, PyAny>,
        count: usize,
    ) -> PyResult<Preview> {
        self.preview(py, calls::array_brushes(brushes, matrix, count)?)
    }

    /// What `Edit.add_plane` would change; the plane has the shape (4,).
    #[pyo3(signature = (brush, plane, material=None))]
    fn add_plane(
        &self,
        py: Python<'_>,
        brush: u64,
        plane: &Bound<'_, PyAny>,
        material: Option<String>,
    ) -> PyResult<Preview> {
        self.preview(py, calls::add_plane(brush, plane, material)?)
    }

    /// What `Edit.remove_plane` would change.
    fn remove_plane(&self, py: Python<'_>, brush: u64, plane: usize) -> PyResult<Preview> {
        self.preview(py, calls::remove_plane(brush, plane))
    }

    /// What `Edit.add_brush` would change.
    #[pyo3(signature = (solid, role="add"))]
    fn add_brush(&self, py: Python<'_>, solid: &Bound<'_, Solid>, role: &str) -> PyResult<Preview> {
        self.preview(py, calls::add_brush(solid, role)?)
    }

    /// What `Edit.remove_brush` would change.
    fn remove_brush(&self, py: Python<'_>, brush: u64) -> PyResult<Preview> {
        self.preview(py, calls::remove_brush(brush))
    }

    /// What `Edit.replace_brush` would change.
    fn replace_brush(&self, py: Python<'_>, brush: u64, solid: &Bound<'_, Solid>) -> PyResult<Preview> {
        self.preview(py, calls::replace_brush(brush, solid))
    }

    /// What `Edit.transform_brush` would change; the matrix has the shape (3, 4) or (4, 4).
    fn transform_brush(&self, py: Python<'_>, brush: u64, matrix: &Bound<'_, PyAny>) -> PyResult<Preview> {
        self.preview(py, calls::transform_brush(brush, matrix)?)
    }

    /// What `Edit.set_role` would change.
    fn set_role(&self, py: Python<'_>, operand: &Bound<'_, PyAny>, role: &str) -> PyResult<Preview> {
        self.preview(py, calls::set_role(operand, role)?)
    }

    /// What `Edit.set_operation` would change.
    fn set_operation(&self, py: Python<'_>, node: &Bound<'_, Node>, operation: &str) -> PyResult<Preview> {
        self.preview(py, calls::set_operation(node, operation)?)
    }

    /// What `Edit.wrap` would change.
    fn wrap(&self, py: Python<'_>, operands: Vec<Bound<'_, PyAny>>, operation: &str) -> PyResult<Preview> {
        self.preview(py, calls::wrap(&operands, operation)?)
    }

    /// What `Edit.dissolve` would change.
    fn dissolve(&self, py: Python<'_>, node: &Bound<'_, Node>) -> PyResult<Preview> {
        self.preview(py, calls::dissolve(node))
    }

    /// What `Edit.move_operand` would change.
    #[pyo3(signature = (operand, to=None, before=None))]
    fn move_operand(
        &self,
        py: Python<'_>,
        operand: &Bound<'_, PyAny>,
        to: Option<&Bound<'_, Node>>,
        before: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Preview> {
        self.preview(py, calls::move_operand(operand, to, before)?)
    }

    /// What `Edit.move_brush_before` would change.
    #[pyo3(signature = (brush, before=None))]
    fn move_brush_before(&self, py: Python<'_>, brush: u64, before: Option<u64>) -> PyResult<Preview> {
        self.preview(py, calls::move_brush_before(brush, before))
    }

    /// What `Edit.remove_node` would change.
    fn remove_node(&self, py: Python<'_>, node: &Bound<'_, Node>) -> PyResult<Preview> {
        self.preview(py, calls::remove_node(node))
    }
}
