//! Solids.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use numpy::{PyArray1, PyArray2, PyArray3};
use planecut::csg::{Brush, Material, Model, Operation, SolidMeasures, Transform, shaping};
use planecut::expression::{Evaluated, Node, components_of, contains};
use planecut_csg::stages::{Ray, check_materials};
use planecut_parallel::job::check;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::prelude::*;

use crate::arrays::{points, row, shape, small, small_rows, table, vector};
use crate::cells::{Cell, cells_of};
use crate::errors::{Failure, Outcome, refuse};
use crate::files::{one_body, save_solid, text_of};
use crate::job::Job;
use crate::mesh::Mesh;
use crate::pickles::{Reduced, reduced, unpickled};
use crate::picture::{Look, is_picture, pixels, save_picture};
use crate::shapes::material_of;

/// A solid: a set of points of space, made of convex bodies and closed meshes by set operations.
///
/// Solids never change, and cost little until something is asked of them: `a | b` only notes what is to be united. The first question about the boundary (`volume`, `mesh()`, …) works it
/// out, later ones know it. Operators: `a | b` (union), `a - b` (difference), `a & b` (intersection), `a ^ b` (exclusive or), `~a` (complement, which is unbounded).
///
/// Lengths are in the units of the caller; z is up, and axes are right-handed.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Solid {
    node: Arc<Node>,
}

impl Solid {
    pub(crate) fn of(node: Arc<Node>) -> Self {
        Self { node }
    }

    pub(crate) fn node(&self) -> &Arc<Node> {
        &self.node
    }

    fn combined(&self, operation: Operation, other: &Bound<'_, Self>) -> Self {
        Self::of(Node::operation(operation, vec![Arc::clone(&self.node), Arc::clone(&other.get().node)]))
    }

    fn transformed(&self, transform: &Transform) -> PyResult<Self> {
        Ok(Self::of(self.node.moved(transform).map_err(Failure::from)?))
    }

    /// The boundary, worked out by a job where it is not known yet.
    pub(crate) fn evaluated(&self, py: Python<'_>, job: Job) -> PyResult<Arc<Evaluated>> {
        if let Some(known) = self.node.known() {
            return Ok(known);
        }
        let node = Arc::clone(&self.node);
        job.short_if(node.is_small()).run(py, move || Ok(node.evaluated()?))
    }

    fn measures(&self, py: Python<'_>) -> PyResult<SolidMeasures> {
        Ok(self.evaluated(py, Job::default())?.evaluation.solid)
    }
}

#[pymethods]
impl Solid {
    /// What lies in either solid.
    fn __or__(&self, other: &Bound<'_, Self>) -> Self {
        self.combined(Operation::Union, other)
    }

    /// What lies in this solid and not in the other.
    fn __sub__(&self, other: &Bound<'_, Self>) -> Self {
        self.combined(Operation::Difference, other)
    }

    /// What lies in both solids.
    fn __and__(&self, other: &Bound<'_, Self>) -> Self {
        self.combined(Operation::Intersection, other)
    }

    /// What lies in one of both solids and not in the other.
    fn __xor__(&self, other: &Bound<'_, Self>) -> Self {
        self.combined(Operation::Xor, other)
    }

    /// What does not lie in this solid.
    fn __invert__(&self) -> Self {
        Self::of(Node::operation(Operation::Complement, vec![Arc::clone(&self.node)]))
    }

    /// The solid moved by a vector of shape (3,).
    fn translate(&self, offset: &Bound<'_, PyAny>) -> PyResult<Self> {
        let by = Transform::translation(vector(offset, "offset")?).map_err(Failure::of)?;
        self.transformed(&by)
    }

    /// The solid turned about an axis through the origin, counter-clockwise seen from the tip of the axis.
    ///
    /// Args:
    ///     axis: Shape (3,), of any length but 0; or "x", "y" or "z".
    ///     degrees: The angle. Multiples of 90 are exact.
    fn rotate(&self, axis: &Bound<'_, PyAny>, degrees: f64) -> PyResult<Self> {
        let axis = match axis.extract::<String>().as_deref() {
            Ok("x") => DVec3::X,
            Ok("y") => DVec3::Y,
            Ok("z") => DVec3::Z,
            Ok(found) => {
                return Err(refuse(format!("axis: found {found:?}, expected \"x\", \"y\", \"z\" or a vector")));
            }
            Err(_) => vector(axis, "axis")?,
        };
        self.transformed(&Transform::rotation(axis, degrees).map_err(Failure::of)?)
    }

