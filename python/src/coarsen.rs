//! Few convex cells around solids, triangles and decompositions.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use numpy::PyArray3;
use planecut::cells::coarsen::{
    Bounded, CoarsenOptions, Coarsened as CoreCoarsened, Side, Surface, Writing, written_meshes,
};
use planecut::check::measure_triangles;
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::primitives::hull_of_points;
use planecut::csg::{Brush, Material, MaterialId, Mesh as CoreMesh, Model, Tree, evaluate};
use planecut::enclosing::{enclosed, enclosed_surface};
use planecut::export::{
    Collider, Engine, ExportOptions, Format, MassProperties, Part, PhysicsFormat, RigidBody, encode_parts, physics_files,
    write_atomic,
};
use planecut::import::mesh::{MeshFormat, SolidOptions, parts_of_mesh};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyIterator, PySequence, PyTuple};
use serde::{Deserialize, Serialize};

use crate::arrays::{columns, points, positions, triangles};
use crate::cells::Cell;
use crate::errors::{Failure, Outcome, refuse};
use crate::expression::Node;
use crate::files::{at, indexed, parts_of_mesh_object, said, settings, surface_failure, text_of};
use crate::job::Job;
use crate::mesh::{Given, Handle, Mesh};
use crate::picture::{Look, is_picture, pixels};
use crate::solid::Solid;

/// By how much of its volume a cell may be larger as it is written, for the volume to be the same.
const SAME_VOLUME: f64 = 1e-9;

/// Few convex cells around a solid, and what they add.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Coarsened {
    cells: Vec<Py<Cell>>,
    data: Arc<Data>,
}

/// All of it without Python's objects.
#[derive(Serialize, Deserialize)]
pub(crate) struct Data {
    cells: Vec<Cell>,
    /// The cells as their planes say them, and the materials.
    model: Model,
    /// The cells as others read them.
    meshes: Vec<CoreMesh>,
    /// What was enclosed: its triangles, and whether they bound a solid.
    visual: CoreMesh,
    is_closed: bool,
    volume_in: f64,
    volume_out: f64,
    volume_sum_out: f64,
    clear_tolerance: Option<f64>,
    encloses: bool,
    enclosed: Enclosed,
    max_vertices: Option<usize>,
}

/// What was enclosed.
#[derive(Clone, Copy, Serialize, Deserialize)]
enum Enclosed {
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
    fn of(py: Python<'_>, data: Data) -> PyResult<Self> {
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
        let png = Job::default().run(py, move || {
            Look::of_notebook().picture_of_cells(&data.meshes, 0.0)?.to_png().map_err(Failure::of)
        })?;
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

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let bytes = rmp_serde::to_vec_named(&*slf.get().data).map_err(Failure::of)?;
        Ok((slf.get_type().getattr("_unpickle")?, (PyBytes::new(slf.py(), &bytes),)))
    }

    /// Cells that were pickled.
    #[staticmethod]
    fn _unpickle(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let data = rmp_serde::from_slice(data);
        Self::of(py, data.map_err(|error| refuse(format!("found what are no pickled cells: {error}")))?)
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Coarsened of {} cells, excess {}>", self.cells.len(), self.excess())
    }
}

fn names_of(meshes: &[CoreMesh]) -> Vec<String> {
    (0..meshes.len()).map(|number| format!("cell {number}")).collect()
}

fn save_meshes(meshes: &[CoreMesh], path: &Path, options: &str) -> Outcome<()> {
    let format = Format::from_path(path).map_err(|error| at(path, error))?;
    let names = names_of(meshes);
    let parts: Vec<Part<'_>> = names.iter().zip(meshes).map(|(name, mesh)| Part::new(name, mesh)).collect();
    let options = ExportOptions { convex_colliders: true, ..settings(options)? };
    let bytes = encode_parts(&parts, format, &options).map_err(|error| at(path, error))?;
    write_atomic(path, &bytes).map_err(|error| said(path, error))
}

