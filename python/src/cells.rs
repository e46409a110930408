//! Convex cells.

use glam::DVec3;
use numpy::PyArray2;
use planecut::csg::{Brush, ConvexPiece, Material, MaterialId, Model};
use planecut::expression::{self, DEFAULT_MATERIAL, Node};
use planecut::kernel::HalfSpace;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::arrays::{view_points, view_rows};
use crate::errors::{Failure, Outcome, refuse};
use crate::pickles::{Reduced, reduced, unpickled};
use crate::solid::Solid;

/// A bounded convex body: planes, and the corners and triangles of its boundary.
#[pyclass(frozen, module = "planecut")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Cell {
    planes: Vec<[f64; 4]>,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    volume: f64,
    material: String,
}

impl Cell {
    /// A convex body whose boundary is known.
    pub(crate) fn of_piece(piece: ConvexPiece, material: String) -> Self {
        let ConvexPiece { half_spaces, positions: vertices, triangles, volume } = piece;
        Self { planes: half_spaces.iter().map(HalfSpace::to_array).collect(), vertices, triangles, volume, material }
    }

    pub(crate) fn corners(&self) -> &[DVec3] {
        &self.vertices
    }
}

#[pymethods]
impl Cell {
    /// The planes that carry a face, shape (k, 4): outward normals, which need not have unit length, and offsets `d` of `n · x <= d`.
    #[getter]
    fn planes<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_rows(slf.as_any(), &slf.get().planes)
    }

    /// The corners, shape (n, 3), rounded to doubles.
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_points(slf.as_any(), &slf.get().vertices)
    }

    /// Numbers of corners, shape (m, 3), counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().triangles)
    }

    /// The volume.
    #[getter]
    fn volume(&self) -> f64 {
        self.volume
    }

    /// The name of what it is made of.
    #[getter]
    fn material(&self) -> &str {
        &self.material
    }

    /// The body as a Solid: of its planes, exactly.
    fn to_solid(&self) -> PyResult<Solid> {
        let half_spaces: Vec<HalfSpace> = self
            .planes
            .iter()
            .map(|plane| HalfSpace::from_array(*plane))
            .collect::<Result<_, _>>()
            .map_err(Failure::of)?;
        let brush = Brush::from_half_spaces(half_spaces, MaterialId(0));
        Ok(Solid::of(Node::of_tree(brush, Material::named(&self.material))))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec(slf.get()))
    }

    /// A cell that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        let cell: Self = unpickled(data, "is no pickled cell")?;
        let count = cell.vertices.len() as u32;
        let is_sound = cell.triangles.iter().flatten().all(|corner| *corner < count);
        if is_sound { Ok(cell) } else { Err(refuse("found what is no pickled cell: a number of no corner")) }
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Cell of {} planes, volume {}>", self.planes.len(), self.volume)
    }
}

/// The disjoint convex cells of a model.
pub(crate) fn cells_of(model: &Model) -> Outcome<Vec<Cell>> {
    let name = |material: MaterialId| {
        model.materials.get(material.0 as usize).map_or(DEFAULT_MATERIAL, |material| material.name.as_str()).to_owned()
    };
    let cells = expression::cells_of(model)?;
    Ok(cells.into_iter().map(|(piece, material)| Cell::of_piece(piece, name(material))).collect())
}
