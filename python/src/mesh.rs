//! Triangle meshes.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArray3};
use planecut::check::{CheckOptions, check_mesh, check_topology};
use planecut::csg::{Material, Mesh as CoreMesh};
use planecut::expression::Evaluated;
use planecut::triangles::Triangles;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{numbers, points, small_rows, triangles, view, view_points, view_rows};
use crate::errors::refuse;
use crate::files::{save_mesh, text_of};
use crate::job::Job;
use crate::pickles::{Reduced, reduced, unpickled};
use crate::picture::{Look, is_picture, pixels, save_picture};
use crate::shapes::material_of;
use crate::solid::transform_of;

/// A triangle mesh: the boundary of a solid, or triangles that somebody brings, whatever they bound.
///
/// Its arrays are read-only views of memory that the mesh owns; nothing is copied on the way out.
///
/// Args:
///     vertices: Shape (n, 3), finite numbers; they are copied, as doubles.
///     triangles: Shape (m, 3), numbers of vertices from 0, counter-clockwise seen from outside; they are copied.
///     material: The name of what all are made of.
///     materials: Names of materials, instead of `material`.
///     material_ids: Shape (m,), the number of each triangle's material among `materials`.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Mesh {
    data: Data,
    material_ids: OnceLock<Vec<u32>>,
}

enum Data {
    Evaluated(Arc<Evaluated>),
    Own(Arc<CoreMesh>),
}

impl Mesh {
    /// The boundary of a solid.
    pub(crate) fn of_evaluated(evaluated: Arc<Evaluated>) -> Self {
        Self { data: Data::Evaluated(evaluated), material_ids: OnceLock::new() }
    }

    /// A mesh of its own.
    pub(crate) fn of_core(mesh: CoreMesh) -> Self {
        Self { data: Data::Own(Arc::new(mesh)), material_ids: OnceLock::new() }
    }

    pub(crate) fn core(&self) -> &CoreMesh {
        match &self.data {
            Data::Evaluated(evaluated) => &evaluated.evaluation.mesh,
            Data::Own(mesh) => mesh,
        }
    }

    /// A handle for work without the interpreter.
    pub(crate) fn handle(&self) -> Handle {
        match &self.data {
            Data::Evaluated(evaluated) => Handle::Evaluated(Arc::clone(evaluated)),
            Data::Own(mesh) => Handle::Own(Arc::clone(mesh)),
        }
    }
}

/// A mesh without its Python object.
pub(crate) enum Handle {
    Evaluated(Arc<Evaluated>),
    Own(Arc<CoreMesh>),
}

impl Handle {
    pub(crate) fn mesh(&self) -> &CoreMesh {
        match self {
            Self::Evaluated(evaluated) => &evaluated.evaluation.mesh,
            Self::Own(mesh) => mesh,
        }
    }
}