/// Settings of a rigid body.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct BodySettings {
    /// Kilograms for each cubic metre.
    density: f64,
    /// Metres for each unit of length.
    scale: f64,
}

impl Default for BodySettings {
    fn default() -> Self {
        Self { density: 1000.0, scale: 1.0 }
    }
}

/// Writes a rigid body: what was enclosed, and the cells in single precision, which hold it all the same.
fn save_rigid_body(data: &Data, path: &Path, format: PhysicsFormat, body: &BodySettings) -> Outcome<()> {
    let BodySettings { density, scale } = *body;
    for (name, value) in [("density", density), ("scale", scale)] {
        if !(1e-12..=1e12).contains(&value) {
            return Err(Failure::of(format!("{name}: found {value}, expected a number between 1e-12 and 1e12")));
        }
    }
    let moved = |mesh: &CoreMesh| -> Vec<DVec3> { mesh.positions.iter().map(|position| *position * scale).collect() };
    let visual = CoreMesh { positions: moved(&data.visual), ..data.visual.clone() };
    let of_visual = || MassProperties::of_triangles(&visual.positions, &visual.triangles, density);
    let mass = match data.is_closed.then(of_visual).flatten() {
        Some(mass) => mass,
        None => {
            let union = evaluate(&data.model)?.mesh;
            let mass = MassProperties::of_triangles(&moved(&union), &union.triangles, density);
            mass.ok_or_else(|| Failure::of("found cells without mass, expected some"))?
        }
    };
    let stored = |positions: &[DVec3]| positions.iter().map(|position| position.as_vec3().as_dvec3()).collect();
    let writing = Writing {
        scale,
        max_vertices: data.max_vertices.unwrap_or(usize::MAX),
        encloses: data.encloses,
        is_separated: true,
        stored: &stored,
    };
    let meshes = written_meshes(data.model.tree.brushes(), &data.model.materials, &writing)?;
    let names = names_of(&meshes);
    let pairs = names.iter().zip(&meshes).filter(|(_, mesh)| !mesh.triangles.is_empty());
    let colliders: Vec<Collider<'_>> = pairs.map(|(name, mesh)| Collider::new(name, mesh)).collect();
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let body = RigidBody { name: &stem, visual: &visual, colliders: &colliders, mass };
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    for file in physics_files(&body, format, &stem).map_err(Failure::of)? {
        let place = if file.path().is_empty() { path.to_owned() } else { folder.join(file.path()) };
        if let Some(folder) = place.parent().filter(|_| !file.path().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|error| Failure::of(format!("{}: {error}", folder.display())))?;
        }
        let mut bytes = Vec::new();
        file.write(&mut bytes).map_err(Failure::of)?;
        write_atomic(&place, &bytes).map_err(Failure::of)?;
    }
    Ok(())
}

/// What is to be enclosed.
enum Subject {
    Solid(Arc<Node>),
    Mesh(Handle),
    /// The corners of each of several convex bodies.
    Hulls(Vec<Vec<DVec3>>),
}

impl Subject {
    fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(solid) = value.cast::<Solid>() {
            return Ok(Self::Solid(Arc::clone(solid.get().node())));
        }
        if let Ok(mesh) = value.cast::<Mesh>() {
            return Ok(Self::Mesh(mesh.get().handle()));
        }
        let expected = "a Solid, a Mesh, or a list of hulls: Cell, (vertices, triangles) or vertices of shape (n, 3)";
        if let Some((vertices, faces)) = parts_of_mesh_object(value)? {
            let vertices = positions(&vertices, "vertices")?;
            let mesh = Given::new(&vertices, &faces, None, None, None)?.into_core();
            return Ok(Self::Mesh(Handle::Own(Arc::new(mesh))));
        }
        let Ok(list) = value.cast::<PySequence>() else {
            return Err(refuse(format!("found {}, expected {expected}", value.get_type())));
        };
        let hull = |k: usize| -> PyResult<Vec<DVec3>> {
            let (item, name) = (list.get_item(k)?, format!("hull {k}"));
            if let Ok(cell) = item.cast::<Cell>() {
                return Ok(cell.get().parts().0.to_vec());
            }
            // a pair of arrays, as CoACD gives it
            let is_pair = item.cast::<PySequence>().is_ok_and(|pair| pair.len().is_ok_and(|length| length == 2));
            if is_pair && columns(&item, &name).map_or(true, |columns| columns != 3) {
                let vertices = points(&item.get_item(0)?, &name)?;
                triangles(&item.get_item(1)?, &name, vertices.len())?;
                return Ok(vertices);
            }
            points(&item, &name)
        };
        (0..list.len()?).map(hull).collect::<PyResult<_>>().map(Self::Hulls)
    }
}

