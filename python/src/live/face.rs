//! What users see of the boundary of a live model, and of what has changed.

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use planecut::csg::{BrushId, Change as CoreChange, FaceId};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::arrays::{small, view_points, view_rows};
use crate::pickles::{Reduced, reduced, unpickled};

/// What an edit has changed.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Change {
    pub(super) change: CoreChange,
}

#[pymethods]
impl Change {
    /// The numbers of the faces that are no more.
    #[getter]
    fn removed(&self) -> Vec<i64> {
        self.change.removed.iter().map(|id| face_number(*id)).collect()
    }

    /// The numbers of the faces that are new; they may be those of faces that were removed.
    #[getter]
    fn added(&self) -> Vec<i64> {
        self.change.added.iter().map(|id| face_number(*id)).collect()
    }

    /// The numbers of the brushes that came, went or changed.
    #[getter]
    fn brushes(&self) -> Vec<u64> {
        self.change.brushes.iter().map(|id| id.0).collect()
    }

    #[allow(clippy::type_complexity)]
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Vec<u64>, Vec<i64>, Vec<i64>))> {
        let change = slf.get();
        Ok((slf.get_type().getattr("_unpickle")?, (change.brushes(), change.removed(), change.added())))
    }

    /// A change that was pickled.
    #[staticmethod]
    fn _unpickle(brushes: Vec<u64>, removed: Vec<u32>, added: Vec<u32>) -> Self {
        let [removed, added] = [removed, added].map(|faces| faces.into_iter().map(FaceId::from).collect());
        Self { change: CoreChange { brushes: brushes.into_iter().map(BrushId).collect(), removed, added } }
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Change: {} faces removed, {} added>", self.change.removed.len(), self.change.added.len())
    }
}

/// A face of a live model as it was when it was asked for, or one that an edit would make (see Preview): planar, connected and of one material.
#[pyclass(frozen, module = "planecut")]
#[derive(Serialize, Deserialize)]
pub(crate) struct Face {
    pub(super) brush: Option<u64>,
    pub(super) plane: Option<usize>,
    pub(super) material: String,
    pub(super) normal: [f64; 3],
    pub(super) vertices: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

#[pymethods]
impl Face {
    /// The number of the brush that it lies on; of several the first that faces the same way. None while a brush of the model is a closed mesh, and for a face of a preview.
    #[getter]
    fn brush(&self) -> Option<u64> {
        self.brush
    }

    /// The number of the plane in the brush, or None.
    #[getter]
    fn plane(&self) -> Option<usize> {
        self.plane
    }

    /// The name of what it is made of.
    #[getter]
    fn material(&self) -> &str {
        &self.material
    }

    /// The unit outward normal, shape (3,).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        small(py, &self.normal)
    }

    /// The corners, shape (n, 3).
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_points(slf.as_any(), &slf.get().vertices)
    }

    /// Numbers of corners, shape (m, 3), counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().triangles)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec(slf.get()))
    }

    /// A face that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        unpickled(data, "is no pickled face")
    }

    fn __repr__(&self) -> String {
        let of = match (self.brush, self.plane) {
            (Some(brush), Some(plane)) => format!("plane {plane} of brush {brush}"),
            _ => format!("{} triangles", self.triangles.len()),
        };
        format!("<planecut.Face: {of}>")
    }
}

/// The number of a face.
pub(super) fn face_number(id: FaceId) -> i64 {
    i64::from(u32::from(id))
}
