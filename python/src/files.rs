//! Solids and meshes from files, and into files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use planecut::cells::convex_union;
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{Mesh as CoreMesh, Model};
use planecut::export::{BrushFormat, ExportOptions, Format, encode, write_atomic, write_brushes};
use planecut::expression::Node;
use planecut::import::Warning;
use planecut::import::file::{MAX_MESH, read_file};
use planecut::import::mesh::{SolidError, SolidOptions, WindingRule};
use planecut::import::model::MAX_TEXT;
use planecut::reading::{self, ENDINGS, FileKind, ReadError, ReadOptions};
use planecut::triangles::{self, Triangles, said_of_surface};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat};
use serde::de::DeserializeOwned;

use crate::errors::{Failure, Outcome, refuse};
use crate::job::Job;
use crate::mesh::{self, Mesh};
use crate::solid::Solid;

/// Keyword arguments as JSON.
pub(crate) fn text_of(py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<String> {
    match options {
        None => Ok("{}".to_owned()),
        Some(options) => {
            let settings = PyDict::new(py);
            settings.set_item("allow_nan", false)?;
            // numbers of NumPy are none of JSON's
            settings.set_item("default", py.get_type::<PyFloat>())?;
            let dumps = py.import("json")?.getattr("dumps")?;
            for (name, value) in options {
                let text = dumps.call((value,), Some(&settings));
                text.map_err(|error| refuse(format!("{name}: {}", error.value(py))))?;
            }
            dumps.call((options,), Some(&settings))?.extract()
        }
    }
}

/// Settings that were given by name.
pub(crate) fn settings<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    let refused = |name: &str, error: serde_json::Error| {
        // the place in a text that nobody wrote says nothing
        let message = error.to_string();
        Failure::of(format!("{name}: {}", message.split(" at line ").next().unwrap_or_default()))
    };
    serde_json::from_str(text).map_err(|error| {
        // one by one they say which of them it is
        let all: serde_json::Map<String, serde_json::Value> = serde_json::from_str(text).unwrap_or_default();
        let of_one = |(name, value): (String, serde_json::Value)| {
            let one = serde_json::Map::from_iter([(name.clone(), value)]);
            serde_json::from_value::<T>(one.into()).err().map(|error| refused(&name, error))
        };
        all.into_iter().find_map(of_one).unwrap_or_else(|| refused("options", error))
    })
}

/// A failure of a file.
pub(crate) fn at(path: &Path, error: impl std::fmt::Display) -> Failure {
    let path = path.display().to_string();
    Failure { message: format!("{path}: {error}"), path: Some(path), ..Failure::default() }
}

/// Writes a mesh.
pub(crate) fn save_mesh(mesh: &CoreMesh, path: &Path, options: &str) -> Outcome<()> {
    let format = Format::from_path(path).map_err(|error| at(path, error))?;
    let bytes = encode(mesh, format, &settings(options)?).map_err(|error| at(path, error))?;
    write_atomic(path, &bytes).map_err(|error| said(path, error))
}

/// A failure that names the file itself.
pub(crate) fn said(path: &Path, error: impl std::fmt::Display) -> Failure {
    Failure { message: error.to_string(), ..at(path, "") }
}

/// Writes the boundary of a solid, or its convex bodies.
pub(crate) fn save_solid(node: &Arc<Node>, path: &Path, options: &str) -> Outcome<()> {
    let Ok(format) = BrushFormat::from_path(path) else {
        // a name that no format has is refused before any work
        Format::from_path(path).map_err(|error| at(path, error))?;
        return save_mesh(&node.evaluated()?.evaluation.mesh, path, options);
    };
    let options: ExportOptions = settings(options)?;
    if (ExportOptions { scale: 1.0, ..options.clone() }) != ExportOptions::default() {
        return Err(at(path, "found options for meshes, expected scale alone"));
    }
    // an unbounded solid has no file
    node.evaluated()?;
    let model = node.model()?;
    let tree = convex_tree(&model.tree).map_err(|error| at(path, error))?;
    let mut text = Vec::new();
    write_brushes(&convex_union(&tree), &model.materials, format, options.scale, &mut text)
        .map_err(|error| at(path, error))?;
    write_atomic(path, &text).map_err(|error| said(path, error))
}