/// How triangles are taken.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Taken {
    /// As a solid where they bound one, else as a shell.
    Auto,
    Shell,
    Filled,
}

/// Cells, what they are made of, and what was noticed.
struct Work {
    outcome: CoreCoarsened,
    materials: Vec<Material>,
    bounded: Option<Bounded>,
    note: Option<String>,
    /// What was enclosed.
    visual: CoreMesh,
    is_closed: bool,
}

fn work(subject: Subject, taken: Taken, options: &CoarsenOptions) -> Outcome<Work> {
    match subject {
        Subject::Solid(node) => of_model(node.model()?, &[], options),
        Subject::Hulls(hulls) => {
            let mut brushes = Vec::new();
            for (number, points) in hulls.iter().enumerate() {
                let hull = hull_of_points(points, MaterialId(0));
                brushes.push(hull.map_err(|error| Failure::of(format!("hull {number}: {error}")))?);
            }
            let materials = vec![Material::named(crate::shapes::DEFAULT_MATERIAL)];
            let points: Vec<DVec3> = hulls.into_iter().flatten().collect();
            of_model(Model { materials, tree: Tree::union_of(brushes) }, &points, options)
        }
        Subject::Mesh(handle) => {
            let mesh = handle.mesh();
            if taken != Taken::Auto {
                return of_surface(mesh, taken, None, options);
            }
            match parts_of_mesh(indexed(Given::of_core(mesh)), MeshFormat::Obj, "mesh", &SolidOptions::default()) {
                Ok(parts) => {
                    let is_empty = evaluate(&parts.import.model)?.mesh.triangles.is_empty();
                    if is_empty && options.side == Side::Outer {
                        return of_surface(mesh, taken, Some("found a surface with nothing inside".to_owned()), options);
                    }
                    of_model(parts.import.model, &parts.points, options)
                }
                Err(error) if options.side == Side::Outer => {
                    of_surface(mesh, taken, Some(surface_failure(&error).message), options)
                }
                Err(error) => Err(surface_failure(&error)),
            }
        }
    }
}

/// Cells of a tree.
fn of_model(model: Model, points: &[DVec3], options: &CoarsenOptions) -> Outcome<Work> {
    let visual = evaluate(&model)?.mesh;
    let (outcome, bounded) = enclosed(&model.tree, &visual, points, options)?;
    Ok(Work { outcome, materials: model.materials, bounded, note: None, visual, is_closed: true })
}

fn of_surface(mesh: &CoreMesh, taken: Taken, why: Option<String>, options: &CoarsenOptions) -> Outcome<Work> {
    let (positions, faces) = (&mesh.positions, &mesh.triangles);
    let surface = |bounded| Surface { positions, triangles: faces, materials: &[], bounded };
    let has_inside = taken == Taken::Filled && surface(Bounded::Filled).volume() > 0.0;
    let thickness = || options.min_thickness.unwrap_or_else(|| Bounded::default_thickness(positions, faces));
    let bounded = if has_inside { Bounded::Filled } else { Bounded::Shell { thickness: thickness() } };
    let note = match (bounded, why) {
        (Bounded::Shell { thickness }, Some(why)) => {
            Some(format!("{why}; the triangles are enclosed as a shell {thickness} thick (surface=\"filled\" fills the mesh)"))
        }
        (Bounded::Shell { thickness }, None) if taken == Taken::Filled => Some(format!(
            "the mesh goes around no point by more than half: its triangles are enclosed as a shell {thickness} thick"
        )),
        _ => None,
    };
    let outcome = enclosed_surface(mesh, bounded, options)?;
    let (materials, visual) = (mesh.materials.clone(), mesh.clone());
    Ok(Work { outcome, materials, bounded: Some(bounded), note, visual, is_closed: false })
}

