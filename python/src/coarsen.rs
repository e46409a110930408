//! Few convex cells around solids, triangles and decompositions.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use planecut::cells::coarsen::{
    Bounded, CoarsenOptions, Coarsened as CoreCoarsened, Coarsener, Side, Surface, Writing, written_meshes,
};
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::primitives::hull_of_points;
use planecut::csg::{Brush, Material, MaterialId, Mesh as CoreMesh, Model, Tree, evaluate};
use planecut::export::{Engine, Format, Part, encode_parts, write_atomic};
use planecut::import::mesh::{IndexedMesh, MeshFormat, SolidOptions, parts_of_mesh};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySequence, PyTuple};

use crate::arrays::{columns, points, triangles};
use crate::cells::Cell;
use crate::errors::{Failure, Outcome, refuse};
use crate::expression::Node;
use crate::files::{indexed, surface_failure, text_of};
use crate::job::Job;
use crate::mesh::{Given, Handle, Mesh};
use crate::solid::Solid;

/// Few convex cells around a solid, and what they add.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Coarsened {
    cells: Vec<Py<Cell>>,
    meshes: Arc<Vec<CoreMesh>>,
    outcome: CoreCoarsened,
    encloses: bool,
    bounded: Option<Bounded>,
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
        self.outcome.excess()
    }

    /// The same for the sum of the volumes of the cells: what overlaps counts more than once.
    #[getter]
    fn sum_excess(&self) -> f64 {
        self.outcome.sum_excess()
    }

    /// Whether the cells hold all of the solid, proven by how they were made; False for cells within it.
    #[getter]
    fn encloses(&self) -> bool {
        self.encloses
    }

    /// The volume of the solid.
    #[getter]
    fn volume_in(&self) -> f64 {
        self.outcome.volume_in
    }

    /// The volume of the union of the cells.
    #[getter]
    fn volume_out(&self) -> f64 {
        self.outcome.volume_out
    }

    /// What was enclosed: "solid", "filled" for what an open mesh goes around more than half, or "shell" for triangles of some thickness.
    #[getter]
    fn enclosed(&self) -> &'static str {
        match self.bounded {
            None | Some(Bounded::Solid) => "solid",
            Some(Bounded::Filled) => "filled",
            Some(Bounded::Shell { .. }) => "shell",
        }
    }

    /// The thickness of a shell, else None.
    #[getter]
    fn thickness(&self) -> Option<f64> {
        match self.bounded {
            Some(Bounded::Shell { thickness }) => Some(thickness),
            _ => None,
        }
    }

    /// Where a radius was to be kept clear: by how much less than it a ball keeps clear, else None.
    #[getter]
    fn clear_tolerance(&self) -> Option<f64> {
        self.outcome.clear_tolerance
    }

    /// Writes each cell as a mesh of its own into one file: .glb, .gltf, .obj, .stl, .3mf or .ply.
    #[pyo3(signature = (path, **options))]
    fn save(&self, py: Python<'_>, path: PathBuf, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let options = text_of(py, options)?;
        let meshes = Arc::clone(&self.meshes);
        Job::default().run(py, move || save(&meshes, &path, &options))
    }

    fn __len__(&self) -> usize {
        self.cells.len()
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Coarsened of {} cells, excess {}>", self.cells.len(), self.excess())
    }
}

