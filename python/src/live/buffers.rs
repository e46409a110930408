//! Faces of a live model as renderers take them.

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use planecut::csg::ModelBuffers;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use super::face::{Face, face_number};
use crate::arrays::{small, small_rows, vector, view, view_rows};
use crate::pickles::{Reduced, reduced, unpickled};

/// Faces in single precision, in one list of vertices and one of triangles. Faces share no vertices, as each has a normal of its own.
#[pyclass(frozen, module = "planecut")]
#[derive(Serialize, Deserialize)]
pub(crate) struct Buffers {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<[u32; 3]>,
    faces: Vec<i64>,
    materials: Vec<String>,
    vertex_starts: Vec<u32>,
    index_starts: Vec<u32>,
}

impl Buffers {
    /// `name` is that of the material of each face.
    pub(super) fn of(core: ModelBuffers, name: impl Fn(usize) -> String) -> Self {
        let ModelBuffers { positions, normals, indices, faces } = core;
        let vertex_ends = faces.iter().map(|face| face.vertices.end);
        let index_ends = faces.iter().map(|face| face.triangles.end);
        Self {
            vertex_starts: std::iter::once(0).chain(vertex_ends).collect(),
            index_starts: std::iter::once(0).chain(index_ends).collect(),
            materials: faces.iter().map(|face| name(face.material.0 as usize)).collect(),
            faces: faces.iter().map(|face| face_number(face.face)).collect(),
            positions,
            normals,
            indices,
        }
    }
}

#[pymethods]
impl Buffers {
    /// The corners relative to the center, shape (n, 3), float32.
    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_rows(slf.as_any(), &slf.get().positions)
    }

    /// The unit outward normal at each corner, shape (n, 3), float32.
    #[getter]
    fn normals<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_rows(slf.as_any(), &slf.get().normals)
    }

    /// Numbers of corners, shape (m, 3), uint32, counter-clockwise seen from outside.
    #[getter]
    fn indices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().indices)
    }

    /// The numbers of the faces, in the order in which they were asked for, shape (f,), int64.
    #[getter]
    fn faces<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<i64>> {
        view(slf.as_any(), &slf.get().faces)
    }

    /// For each face the name of what it is made of.
    #[getter]
    fn materials(&self) -> Vec<String> {
        self.materials.clone()
    }

    /// Where the corners of each face begin, and last where those of the last one end, shape (f + 1,), uint32.
    #[getter]
    fn vertex_starts<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        view(slf.as_any(), &slf.get().vertex_starts)
    }

    /// Where the triangles of each face begin, and last where those of the last one end, shape (f + 1,), uint32.
    #[getter]
    fn index_starts<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        view(slf.as_any(), &slf.get().index_starts)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec(slf.get()))
    }

    /// Buffers that were pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        unpickled(data, "are no pickled buffers")
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Buffers: {} faces of {} triangles>", self.faces.len(), self.indices.len())
    }
}

/// What [`Face::buffers`] gives: positions, normal and indices.
type FaceArrays<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray1<f32>>, Bound<'py, PyArray2<u32>>);

#[pymethods]
impl Face {
    /// The face as a renderer takes it.
    ///
    /// Args:
    ///     center: What positions are relative to, shape (3,); by default the origin. Near the face, single precision loses least.
    ///
    /// Returns:
    ///     Positions of the corners, shape (n, 3), float32; the unit outward normal of all of them, shape (3,), float32; and the numbers of the corners of each triangle, shape (m, 3), uint32.
    #[pyo3(signature = (center=None))]
    fn buffers<'py>(slf: &Bound<'py, Self>, center: Option<&Bound<'py, PyAny>>) -> PyResult<FaceArrays<'py>> {
        let (py, face) = (slf.py(), slf.get());
        let center = center_of(center)?;
        let positions: Vec<[f32; 3]> = face.vertices.iter().map(|at| (*at - center).as_vec3().to_array()).collect();
        let normal = DVec3::from_array(face.normal).as_vec3().to_array();
        Ok((small_rows(py, &positions)?, small(py, &normal), view_rows(slf.as_any(), &face.triangles)))
    }
}

/// The center that positions are relative to.
pub(super) fn center_of(center: Option<&Bound<'_, PyAny>>) -> PyResult<DVec3> {
    center.map_or(Ok(DVec3::ZERO), |center| vector(center, "center"))
}