    /// The solid scaled about the origin.
    ///
    /// Args:
    ///     factor: A number, or one for each axis; none may be 0, negative ones mirror.
    fn scale(&self, factor: &Bound<'_, PyAny>) -> PyResult<Self> {
        let factors = match factor.extract::<f64>() {
            Ok(factor) => DVec3::splat(factor),
            Err(_) => vector(factor, "factor")?,
        };
        self.transformed(&Transform::scale(factors).map_err(Failure::of)?)
    }

    /// The solid mirrored in the plane through the origin with a normal of shape (3,).
    fn mirror(&self, normal: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.transformed(&Transform::mirror(vector(normal, "normal")?).map_err(Failure::of)?)
    }

    /// The solid moved by an affine map.
    ///
    /// Args:
    ///     matrix: Shape (3, 4), or (4, 4) with the last row 0, 0, 0, 1. It must not be singular.
    fn transform(&self, matrix: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.transformed(&transform_of(matrix)?)
    }

    /// The same solid, all of one material.
    ///
    /// Args:
    ///     material: Its name.
    ///     color: Red, green and blue from 0 to 1, linear, as glTF has them, shape (3,); without it pictures and files have one that depends on the name.
    #[pyo3(signature = (material, *, color=None))]
    fn with_material(&self, material: String, color: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let color = color.map(|color| row::<3>(color, "color")).transpose()?;
        if let Some(found) = color.filter(|color| color.iter().any(|part| !(0.0..=1.0).contains(part))) {
            return Err(refuse(format!("color: found {found:?}, expected numbers from 0 to 1")));
        }
        let color = color.map(|color| color.map(|part| part as f32));
        Ok(Self::of(self.node.of_material(Material { color, ..material_of(Some(material)) })))
    }

    /// The same solid as one body: its boundary as a closed mesh, its vertices rounded to doubles. What is made of it later takes no account of how it was made: worth it for pieces that
    /// are used again and again, as those of a fracture.
    #[pyo3(signature = (*, threads=None, progress=None))]
    fn as_one_body(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        let node = Arc::clone(&self.node);
        let model = Job::new(py, threads, progress)?.run(py, move || one_body(&node))?;
        Ok(Self::of(Node::of_model(model)))
    }