fn save(meshes: &[CoreMesh], path: &Path, options: &str) -> Outcome<()> {
    let options = serde_json::from_str(options).map_err(|error| Failure::of(format!("options: {error}")))?;
    let names: Vec<String> = (0..meshes.len()).map(|number| format!("cell {number}")).collect();
    let parts: Vec<Part<'_>> = names.iter().zip(meshes).map(|(name, mesh)| Part::new(name, mesh)).collect();
    let format = Format::from_path(path).map_err(Failure::of)?;
    let bytes = encode_parts(&parts, format, &options).map_err(Failure::of)?;
    write_atomic(path, &bytes).map_err(Failure::of)
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
            let given = given_of(mesh);
            if taken != Taken::Auto {
                return of_surface(mesh, taken, None, options);
            }
            match parts_of_mesh(given, MeshFormat::Obj, "mesh", &SolidOptions::default()) {
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

fn given_of(mesh: &CoreMesh) -> IndexedMesh {
    let material = |face: &u32| mesh.faces[*face as usize].material.0;
    indexed(Given {
        positions: mesh.positions.clone(),
        triangles: mesh.triangles.clone(),
        materials: mesh.materials.clone(),
        material_ids: mesh.triangle_faces.iter().map(material).collect(),
    })
}

/// Cells of a tree: of the boundary where a part is a mesh and few cells are wanted, else of its exact convex parts.
fn of_model(model: Model, points: &[DVec3], options: &CoarsenOptions) -> Outcome<Work> {
    let is_coarse = options.max_cells.is_some() || options.max_excess.is_some();
    if model.tree.has_meshes() && is_coarse && options.side == Side::Outer {
        let evaluation = evaluate(&model)?;
        let outcome = enclosed(&evaluation.mesh, Bounded::Solid, options)?;
        // pieces of a surface exceed it a little: what they cannot reach, exact cells may
        if options.max_excess.is_none_or(|most| outcome.excess() <= most) {
            return Ok(Work { outcome, materials: model.materials, bounded: Some(Bounded::Solid), note: None });
        }
    }
    let tree = convex_tree(&model.tree).map_err(Failure::of)?;
    let outcome = Coarsener::new(&tree, points, options)?.coarsened()?;
    Ok(Work { outcome, materials: model.materials.clone(), bounded: None, note: None })
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
    let outcome = enclosed(mesh, bounded, options)?;
    Ok(Work { outcome, materials: mesh.materials.clone(), bounded: Some(bounded), note })
}

fn enclosed(mesh: &CoreMesh, bounded: Bounded, options: &CoarsenOptions) -> Outcome<CoreCoarsened> {
    let materials: Vec<MaterialId> =
        mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material).collect();
    let surface = Surface { positions: &mesh.positions, triangles: &mesh.triangles, materials: &materials, bounded };
    Ok(Coarsener::of_surface(&surface, None, options)?.coarsened()?)
}

/// Cells as others read them: vertices in doubles whose hull holds the planes' body.
fn written(work: &Work, max_vertices: Option<usize>, encloses: bool) -> Outcome<(Vec<Cell>, Vec<CoreMesh>)> {
    let stored = |positions: &[DVec3]| positions.to_vec();
    let writing = Writing { scale: 1.0, max_vertices: max_vertices.unwrap_or(usize::MAX), encloses, stored: &stored };
    let meshes = written_meshes(&work.outcome.cells, &work.materials, &writing)?;
    let default = Material::named(crate::shapes::DEFAULT_MATERIAL);
    let cell = |(brush, mesh): (&Brush, &CoreMesh)| {
        let material = brush.faces.first().and_then(|face| work.materials.get(face.material.0 as usize));
        Cell::of_planes(brush.half_spaces().copied(), material.unwrap_or(&default)).map(|cell| cell.written_as(mesh))
    };
    // within a solid a cell may be thinner than rounding
    let kept = work.outcome.cells.iter().zip(&meshes).filter(|(_, mesh)| !mesh.triangles.is_empty());
    let cells = kept.map(cell).collect::<Outcome<_>>()?;
    Ok((cells, meshes.into_iter().filter(|mesh| !mesh.triangles.is_empty()).collect()))
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
        let work = work(subject, taken, &options)?;
        let (cells, meshes) = written(&work, max_vertices, !inner)?;
        Ok((work, cells, meshes))
    })?;
    let (Work { outcome, bounded, note, .. }, cells, meshes) = done;
    if let Some(note) = note {
        let text = std::ffi::CString::new(note)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    let cells = cells.into_iter().map(|cell| Py::new(py, cell)).collect::<PyResult<_>>()?;
    Ok(Coarsened { cells, meshes: Arc::new(meshes), outcome, encloses: !inner, bounded })
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
