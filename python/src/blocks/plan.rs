//! Plans.

use std::num::NonZero;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use glam::DVec3;
use numpy::PyArray1;
use planecut::blocks::{BlockPlan, evaluate_all};
use planecut_parallel::job::{check, progress as note_progress, watched};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use super::pieces::Pieces;
use crate::arrays::small;
use crate::errors::{Failure, refuse};
use crate::job::Job;

/// A model cut into blocks, each with a file of what it is to know, in a folder. `plan` makes one, `open` finds it again.
#[pyclass(frozen, module = "planecut.blocks")]
pub(crate) struct Plan {
    plan: Arc<BlockPlan>,
    blocks: Py<PyTuple>,
}

impl Plan {
    pub(super) fn of(py: Python<'_>, plan: BlockPlan) -> PyResult<Self> {
        let block = |(number, block): (usize, &planecut::blocks::PlannedBlock)| {
            let bounds = plan.grid().bounds(block.place);
            Block {
                place: block.place.into(),
                brushes: block.brushes,
                bytes: block.bytes,
                path: plan.block_path(number),
                piece_path: plan.piece_path(number),
                corners: [bounds.min, bounds.max],
            }
        };
        let blocks = plan.blocks().iter().enumerate().map(|planned| Py::new(py, block(planned)));
        let blocks = PyTuple::new(py, blocks.collect::<PyResult<Vec<_>>>()?)?.unbind();
        Ok(Self { plan: Arc::new(plan), blocks })
    }

    /// The number of a block, which must be one of the plan.
    fn known(&self, block: usize) -> PyResult<usize> {
        let count = self.plan.blocks().len();
        if block >= count {
            return Err(refuse(format!("block: found {block}, expected a number below {count}")));
        }
        Ok(block)
    }
}

#[pymethods]
impl Plan {
    /// The blocks, a tuple of Block.
    #[getter]
    fn blocks(&self, py: Python<'_>) -> Py<PyTuple> {
        self.blocks.clone_ref(py)
    }

    /// What the model holds.
    #[getter]
    fn counts(&self) -> Counts {
        let model = self.plan.model();
        Counts {
            brushes: model.brushes,
            planes: model.planes,
            empty: model.empty,
            redundant_planes: model.redundant_planes,
            snapped_planes: model.snapped_planes,
            unbounded: model.unbounded,
            brush_volume_sum: model.brush_volume_sum,
        }
    }

    /// The names of the materials of the model.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.plan.materials().iter().map(|material| material.name.as_str()).collect()
    }

    /// The folder of the plan, a `pathlib.Path`.
    #[getter]
    fn folder(&self) -> &Path {
        self.plan.folder()
    }

    /// Evaluates the blocks whose pieces are not there yet, and proves that all pieces fit together. What was interrupted goes on where it was. The pieces are the same bytes wherever
    /// they are made.
    ///
    /// Args:
    ///     engine: Where blocks are evaluated: on "local" threads of this process, by tasks of "ray" (`planecut[ray]`), or of "dask" (`planecut[dask]`), on workers with this version of
    ///         planecut. These take the bytes of a block and give those of its piece, so that workers need not see the folder.
    ///     workers: Number of blocks at a time, and so in memory; by default one for each core, and for a cluster two for each of its cores, so that none waits.
    ///     address: The address of a cluster. Without it the one is used that this process is connected to, or else one that begins on this machine.
    ///     progress: A function that is called with done and total, in blocks.
    ///
    /// Returns:
    ///     Pieces. `PlanecutError` for a file of the plan that is not what was written; what a cluster itself raises comes out as it is.
    #[pyo3(
        signature = (engine="local", *, workers=None, address=None, progress=None),
        text_signature = "($self, engine='local', *, workers=None, address=None, progress=None)"
    )]
    fn evaluate(
        slf: &Bound<'_, Self>,
        engine: &str,
        workers: Option<usize>,
        address: Option<&str>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Pieces> {
        let py = slf.py();
        if let Some(found) = workers.filter(|workers| !(1..=1 << 20).contains(workers)) {
            return Err(refuse(format!("workers: found {found}, expected 1 to 1048576")));
        }
        // this thread waits for those that work
        let job = Job::new(py, Some(1), progress.as_ref().map(|progress| progress.clone_ref(py)))?;
        let plan = Arc::clone(&slf.get().plan);
        if engine != "local" {
            let module = py.import("planecut.blocks._engines")?;
            module.getattr("evaluate")?.call1((slf, engine, workers, address, progress))?;
            return Pieces::open(py, plan);
        }
        if address.is_some() {
            return Err(refuse("address: found one for engine=\"local\", expected none"));
        }
        let threads = workers.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get));
        let own = Arc::clone(&plan);
        let pieces = job.counted().run_watched(py, move |watch| {
            let go_on = |done, of| {
                let told = || {
                    note_progress(done, of);
                    check();
                };
                catch_unwind(AssertUnwindSafe(|| watched(watch, told))).is_ok()
            };
            Ok(evaluate_all(&own, threads, &go_on)?)
        })?;
        Ok(Pieces::of(plan, pieces))
    }

    /// The bytes of a block whose piece is not there; None where it is.
    fn _missing<'py>(&self, py: Python<'py>, block: usize) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let block = self.known(block)?;
        let missing = py.detach(|| self.plan.missing(block)).map_err(Failure::from)?;
        Ok(missing.map(|bytes| PyBytes::new(py, &bytes)))
    }

    /// Takes the piece of a block into its file.
    fn _store(&self, py: Python<'_>, block: usize, piece: &[u8]) -> PyResult<()> {
        let block = self.known(block)?;
        Ok(py.detach(|| self.plan.store(block, piece)).map_err(Failure::from)?)
    }

    fn __repr__(&self) -> String {
        let (brushes, blocks) = (self.plan.model().brushes, self.plan.blocks().len());
        format!("<planecut.blocks.Plan of {brushes} brushes in {blocks} blocks>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (PathBuf,))> {
        Ok((slf.py().import("planecut.blocks")?.getattr("open")?, (slf.get().plan.folder().to_owned(),)))
    }
}