/// Says what was noticed, by Python's warnings; what is lost is an error unless that is allowed.
pub(crate) fn warn(py: Python<'_>, name: &str, warnings: &[Warning], allow_loss: bool) -> PyResult<()> {
    if let Some(lost) = warnings.iter().find(|warning| warning.left_out > 0 && !allow_loss) {
        let line = (lost.line > 0).then_some(lost.line as usize);
        let at = line.map_or_else(String::new, |line| format!(":{line}"));
        let message = format!("{name}{at}: {} (allow_loss=True goes on without it)", lost.message);
        return Err(Failure { message, path: Some(name.to_owned()), line, ..Failure::default() }.into());
    }
    for warning in warnings {
        let at = if warning.line > 0 { format!(":{}", warning.line) } else { String::new() };
        let text = std::ffi::CString::new(format!("{name}{at}: {}", warning.message).replace('\0', " "))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// Reads a solid from a file.
///
/// Args:
///     path: A model file (.json), a Quake-family map (.map), an evaluated tree of OpenSCAD (.csg), or a closed mesh (.obj, .stl, .ply, .glb, .gltf).
///     allow_loss: Whether solids that the file states and that cannot be made are left out, with a warning, instead of being an error.
///     winding: What of a mesh that crosses itself is inside: "positive", "nonzero" or "odd" winding numbers.
///     close: Vertices of a mesh that differ by no more than this in each coordinate are joined.
///     parameters: Values for parameters of a model file, by name.
///
/// Returns:
///     A Solid. What was repaired or is doubtful is told by `warnings.warn`.
#[pyfunction]
#[pyo3(signature = (path, *, allow_loss=false, winding="positive", close=0.0, **parameters))]
fn load(
    py: Python<'_>,
    path: PathBuf,
    allow_loss: bool,
    winding: &str,
    close: f64,
    parameters: Option<&Bound<'_, PyDict>>,
) -> PyResult<Solid> {
    let values = values_of(parameters)?;
    let solid = SolidOptions { rule: winding_of(winding)?, close: not_negative("close", close)?, textures: false };
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    let options = ReadOptions { parameters: values, folder, solid };
    let name = path.display().to_string();
    let (model, warnings) = Job::default().run(py, move || read(&path, &options))?;
    warn(py, &name, &warnings, allow_loss)?;
    Ok(Solid::of(Node::of_model(model)))
}

/// Values for parameters of a model file.
pub(crate) fn values_of(parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, f64)>> {
    let mut values: Vec<(String, f64)> = Vec::new();
    for (name, value) in parameters.into_iter().flatten() {
        let name: String = name.extract()?;
        let value: f64 =
            value.extract().map_err(|_| refuse(format!("{name}: found what is no number, expected one")))?;
        values.push((name, value));
    }
    Ok(values)
}

pub(crate) fn winding_of(name: &str) -> PyResult<WindingRule> {
    match name {
        "positive" => Ok(WindingRule::Positive),
        "nonzero" => Ok(WindingRule::NonZero),
        "odd" => Ok(WindingRule::Odd),
        found => Err(refuse(format!("winding: found {found:?}, expected \"positive\", \"nonzero\" or \"odd\""))),
    }
}

fn not_negative(name: &str, value: f64) -> PyResult<f64> {
    let is_fine = value.is_finite() && value >= 0.0;
    if is_fine {
        Ok(value)
    } else {
        Err(refuse(format!("{name}: found {value}, expected a number that is not negative")))
    }
}

/// What a file is, by the ending of its name.
pub(crate) fn kind_of(path: &Path) -> Outcome<FileKind> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let kind = FileKind::from_extension(&ending);
    kind.ok_or_else(|| at(path, format!("found a file of another kind, expected {ENDINGS}")))
}

/// The model of a file, and what was noticed.
pub(crate) fn read(path: &Path, options: &ReadOptions) -> Outcome<(Model, Vec<Warning>)> {
    let name = path.display().to_string();
    let kind = kind_of(path)?;
    let limit = if matches!(kind, FileKind::Mesh(_)) { MAX_MESH } else { MAX_TEXT as u64 };
    let bytes = read_file(path, limit).map_err(|error| at(path, error))?;
    reading::read(&bytes, kind, &name, options).map_err(|error| unread(path, &error))
}

/// Why a file was not read.
pub(crate) fn unread(path: &Path, error: &ReadError) -> Failure {
    let line = error.line().map(|line| line as usize);
    Failure { line, json_path: error.json_path().map(str::to_owned), ..said(path, error) }
}

/// The boundary of a solid as a closed mesh.
pub(crate) fn one_body(node: &Node) -> Outcome<Model> {
    let evaluated = node.evaluated()?;
    triangles::one_body(&evaluated.evaluation.mesh).map_err(|error| surface_failure(&error))
}

/// What is wrong with triangles that somebody gives, without the name of a file.
fn surface_failure(error: &SolidError) -> Failure {
    Failure::of(said_of_surface(error))
}

/// The solid that a closed mesh bounds.
///
/// A mesh that is a convex body becomes one; any other is a part of the solid as it stands, exactly and without being cut: it may cross itself, lie upon itself and be nested in itself. Vertices at one
/// place are joined where the mesh is not closed otherwise. The arrays are copied.
///
/// Args:
///     vertices: Shape (n, 3), finite numbers; or shape (n, k) with properties of vertices behind the coordinates, as manifold3d has them; or, instead of both arrays, a Mesh, a
///         `trimesh.Trimesh`, a `coacd.Mesh`, a `manifold3d.Mesh64` or another object with arrays of these names.
///     triangles: Shape (m, 3), numbers of vertices from 0, counter-clockwise seen from outside.
///     material: The name of what it is made of.
///     materials: Names of materials, instead of `material`.
///     material_ids: Shape (m,), the number of each triangle's material among `materials`.
///     winding: What is inside: points of "positive", "nonzero" or "odd" winding numbers.
///     close: Vertices that differ by no more than this in each coordinate are joined.
///     merge_from_vert: Shape (k,), vertices that are the same as those of `merge_to_vert`, as manifold3d has them.
///     merge_to_vert: Shape (k,).
///
/// Returns:
///     A Solid. PlanecutError says which edge is open, and where, if the mesh is not closed.
///
/// >>> import planecut as pc
/// >>> vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
/// >>> pc.from_mesh(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).volume
/// 0.16666666666666666
#[pyfunction]
#[pyo3(signature = (vertices, triangles=None, material=None, *, materials=None, material_ids=None, winding="positive", close=0.0, merge_from_vert=None, merge_to_vert=None))]
#[allow(clippy::too_many_arguments)]
fn from_mesh(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    triangles: Option<&Bound<'_, PyAny>>,
    material: Option<String>,
    materials: Option<Vec<String>>,
    material_ids: Option<&Bound<'_, PyAny>>,
    winding: &str,
    close: f64,
    merge_from_vert: Option<&Bound<'_, PyAny>>,
    merge_to_vert: Option<&Bound<'_, PyAny>>,
) -> PyResult<Solid> {
    let options = SolidOptions { rule: winding_of(winding)?, close: not_negative("close", close)?, textures: false };
    let own = vertices.cast::<Mesh>().ok().filter(|_| material.is_none() && materials.is_none());
    let (vertices, triangles, merges) = match triangles {
        Some(triangles) => (vertices.clone(), triangles.clone(), [merge_from_vert.cloned(), merge_to_vert.cloned()]),
        None => {
            let Some((positions, triangles)) = parts_of_mesh_object(vertices)? else {
                return Err(refuse("triangles: found none, expected an array of shape (m, 3)"));
            };
            let part = |name: &str| vertices.getattr_opt(name).ok().flatten();
            (positions, triangles, [part("merge_from_vert"), part("merge_to_vert")])
        }
    };
    let mut given = match own {
        Some(mesh) => Triangles::of_mesh(mesh.get().core()),
        None => {
            let positions = crate::arrays::positions(&vertices, "vertices")?;
            mesh::given(&positions, &triangles, material, materials, material_ids)?
        }
    };
    if let [Some(from), Some(to)] = merges {
        let count = given.positions.len();
        let from = crate::arrays::numbers(&from, "merge_from_vert", None, count)?;
        let to = crate::arrays::numbers(&to, "merge_to_vert", Some(from.len()), count)?;
        let mut same: Vec<u32> = (0..count as u32).collect();
        from.into_iter().zip(to).for_each(|(from, to)| same[from as usize] = to);
        given.triangles.iter_mut().flatten().for_each(|vertex| *vertex = same[*vertex as usize]);
    }
    if given.triangles.is_empty() {
        return Ok(Solid::of(Node::of_model(Model::default())));
    }
    let import = Job::default().run(py, move || given.solid(&options).map_err(|error| surface_failure(&error)))?;
    warn(py, "mesh", &import.warnings, false)?;
    Ok(Solid::of(Node::of_model(import.model)))
}

/// The vertices and the triangles of an object that other packages make; nothing where it is none.
pub(crate) fn parts_of_mesh_object<'py>(
    value: &Bound<'py, PyAny>,
) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
    let names =
        [("vert_properties", "tri_verts"), ("vertices", "faces"), ("vertices", "indices"), ("vertices", "triangles")];
    for (vertices, triangles) in names {
        if let (Some(vertices), Some(triangles)) = (value.getattr_opt(vertices)?, value.getattr_opt(triangles)?) {
            return Ok(Some((vertices, triangles)));
        }
    }
    Ok(None)
}

/// The solid that a `trimesh.Trimesh` bounds, as by `from_mesh`.
///
/// Args:
///     mesh: An object with `vertices` and `faces`.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (mesh, material=None))]
fn from_trimesh(py: Python<'_>, mesh: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<Solid> {
    let part = |name: &str| mesh.getattr_opt(name).ok().flatten();
    let (Some(vertices), Some(faces)) = (part("vertices"), part("faces")) else {
        return Err(refuse(format!("mesh: found {}, expected an object with vertices and faces", mesh.get_type())));
    };
    from_mesh(py, &vertices, Some(&faces), material, None, None, "positive", 0.0, None, None)
}

/// Adds the functions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(load, module)?)?;
    module.add_function(wrap_pyfunction!(from_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(from_trimesh, module)?)
}
