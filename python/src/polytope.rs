//! The kernel: convex polyhedra whose planes come and go.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::{PyArray1, PyArray2};
use planecut::kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use pyo3::prelude::*;

use crate::arrays::{row, small, small_rows, table};
use crate::errors::{Failure, refuse};
use crate::pickles::{Reduced, reduced, unpickled};

/// The intersection of half-spaces `n · x <= d`, with corners and faces kept up to date as planes are added, moved and removed, each in about a microsecond. It may be unbounded or
/// empty. Every decision is exact: it is the same as a new one of the same planes.
///
/// Args:
///     planes: Shape (k, 4), numbered from 0 in their order; without them it is all of space.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Polytope {
    body: Mutex<IncrementalPolytope>,
}

fn half_space(plane: &Bound<'_, PyAny>) -> PyResult<HalfSpace> {
    Ok(HalfSpace::from_array(row::<4>(plane, "plane")?).map_err(Failure::of)?)
}

fn unknown(plane: usize) -> PyErr {
    refuse(format!("plane: found {plane}, expected the number of a plane that is there"))
}

impl Polytope {
    fn of(body: IncrementalPolytope) -> Self {
        Self { body: Mutex::new(body) }
    }

    /// Nothing that is called while it is locked needs the interpreter.
    fn body(&self) -> MutexGuard<'_, IncrementalPolytope> {
        self.body.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Polytope {
    #[new]
    #[pyo3(signature = (planes=None))]
    fn new(planes: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let mut body = IncrementalPolytope::new();
        for (number, plane) in
            planes.map_or(Ok(Vec::new()), |planes| table::<4>(planes, "planes"))?.into_iter().enumerate()
        {
            let plane = HalfSpace::from_array(plane).map_err(|error| refuse(format!("planes[{number}]: {error}")))?;
            body.add_plane(plane);
        }
        Ok(Self::of(body))
    }

    /// Adds a plane of shape (4,): outward normal and offset. Returns its number, which is given to another one when it was removed.
    ///
    /// >>> import planecut as pc
    /// >>> p = pc.Polytope([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]])
    /// >>> cut = p.add_plane([1, 1, 1, 2])
    /// >>> len(p.vertices)
    /// 10
    /// >>> p.remove_plane(cut)
    /// >>> p.volume
    /// 8.0
    fn add_plane(&self, plane: &Bound<'_, PyAny>) -> PyResult<usize> {
        let plane = half_space(plane)?;
        Ok(self.body().add_plane(plane).plane().0)
    }

    /// Removes a plane.
    fn remove_plane(&self, plane: usize) -> PyResult<()> {
        self.body().remove_plane(PlaneIdx(plane)).map(|_| ()).ok_or_else(|| unknown(plane))
    }

    /// Moves a plane along its normal, to an offset for the normal as it was given.
    fn move_plane(&self, plane: usize, offset: f64) -> PyResult<()> {
        let mut body = self.body();
        let normal = body.plane(PlaneIdx(plane)).ok_or_else(|| unknown(plane))?.normal();
        let moved = HalfSpace::new(normal, offset).map_err(Failure::of)?;
        body.move_plane(PlaneIdx(plane), moved);
        Ok(())
    }

    /// Whether the body is bounded; an empty one is.
    #[getter]
    fn is_bounded(&self) -> bool {
        self.body().is_bounded()
    }

    /// Whether it has no interior.
    #[getter]
    fn is_empty(&self) -> bool {
        self.body().is_empty()
    }

    /// The numbers of the planes, shape (k,), int64, ascending.
    #[getter]
    fn plane_ids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let ids: Vec<i64> = self.body().planes().map(|(plane, _)| plane.0 as i64).collect();
        small(py, &ids)
    }

    /// The planes in the order of `plane_ids`, shape (k, 4), as they were given.
    #[getter]
    fn planes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let planes: Vec<[f64; 4]> = self.body().planes().map(|(_, plane)| plane.to_array()).collect();
        small_rows(py, &planes)
    }

    /// The corners, shape (n, 3), each coordinate correctly rounded; corners at infinity are left out.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let corners: Vec<[f64; 3]> = self.body().to_mesh().0.iter().map(|corner| corner.to_array()).collect();
        small_rows(py, &corners)
    }

    /// For each face the numbers of its corners among `vertices`, counter-clockwise seen from outside; those of an unbounded face begin after its way through infinity.
    #[getter]
    fn faces(&self) -> Vec<Vec<usize>> {
        self.body().faces().into_iter().map(|face| face.vertices).collect()
    }

    /// The number of the plane of each of `faces`.
    #[getter]
    fn face_planes(&self) -> Vec<usize> {
        self.body().faces().into_iter().map(|face| face.plane.0).collect()
    }

    /// The volume; inf where it is unbounded.
    #[getter]
    fn volume(&self) -> f64 {
        let body = self.body();
        if body.is_empty() { 0.0 } else { body.measures().map_or(f64::INFINITY, |measures| measures.volume) }
    }

    /// The area of the boundary; inf where it is unbounded.
    #[getter]
    fn area(&self) -> f64 {
        let body = self.body();
        if body.is_empty() { 0.0 } else { body.measures().map_or(f64::INFINITY, |measures| measures.area) }
    }

    /// The area of the face on a plane: how the volume grows when the plane, of a normal of unit length, moves outward. 0 where it has no face, inf where that is unbounded.
    fn face_area(&self, plane: usize) -> PyResult<f64> {
        let body = self.body();
        body.plane(PlaneIdx(plane)).ok_or_else(|| unknown(plane))?;
        if body.is_empty() {
            return Ok(0.0);
        }
        let has_face = || body.faces().iter().any(|face| face.plane.0 == plane);
        Ok(body.face_area(PlaneIdx(plane)).unwrap_or_else(|| if has_face() { f64::INFINITY } else { 0.0 }))
    }

    /// For each point whether the closed body holds it, exactly; a body without interior holds none.
    ///
    /// Args:
    ///     points: Shape (n, 3).
    fn contains<'py>(&self, py: Python<'py>, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let points = crate::arrays::points(points, "points")?;
        let body = self.body();
        let held: Vec<bool> = points.iter().map(|point| body.contains(*point)).collect();
        drop(body);
        Ok(PyArray1::from_vec(py, held))
    }

    /// A polytope of its own, with the same planes by the same numbers.
    fn copy(&self) -> Self {
        Self::of(self.body().clone())
    }

    fn __copy__(&self) -> Self {
        self.copy()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy()
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Polytope of {} planes>", self.body().planes().count())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec_named(&*slf.get().body()))
    }

    /// A polytope that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        unpickled(data, "is no pickled polytope").map(Self::of)
    }
}
