//! Few convex cells around solids, triangles and decompositions: [`subject`] is what is coarsened and how, [`coarsened`] what comes of it, [`saving`] how that is written.

mod coarsened;
mod saving;
mod subject;

use std::sync::Arc;

use planecut::cells::coarsen::{CoarsenOptions, Side};
use planecut::coarsening::{Taken, WrittenCells};
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{Model, Tree};
use planecut::export::Engine;
use planecut::expression::Node;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::cells::Cell;
use crate::errors::{Failure, Outcome, refuse};
use crate::job::Job;
use crate::solid::Solid;
pub(crate) use coarsened::Coarsened;
use coarsened::Data;
use subject::Subject;

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
    let limits = engine.map(Engine::from_name).transpose().map_err(refuse)?.map(Engine::limits);
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
        let written = subject.coarsened(taken, &options)?;
        let WrittenCells { cells, meshes, outcome, materials, bounded, note, visual, is_closed } = written;
        let data = Data {
            cells: cells.into_iter().map(|cell| Cell::of_piece(cell.piece, cell.material.name)).collect(),
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

/// Adds the function to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(coarsen, module)?)
}