/// Triangles with materials that a caller gives.
pub(crate) fn given(
    vertices: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    material: Option<String>,
    materials: Option<Vec<String>>,
    material_ids: Option<&Bound<'_, PyAny>>,
) -> PyResult<Triangles> {
    let positions = points(vertices, "vertices")?;
    let triangles = triangles(faces, "triangles", positions.len())?;
    let (materials, material_ids) = match (materials, material_ids) {
        (None, None) => (vec![material_of(material)], Vec::new()),
        (Some(names), Some(ids)) if material.is_none() => {
            let ids = numbers(ids, "material_ids", Some(triangles.len()), names.len())?;
            (names.into_iter().map(|name| material_of(Some(name))).collect(), ids)
        }
        _ => return Err(refuse("expected either material, or both materials and material_ids")),
    };
    Ok(Triangles { positions, triangles, materials, material_ids })
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, triangles, material=None, *, materials=None, material_ids=None))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
        material: Option<String>,
        materials: Option<Vec<String>>,
        material_ids: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        Ok(Self::of_core(given(vertices, triangles, material, materials, material_ids)?.into_mesh()))
    }

    /// The places of vertices, shape (n, 3), float64.
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_points(slf.as_any(), &slf.get().core().positions)
    }

    /// The numbers of the vertices of each triangle, shape (m, 3), uint32, counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().core().triangles)
    }

    /// The number of the face that each triangle belongs to, shape (m,), uint32: faces are planar, connected and of one material.
    #[getter]
    fn face_ids<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        view(slf.as_any(), &slf.get().core().triangle_faces)
    }

    /// The unit outward normals of the faces, shape (f, 3).
    #[getter]
    fn face_normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let normals: Vec<[f64; 3]> = self.core().faces.iter().map(|face| face.normal.to_array()).collect();
        small_rows(py, &normals)
    }

    /// The names of the materials.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.core().materials.iter().map(|material| material.name.as_str()).collect()
    }

    /// The number of each triangle's material among `materials`, shape (m,), uint32.
    #[getter]
    fn material_ids<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        let mesh = slf.get().core();
        let of_triangle = |face: &u32| mesh.faces[*face as usize].material.0;
        let ids = slf.get().material_ids.get_or_init(|| mesh.triangle_faces.iter().map(of_triangle).collect());
        view(slf.as_any(), ids)
    }

    /// The colours of the materials, shape (k, 3): red, green and blue from 0 to 1, linear; NaN for those that have none of their own.
    #[getter]
    fn material_colors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let color = |material: &Material| material.color.map_or([f64::NAN; 3], |color| color.map(f64::from));
        small_rows(py, &self.core().materials.iter().map(color).collect::<Vec<_>>())
    }

    /// Whether every edge is used once in each direction, and the triangles around each vertex form one fan: a closed, oriented 2-manifold.
    #[getter]
    fn is_watertight(&self, py: Python<'_>) -> PyResult<bool> {
        let handle = self.handle();
        Job::default().run(py, move || Ok(check_topology(&handle.mesh().positions, &handle.mesh().triangles).manifold))
    }

    /// The signed volume by the divergence theorem: that of the solid, where the mesh bounds one.
    #[getter]
    fn volume(&self, py: Python<'_>) -> PyResult<f64> {
        let handle = self.handle();
        let volume = move || {
            let report = check_topology(&handle.mesh().positions, &handle.mesh().triangles);
            Ok(report.measures.volume)
        };
        Job::default().short_if(self.core().triangles.len() < 10_000).run(py, volume)
    }

    /// The area of all triangles.
    #[getter]
    fn area(&self) -> f64 {
        let mesh = self.core();
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        mesh.triangles.iter().map(area).sum()
    }

    /// The least and the greatest coordinates of the vertices, shape (2, 3); NaN where there are none.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = &self.core().positions;
        let low = positions.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::NAN);
        let high = positions.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::NAN);
        small_rows(py, &[low.to_array(), high.to_array()])
    }

    /// The mesh moved by an affine map, a matrix of shape (3, 4) or (4, 4); triangles are turned round where it mirrors. Vertices are rounded to doubles.
    fn transform(&self, matrix: &Bound<'_, PyAny>) -> PyResult<Self> {
        let transform = transform_of(matrix)?;
        let mut mesh = self.core().clone();
        mesh.positions.iter_mut().for_each(|position| *position = transform.point(*position));
        if mesh.positions.iter().any(|position| !position.is_finite()) {
            return Err(refuse("matrix: found one that moves a vertex beyond the range of doubles, expected another"));
        }
        mesh.faces.iter_mut().for_each(|face| face.normal = transform.gradient(face.normal).normalize_or_zero());
        if transform.linear().determinant() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(Self::of_core(mesh))
    }

    /// A picture, as by `Solid.render`.
    #[pyo3(
        signature = (size=(640, 480), style="shaded", *, azimuth=-62.0, elevation=32.0, camera="perspective", background="light", dimensions=false),
        text_signature = "($self, size=(640, 480), style='shaded', *, azimuth=-62.0, elevation=32.0, camera='perspective', background='light', dimensions=False)"
    )]
    #[allow(clippy::too_many_arguments)]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: (u32, u32),
        style: &str,
        azimuth: f64,
        elevation: f64,
        camera: &str,
        background: &str,
        dimensions: bool,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let look = Look::new(size, style, azimuth, elevation, camera, background, dimensions);
        let handle = self.handle();
        pixels(py, Job::default().run(py, move || look.picture(handle.mesh()))?)
    }

    /// A picture as a PNG file, for notebooks.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let handle = self.handle();
        Ok(PyBytes::new(py, &Job::default().run(py, move || Look::of_notebook().png(handle.mesh()))?))
    }

    /// A view that can be turned, for notebooks and pages.
    ///
    /// Args:
    ///     size: Width and height in pixels.
    #[pyo3(signature = (size=(640, 480)), text_signature = "($self, size=(640, 480))")]
    fn view(slf: &Bound<'_, Self>, size: (u32, u32)) -> PyResult<Py<PyAny>> {
        Ok(slf.py().import("planecut._view")?.getattr("View")?.call1((slf, size))?.unbind())
    }

    /// What is wrong with the mesh: open edges, edges and vertices that are no manifold, triangles that cross others.
    ///
    /// Args:
    ///     tolerance: Depth up to which crossings count as touching, relative to the size of the mesh.
    ///
    /// Returns:
    ///     A list of texts, empty if the mesh is sound. Of each kind of problem the first is told.
    #[pyo3(signature = (tolerance=1e-9, *, threads=None))]
    fn check(&self, py: Python<'_>, tolerance: f64, threads: Option<usize>) -> PyResult<Vec<String>> {
        if tolerance.is_nan() || tolerance < 0.0 {
            return Err(refuse(format!("tolerance: found {tolerance}, expected a number that is not negative")));
        }
        let handle = self.handle();
        let check = move || {
            let mesh = handle.mesh();
            let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions { tolerance, crossings: true });
            let crossing = report.crossings.and_then(|crossings| crossings.first).map(|contact| contact.to_string());
            Ok(report.topology.first_defect.map(|defect| defect.to_string()).into_iter().chain(crossing).collect())
        };
        Job::new(py, threads, None)?.run(py, check)
    }

    /// Writes the mesh to a file. The file appears when it is complete.
    ///
    /// Args:
    ///     path: Its ending says the format: .glb, .gltf, .obj, .stl, .3mf, .ply or .png.
    ///     options: Settings of the format by name: `scale`, `unit`, `text`, `quantize`, `meshopt`, `vertex_colors`, … (docs/formats.md); for a picture those of `render`.
    #[pyo3(signature = (path, **options))]
    fn save(&self, py: Python<'_>, path: std::path::PathBuf, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let options = text_of(py, options)?;
        let handle = self.handle();
        Job::default().run(py, move || {
            let save = if is_picture(&path) { save_picture } else { save_mesh };
            save(handle.mesh(), &path, &options)
        })
    }

    /// The mesh as a `trimesh.Trimesh`, with vertices and faces of its own, which may be changed. Needs trimesh.
    fn to_trimesh(slf: &Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let py = slf.py();
        let arguments = PyDict::new(py);
        arguments.set_item("vertices", Self::vertices(slf).call_method0("copy")?)?;
        arguments.set_item("faces", Self::triangles(slf).call_method1("astype", ("int64",))?)?;
        // where a solid touches itself, vertices at one place are several
        arguments.set_item("process", false)?;
        Ok(py.import("trimesh")?.getattr("Trimesh")?.call((), Some(&arguments))?.unbind())
    }

    /// The mesh as a `manifold3d.Manifold`. Needs manifold3d.
    fn to_manifold(slf: &Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let module = slf.py().import("manifold3d")?;
        // it takes arrays of its own alone
        let vertices = Self::vertices(slf).call_method0("copy")?;
        let triangles = Self::triangles(slf).call_method1("astype", ("uint64",))?;
        let mesh = module.getattr("Mesh64")?.call1((vertices, triangles))?;
        let manifold = module.getattr("Manifold")?.call1((mesh,))?;
        let status = manifold.call_method0("status")?;
        if !status.eq(module.getattr("Error")?.getattr("NoError")?)? {
            return Err(refuse(format!("found a mesh that manifold3d refuses ({status}), expected a closed one")));
        }
        Ok(manifold.unbind())
    }

    fn __repr__(&self) -> String {
        let mesh = self.core();
        format!("<planecut.Mesh of {} vertices and {} triangles>", mesh.positions.len(), mesh.triangles.len())
    }

    fn __copy__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    fn __deepcopy__<'py>(slf: Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec_named(slf.get().core()))
    }

    /// A mesh that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        let mesh: CoreMesh = unpickled(data, "is no pickled mesh")?;
        let (vertices, faces) = (mesh.positions.len() as u32, mesh.faces.len() as u32);
        let is_sound = mesh.triangles.iter().flatten().all(|vertex| *vertex < vertices)
            && mesh.triangle_faces.len() == mesh.triangles.len()
            && mesh.triangle_faces.iter().all(|face| *face < faces)
            && mesh.faces.iter().all(|face| (face.material.0 as usize) < mesh.materials.len());
        if is_sound {
            Ok(Self::of_core(mesh))
        } else {
            Err(refuse("found what is no pickled mesh: a number that stands for nothing"))
        }
    }
}