/// The plan that is in a folder.
///
/// Args:
///     folder: The folder that was given to `plan`.
///
/// Returns:
///     A Plan. `PlanecutError` where there is none, or one of another version of planecut.
#[pyfunction]
pub(super) fn open(py: Python<'_>, folder: PathBuf) -> PyResult<Plan> {
    let plan = py.detach(|| BlockPlan::open(&folder)).map_err(Failure::from)?;
    Plan::of(py, plan)
}

/// A block of a plan: a box of space, and the convex bodies that reach into it.
#[pyclass(frozen, module = "planecut.blocks")]
pub(crate) struct Block {
    /// The number of the block along each axis, three of them.
    #[pyo3(get)]
    place: (u32, u32, u32),
    /// How many convex bodies reach into it.
    #[pyo3(get)]
    brushes: u64,
    /// How many bytes its file has.
    #[pyo3(get)]
    bytes: u64,
    /// The file of what it is to know, which `evaluate_block` takes; a `pathlib.Path`.
    #[pyo3(get)]
    path: PathBuf,
    /// The file of its piece, which `evaluate_block` gives; a `pathlib.Path`.
    #[pyo3(get)]
    piece_path: PathBuf,
    corners: [DVec3; 2],
}

#[pymethods]
impl Block {
    /// The least coordinates of its box, shape (3,).
    #[getter]
    fn min<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        small(py, &self.corners[0].to_array())
    }

    /// The greatest coordinates of its box, shape (3,).
    #[getter]
    fn max<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        small(py, &self.corners[1].to_array())
    }

    fn __repr__(&self) -> String {
        format!("<planecut.blocks.Block at {:?} of {} brushes>", self.place, self.brushes)
    }
}

/// What a model holds.
#[pyclass(frozen, module = "planecut.blocks")]
pub(crate) struct Counts {
    /// Convex bodies, all of them.
    #[pyo3(get)]
    brushes: u64,
    /// Planes of all bodies.
    #[pyo3(get)]
    planes: u64,
    /// Bodies without interior.
    #[pyo3(get)]
    empty: u64,
    /// Planes of bodies that have no face there.
    #[pyo3(get)]
    redundant_planes: u64,
    /// Different planes for which another stands that is nearly the same.
    #[pyo3(get)]
    snapped_planes: u64,
    /// Bodies of a map that are left out as they reach infinity.
    #[pyo3(get)]
    unbounded: u64,
    /// The sum of the volumes of the bodies, in cubes of the unit of length; where they overlap it counts each.
    #[pyo3(get)]
    brush_volume_sum: f64,
}

#[pymethods]
impl Counts {
    fn __repr__(&self) -> String {
        format!("<planecut.blocks.Counts of {} brushes with {} planes>", self.brushes, self.planes)
    }
}
