//! The cells that coarsening gives.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray3;
use planecut::cells::coarsen::Bounded;
use planecut::csg::{Mesh as CoreMesh, Model};
use planecut::export::{PhysicsFormat, write_atomic};
use planecut::expression::Node;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyIterator, PyTuple};
use serde::{Deserialize, Serialize};

use super::saving::{save_meshes, save_rigid_body};
use crate::cells::Cell;
use crate::errors::{Failure, refuse};
use crate::files::{settings, text_of};
use crate::job::Job;
use crate::pickles::{Reduced, reduced, unpickled};
use crate::picture::{Look, is_picture, pixels};
use crate::solid::Solid;

/// Few convex cells around a solid, and what they add.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Coarsened {
    cells: Vec<Py<Cell>>,
    data: Arc<Data>,
}

/// All of it without Python's objects.
#[derive(Serialize, Deserialize)]
pub(super) struct Data {
    pub(super) cells: Vec<Cell>,
    /// The cells as their planes say them, and the materials.
    pub(super) model: Model,
    /// The cells as others read them.
    pub(super) meshes: Vec<CoreMesh>,
    /// What was enclosed: its triangles, and whether they bound a solid.
    pub(super) visual: CoreMesh,
    pub(super) is_closed: bool,
    pub(super) volume_in: f64,
    pub(super) volume_out: f64,
    pub(super) volume_sum_out: f64,
    pub(super) clear_tolerance: Option<f64>,
    pub(super) encloses: bool,
    pub(super) enclosed: Enclosed,
    pub(super) max_vertices: Option<usize>,
}

/// What was enclosed.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) enum Enclosed {
    Solid,
    Filled,
    Shell { thickness: f64 },
}

impl From<Option<Bounded>> for Enclosed {
    fn from(bounded: Option<Bounded>) -> Self {
        match bounded {
            None | Some(Bounded::Solid) => Self::Solid,
            Some(Bounded::Filled) => Self::Filled,
            Some(Bounded::Shell { thickness }) => Self::Shell { thickness },
        }
    }
}

impl Coarsened {
    pub(super) fn of(py: Python<'_>, data: Data) -> PyResult<Self> {
        let cells = data.cells.iter().map(|cell| Py::new(py, cell.clone())).collect::<PyResult<_>>()?;
        Ok(Self { cells, data: Arc::new(data) })
    }
}