/// Cells as others read them: vertices in doubles whose hull holds the planes' body. A cell that has too many vertices for that becomes a larger one, and the volumes are measured anew.
fn written(work: &mut Work, max_vertices: Option<usize>, encloses: bool) -> Outcome<(Vec<Cell>, Vec<CoreMesh>)> {
    let stored = |positions: &[DVec3]| positions.to_vec();
    let max_vertices = max_vertices.unwrap_or(usize::MAX);
    let writing = Writing { scale: 1.0, max_vertices, encloses, is_separated: false, stored: &stored };
    let mut meshes = written_meshes(&work.outcome.cells, &work.materials, &writing)?;
    let default = Material::named(crate::shapes::DEFAULT_MATERIAL);
    let (mut cells, mut has_grown) = (Vec::new(), false);
    for (brush, mesh) in work.outcome.cells.iter_mut().zip(&meshes) {
        // within a solid a cell may be thinner than rounding
        if mesh.triangles.is_empty() {
            continue;
        }
        let material = brush.faces.first().map(|face| face.material);
        let named = material.and_then(|material| work.materials.get(material.0 as usize)).unwrap_or(&default);
        let cell = Cell::of_planes(brush.half_spaces().copied(), named)?;
        let volume = measure_triangles(&mesh.positions, &mesh.triangles).map_or(0.0, |measures| measures.volume);
        if encloses && volume > cell.volume() * (1.0 + SAME_VOLUME) {
            has_grown = true;
            *brush = hull_of_points(&mesh.positions, material.unwrap_or(MaterialId(0))).map_err(Failure::of)?;
            cells.push(Cell::of_planes(brush.half_spaces().copied(), named)?.written_as(mesh));
        } else {
            cells.push(cell.written_as(mesh));
        }
    }
    if has_grown {
        let tree = Tree::union_of(work.outcome.cells.clone());
        work.outcome.volume_out = evaluate(&Model { materials: work.materials.clone(), tree })?.solid.volume;
        work.outcome.volume_sum_out = cells.iter().map(Cell::volume).sum();
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    Ok((cells, meshes))
}

/// Few convex cells that enclose a solid, with as little added as can be found: for colliders.
///
/// Args:
///     subject: A Solid; a Mesh, closed or not; or a list of convex hulls that others made, each a Cell, a pair of vertices and triangles, or vertices of shape (n, 3).
///     max_cells: Maximum number of cells. Without it and `max_excess`, what can be merged without adding anything is.
///     max_excess: Maximum volume added, relative to the solid's; then there are as few cells as can be found.
///     max_vertices: Maximum number of vertices of each cell, at least 8.
///     max_faces: Maximum number of faces of each cell, at least 6.
///     keep_clear: A Solid into which no cell grows, as the openings of doors.
///     progress: A function that is called with done and total.
///     clear_radius: What a ball of this radius can reach from outside stays clear.
///     max_gap: Maximum distance between parts of one cell.
///     min_thickness: Thinner cells grow until they are not; the thickness of a shell.
///     overlap_weight: How much volume that cells share counts, relative to volume that is added.
///     by_material: Whether parts of different materials stay apart.
///     inner: Cells within the solid instead of around it.
///     surface: How a Mesh is taken: "auto" as a solid where it bounds one, else as a "shell"; "filled" where it goes around more than half.
///     engine: "mujoco", "physx", "bullet", "jolt", "rapier", "godot", "unity" or "unreal": caps that are not given are those of this engine (docs/engines.md).
///     threads: Number of threads; by default one for each core. Cells are the same for any number.
///
/// >>> import planecut as pc
/// >>> stairs = pc.union([pc.box([k, 0, 0], [k + 1, 1, k + 1]) for k in range(4)])
/// >>> ramp = pc.coarsen(stairs, max_cells=1)
/// >>> len(ramp.cells), round(ramp.excess, 6), ramp.encloses
/// (1, 0.15, True)
#[pyfunction]
#[pyo3(signature = (
    subject, max_cells=None, max_excess=None, max_vertices=None, max_faces=None, keep_clear=None, progress=None, *,
    clear_radius=None, max_gap=None, min_thickness=None, overlap_weight=None, by_material=false, inner=false,
    surface="auto", engine=None, threads=None
))]
#[allow(clippy::too_many_arguments)]
fn coarsen(
    py: Python<'_>,
    subject: &Bound<'_, PyAny>,
    max_cells: Option<usize>,
    max_excess: Option<f64>,
    max_vertices: Option<usize>,
    max_faces: Option<usize>,
    keep_clear: Option<&Bound<'_, Solid>>,
    progress: Option<Py<PyAny>>,
    clear_radius: Option<f64>,
    max_gap: Option<f64>,
    min_thickness: Option<f64>,
    overlap_weight: Option<f64>,
    by_material: bool,
    inner: bool,
    surface: &str,
    engine: Option<&str>,
    threads: Option<usize>,
) -> PyResult<Coarsened> {
    let taken = match surface {
        "auto" => Taken::Auto,
        "shell" => Taken::Shell,
        "filled" => Taken::Filled,
        found => return Err(refuse(format!("surface: found {found:?}, expected \"auto\", \"shell\" or \"filled\""))),
    };
    let limits = engine.map(engine_of).transpose()?.map(Engine::limits);
    let clear = keep_clear.map(|solid| Arc::clone(solid.get().node()));
    let subject = Subject::of(subject)?;
    let side = if inner { Side::Inner } else { Side::Outer };
    let max_vertices = max_vertices.or_else(|| limits?.max_vertices);
    let options = CoarsenOptions {
        max_cells,
        max_excess,
        max_faces: max_faces.or_else(|| limits?.max_faces),
        max_vertices,
        keep_clear: None,
        clear_radius,
        by_material,
        min_thickness,
        side,
        overlap_weight,
        max_gap,
    };
    let done = Job::new(py, threads, progress)?.run(py, move || {
        let clear_tree = |node: Arc<Node>| -> Outcome<Tree> {
            let tree = node.model()?.tree;
            Ok(convex_tree(&tree).map_err(|error| Failure::of(format!("keep_clear: {error}")))?.into_owned())
        };
        let options = CoarsenOptions { keep_clear: clear.map(clear_tree).transpose()?, ..options };
        let mut work = work(subject, taken, &options)?;
        let (cells, meshes) = written(&mut work, max_vertices, !inner)?;
        let Work { outcome, materials, bounded, note, visual, is_closed } = work;
        let data = Data {
            cells,
            meshes,
            visual,
            is_closed,
            volume_in: outcome.volume_in,
            volume_out: outcome.volume_out,
            volume_sum_out: outcome.volume_sum_out,
            clear_tolerance: outcome.clear_tolerance,
            model: Model { materials, tree: Tree::union_of(outcome.cells) },
            encloses: !inner,
            enclosed: bounded.into(),
            max_vertices,
        };
        Ok((data, note))
    })?;
    let (data, note) = done;
    if let Some(note) = note {
        let text = std::ffi::CString::new(note)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Coarsened::of(py, data)
}

fn engine_of(name: &str) -> PyResult<Engine> {
    let known = Engine::ALL.into_iter().find(|engine| engine.name() == name);
    known.ok_or_else(|| {
        let names: Vec<&str> = Engine::ALL.iter().map(|engine| engine.name()).collect();
        refuse(format!("engine: found {name:?}, expected one of {}", names.join(", ")))
    })
}

/// Adds the function to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(coarsen, module)?)
}