    /// The connected parts of the solid, each a Solid of disjoint convex bodies. Parts that touch along an edge or in a corner are apart.
    #[pyo3(signature = (*, threads=None, progress=None))]
    fn components(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Vec<Self>> {
        let node = Arc::clone(&self.node);
        let models = Job::new(py, threads, progress)?.run(py, move || Ok(components_of(&node.model()?)?))?;
        Ok(models.into_iter().map(|model| Self::of(Node::of_model(model))).collect())
    }

    /// Where the solid meets the plane z = height: what there is just above it, so that the bottom of a solid is one, and its top is none.
    ///
    /// Returns:
    ///     A list of loops of shape (n, 2): outer ones counter-clockwise, holes clockwise. `extrude` takes them.
    fn slice<'py>(&self, py: Python<'py>, height: f64) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        if !height.is_finite() {
            return Err(refuse(format!("height: found {height}, expected a finite number")));
        }
        // upside down: what is just below there is just above here
        let upside_down = Transform::scale([1.0, 1.0, -1.0]).map_err(Failure::of)?;
        let node = self.node.moved(&upside_down).map_err(Failure::from)?;
        let outline =
            Job::default().run(py, move || shaping::slice(&node.model()?.tree, -height).map_err(Failure::of))?;
        let loops = outline.loops().map(|corners| corners.iter().map(|corner| corner.to_array()).collect::<Vec<_>>());
        loops.map(|corners| small_rows(py, &corners)).collect()
    }

    /// The volume, in cubes of the unit of length. `PlanecutError` for a solid that is unbounded, as for all that is asked of the boundary.
    ///
    /// >>> import planecut as pc
    /// >>> (pc.box([0, 0, 0], [2, 2, 2]) - pc.box([0, 0, 0], [1, 1, 1])).volume
    /// 7.0
    #[getter]
    fn volume(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.measures(py)?.volume)
    }

    /// The area of the boundary.
    #[getter]
    fn area(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.measures(py)?.area)
    }

    /// The center of mass of a solid of the same density everywhere, shape (3,); NaN where the solid is empty.
    #[getter]
    fn centroid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let evaluated = self.evaluated(py, Job::default())?;
        let is_empty = evaluated.evaluation.mesh.triangles.is_empty();
        let centroid = if is_empty { DVec3::NAN } else { evaluated.evaluation.solid.centroid };
        Ok(small(py, &centroid.to_array()))
    }

    /// The least and the greatest coordinates, shape (2, 3); NaN where the solid is empty.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let evaluated = self.evaluated(py, Job::default())?;
        let measures = evaluated.evaluation.solid;
        let is_empty = evaluated.evaluation.mesh.triangles.is_empty();
        let bounds = if is_empty { [DVec3::NAN; 2] } else { [measures.min, measures.max] };
        small_rows(py, &bounds.map(|corner| corner.to_array()))
    }

    /// Whether there is nothing inside.
    #[getter]
    fn is_empty(&self, py: Python<'_>) -> PyResult<bool> {
        let node = Arc::clone(&self.node);
        let is_empty = move || match node.evaluated() {
            Ok(evaluated) => Ok(evaluated.evaluation.mesh.triangles.is_empty()),
            Err(error) if error.is_unbounded() => Ok(false),
            Err(error) => Err(error.into()),
        };
        Job::default().short_if(self.node.is_small()).run(py, is_empty)
    }

    /// For each point whether the solid holds it; its boundary belongs to it. Exact for convex bodies; for closed meshes, points on the boundary may count either way.
    ///
    /// Args:
    ///     points: Shape (n, 3).
    ///     threads: Number of threads; by default one for each core.
    ///
    /// Returns:
    ///     An array of bool, shape (n,).
    #[pyo3(signature = (points, *, threads=None))]
    fn contains<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let points = crate::arrays::points(points, "points")?;
        let node = Arc::clone(&self.node);
        let is_short = node.is_small() && points.len() < 1000;
        let held = Job::new(py, threads, None)?.short_if(is_short).run(py, move || Ok(contains(&node, &points)?))?;
        Ok(PyArray1::from_vec(py, held))
    }

    /// For each ray the distance from its origin to where it first meets the boundary, from either side; inf where it does not.
    ///
    /// Args:
    ///     origins: Shape (n, 3).
    ///     directions: Shape (n, 3), or (1, 3) for all; of any length but 0.
    ///     threads: Number of threads; by default one for each core.
    ///
    /// Returns:
    ///     An array of float64, shape (n,), in the unit of length whatever the lengths of the directions.
    #[pyo3(signature = (origins, directions, *, threads=None))]
    fn ray_cast<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (origins, directions) = (points(origins, "origins")?, points(directions, "directions")?);
        if directions.len() != 1 && directions.len() != origins.len() {
            let (found, expected) = (directions.len(), origins.len());
            return Err(refuse(format!("directions: found {found} rows, expected 1, or {expected} as of origins")));
        }
        let ray = |(number, (origin, direction)): (usize, (&DVec3, &DVec3))| {
            let zero = || refuse(format!("directions[{number}]: found the zero vector, expected another"));
            Ray::new(*origin, *direction).ok_or_else(zero)
        };
        let pairs = origins.iter().zip(directions.iter().cycle());
        let rays = pairs.enumerate().map(ray).collect::<PyResult<Vec<Ray>>>()?;
        let node = Arc::clone(&self.node);
        let cast = move || -> Outcome<Vec<f64>> {
            let caster = node.evaluated()?.rays();
            let hit = |ray: &Ray| {
                check();
                caster.first_hit(ray).map_or(f64::INFINITY, |hit| hit.1)
            };
            Ok(rays.par_iter().with_min_len(64).map(hit).collect())
        };
        let hits = Job::new(py, threads, None)?.run(py, cast)?;
        Ok(PyArray1::from_vec(py, hits))
    }

    /// The boundary as a watertight mesh.
    ///
    /// Args:
    ///     threads: Number of threads; by default one for each core. The mesh is the same for any number.
    ///     progress: A function that is called with done and total from time to time, and at the end.
    #[pyo3(signature = (*, threads=None, progress=None))]
    fn mesh(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Mesh> {
        Ok(Mesh::of_evaluated(self.evaluated(py, Job::new(py, threads, progress)?)?))
    }

    /// The solid as disjoint convex cells.
    ///
    /// Returns:
    ///     A list of Cell, the union of which is the solid.
    #[pyo3(signature = (*, threads=None, progress=None))]
    fn cells(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Vec<Cell>> {
        let node = Arc::clone(&self.node);
        Job::new(py, threads, progress)?.run(py, move || cells_of(&node.model()?))
    }

    /// Writes the boundary, or for .map and .csg the convex bodies, or a picture, to a file. The file appears when it is complete.
    ///
    /// Args:
    ///     path: Its ending says the format: .glb, .gltf, .obj, .stl, .3mf, .ply, .map, .csg or .png.
    ///     options: Settings of the format by name: `scale`, `unit`, `text`, `quantize`, `meshopt`, `vertex_colors`, … (docs/formats.md); for a picture those of `render`.
    #[pyo3(signature = (path, **options))]
    fn save(
        &self,
        py: Python<'_>,
        path: std::path::PathBuf,
        options: Option<&Bound<'_, pyo3::types::PyDict>>,
    ) -> PyResult<()> {
        let options = text_of(py, options)?;
        let node = Arc::clone(&self.node);
        Job::default().run(py, move || {
            if is_picture(&path) {
                return save_picture(&node.evaluated()?.evaluation.mesh, &path, &options);
            }
            save_solid(&node, &path, &options)
        })
    }

    /// A picture.
    ///
    /// Args:
    ///     size: Width and height in pixels, each up to 16,384.
    ///     style: "shaded", "technical", "xray" or "wireframe".
    ///     azimuth: Degrees from the x axis towards the y axis: from where it is seen.
    ///     elevation: Degrees above the horizon.
    ///     camera: "perspective" or "orthographic".
    ///     background: "light", "dark" or "transparent".
    ///     dimensions: Whether the extents along the axes are drawn and labelled.
    ///
    /// Returns:
    ///     An array of uint8, shape (height, width, 4): red, green, blue and alpha.
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
        let node = Arc::clone(&self.node);
        pixels(py, Job::default().run(py, move || look.picture(&node.evaluated()?.evaluation.mesh))?)
    }

    /// A picture as a PNG file, for notebooks.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let node = Arc::clone(&self.node);
        let png = Job::default().run(py, move || Look::of_notebook().png(&node.evaluated()?.evaluation.mesh))?;
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

    /// The boundary as a `trimesh.Trimesh`, with vertices and faces of its own. Needs trimesh.
    fn to_trimesh(slf: &Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let py = slf.py();
        let mesh = Bound::new(py, slf.get().mesh(py, None, None)?)?;
        Ok(mesh.call_method0("to_trimesh")?.unbind())
    }

    fn __repr__(&self) -> String {
        match self.node.pieces() {
            1 => "<planecut.Solid of 1 body>".to_owned(),
            pieces => format!("<planecut.Solid of {pieces} bodies>"),
        }
    }

    fn __copy__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    fn __deepcopy__<'py>(slf: Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let node = Arc::clone(&slf.get().node);
        let bytes = slf
            .py()
            .detach(move || node.model().map(|model| rmp_serde::to_vec_named(&model)))
            .map_err(Failure::from)?;
        reduced(slf, bytes)
    }

    /// A solid that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        let model: Model = unpickled(data, "is no pickled solid")?;
        let used = model.tree.brushes().iter().flat_map(Brush::materials);
        let refused = |error| refuse(format!("found what is no pickled solid: {error}"));
        check_materials(used, model.materials.len()).map_err(refused)?;
        Ok(Self::of(Node::of_model(model)))
    }
}

/// An affine map of a matrix.
pub(crate) fn transform_of(matrix: &Bound<'_, PyAny>) -> PyResult<Transform> {
    if !matches!(shape(matrix, "matrix")?, (3 | 4, 4)) {
        return Err(refuse("matrix: found an array of another shape, expected (3, 4) or (4, 4)"));
    }
    let rows = table::<4>(matrix, "matrix")?;
    let is_affine = rows.len() == 3 || rows.len() == 4 && rows[3] == [0.0, 0.0, 0.0, 1.0];
    if !is_affine {
        let found = rows.len();
        return Err(refuse(format!("matrix: found {found} rows, expected 3, or 4 of which the last is 0, 0, 0, 1")));
    }
    let column = |k: usize| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
    Ok(Transform::new(DMat3::from_cols(column(0), column(1), column(2)), column(3)).map_err(Failure::of)?)
}