#[pymethods]
impl Coarsened {
    /// The cells, a tuple of Cell. They may overlap. The hull of the vertices of each holds all that its planes bound.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.cells.iter().map(|cell| cell.bind(py)))
    }

    /// The volume that the union of the cells adds, relative to that of the solid; negative for cells within it.
    #[getter]
    fn excess(&self) -> f64 {
        (self.data.volume_out - self.data.volume_in) / self.data.volume_in
    }

    /// The same for the sum of the volumes of the cells: what overlaps counts more than once.
    #[getter]
    fn sum_excess(&self) -> f64 {
        (self.data.volume_sum_out - self.data.volume_in) / self.data.volume_in
    }

    /// Whether the cells hold all of the solid, proven by how they were made; False for cells within it.
    #[getter]
    fn encloses(&self) -> bool {
        self.data.encloses
    }

    /// The volume of the solid.
    #[getter]
    fn volume_in(&self) -> f64 {
        self.data.volume_in
    }

    /// The volume of the union of the cells.
    #[getter]
    fn volume_out(&self) -> f64 {
        self.data.volume_out
    }

    /// What was enclosed: "solid", "filled" for what an open mesh goes around more than half, or "shell" for triangles of some thickness.
    #[getter]
    fn enclosed(&self) -> &'static str {
        match self.data.enclosed {
            Enclosed::Solid => "solid",
            Enclosed::Filled => "filled",
            Enclosed::Shell { .. } => "shell",
        }
    }

    /// The thickness of a shell, else None.
    #[getter]
    fn thickness(&self) -> Option<f64> {
        match self.data.enclosed {
            Enclosed::Shell { thickness } => Some(thickness),
            Enclosed::Solid | Enclosed::Filled => None,
        }
    }

    /// Where a radius was to be kept clear: by how much less than it a ball keeps clear, else None.
    #[getter]
    fn clear_tolerance(&self) -> Option<f64> {
        self.data.clear_tolerance
    }

    /// The union of the cells as a Solid.
    fn to_solid(&self) -> Solid {
        Solid::of(Node::of_model(self.data.model.clone()))
    }

    /// Writes the cells to a file: each as a mesh of its own (.glb, .gltf, .obj, .stl, .3mf, .ply), all as the colliders of a rigid body for simulators, with what was enclosed as its visual
    /// mesh, mass and inertia (.xml of MuJoCo, .urdf, .usda; meshes go to a folder beside it), or as a picture (.png).
    ///
    /// Args:
    ///     path: Its ending says the format.
    ///     options: Settings of a mesh format by name; for a rigid body `density` in kilograms per cubic metre (1000 unless it is given), and `scale`, the length of a unit in metres; for a
    ///         picture those of `render`.
    #[pyo3(signature = (path, **options))]
    fn save(&self, py: Python<'_>, path: PathBuf, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let options = text_of(py, options)?;
        let data = Arc::clone(&self.data);
        Job::default().run(py, move || {
            if is_picture(&path) {
                let picture = settings::<Look>(&options)?.picture_of_cells(&data.meshes, 0.0)?;
                return write_atomic(&path, &picture.to_png().map_err(Failure::of)?).map_err(Failure::of);
            }
            match PhysicsFormat::from_extension(&path.extension().unwrap_or_default().to_string_lossy()) {
                Ok(format) => save_rigid_body(&data, &path, format, &settings(&options)?),
                Err(_) => save_meshes(&data.meshes, &path, &options),
            }
        })
    }

    /// A picture of the cells, each in a colour of its own, as by `Solid.render`.
    ///
    /// Args:
    ///     spread: How far cells are moved from the middle: 0 leaves them where they are, with 1 they are twice as far away.
    #[pyo3(
        signature = (size=(640, 480), style="shaded", *, spread=0.0, azimuth=-62.0, elevation=32.0, camera="perspective", background="light", dimensions=false),
        text_signature = "($self, size=(640, 480), style='shaded', *, spread=0.0, azimuth=-62.0, elevation=32.0, camera='perspective', background='light', dimensions=False)"
    )]
    #[allow(clippy::too_many_arguments)]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: (u32, u32),
        style: &str,
        spread: f64,
        azimuth: f64,
        elevation: f64,
        camera: &str,
        background: &str,
        dimensions: bool,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let look = Look::new(size, style, azimuth, elevation, camera, background, dimensions);
        if !spread.is_finite() {
            return Err(refuse(format!("spread: found {spread}, expected a finite number")));
        }
        let data = Arc::clone(&self.data);
        pixels(py, Job::default().run(py, move || look.picture_of_cells(&data.meshes, spread))?)
    }

    /// A picture as a PNG file, for notebooks.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let data = Arc::clone(&self.data);
        let png = Job::default()
            .run(py, move || Look::of_notebook().picture_of_cells(&data.meshes, 0.0)?.to_png().map_err(Failure::of))?;
        Ok(PyBytes::new(py, &png))
    }

    /// A view that can be turned, for notebooks and pages.
    ///
    /// Args:
    ///     size: Width and height in pixels.
    #[pyo3(signature = (size=(640, 480)), text_signature = "($self, size=(640, 480))")]
    fn view(slf: &Bound<'_, Self>, size: (u32, u32)) -> PyResult<Py<PyAny>> {
        Ok(slf.py().import("planecut._view")?.getattr("View")?.call1((slf, size))?.unbind())
    }

    fn __len__(&self) -> usize {
        self.cells.len()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.cells(py)?.into_any().get_item(index)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.cells(py)?.into_any().try_iter()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec_named(&*slf.get().data))
    }

    /// Cells that were pickled.
    #[staticmethod]
    fn _unpickle(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        Self::of(py, unpickled(data, "are no pickled cells")?)
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Coarsened of {} cells, excess {}>", self.cells.len(), self.excess())
    }
}
