//! From a file, or from solids that come one by one, to a plan.

use std::collections::HashMap;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use planecut::blocks::{BlockPlan, BlocksError, PlanBuilder};
use planecut::csg::{BlockOptions, Brush, Material, MaterialId, Model, Operation, TreeSink};
use planecut::expression::Node;
use planecut::import::Warning;
use planecut::import::file::{open_stream, read_file};
use planecut::import::map::MapOptions;
use planecut::import::model::{MAX_STREAMED, MAX_TEXT, ModelOptions};
use planecut::import::stream::{StreamError, stream_map, stream_model};
use planecut::reading::{FileKind, ReadError, ReadOptions};
use planecut_parallel::job::check;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::plan::Plan;
use crate::errors::{Failure, Outcome, refuse};
use crate::files::{at, kind_of, read, unread, values_of, warn};
use crate::job::Job;
use crate::solid::Solid;

/// Solids of fewer bodies than this are taken without a thread of their own.
const FEW_BODIES: u64 = 1000;

/// Cuts a model into blocks: what each is to know is written into a file of its own.
///
/// Memory holds little of the model at any time. All of it must be bounded convex bodies; closed meshes are refused.
///
/// Args:
///     source: A file, or a Solid, or an iterable of Solid that are united: they are taken one by one, and none is kept. Of files, .map and .json are read as a stream; .csg and meshes
///         are in memory while they are read.
///     folder: The folder for the plan, its blocks and their pieces; it is made where it is missing. An earlier plan there is replaced; pieces that still are those of their blocks stay.
///     brushes: How many convex bodies a block has, about.
///     allow_loss: Whether solids that a file states and that cannot be made are left out, with a warning, instead of being an error.
///     parameters: Values for parameters of a model file, by name.
///
/// Returns:
///     A Plan. `PlanecutError` for what `load` refuses, and for a body that reaches infinity or is a closed mesh, with the line where a file has one.
#[pyfunction]
#[pyo3(signature = (source, folder, *, brushes=8192, allow_loss=false, **parameters))]
pub(super) fn plan(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    folder: PathBuf,
    brushes: usize,
    allow_loss: bool,
    parameters: Option<&Bound<'_, PyDict>>,
) -> PyResult<Plan> {
    if brushes == 0 {
        return Err(refuse("brushes: found 0, expected 1 or more"));
    }
    let values = values_of(parameters)?;
    let options = BlockOptions { brushes };
    if let Ok(path) = source.extract::<PathBuf>() {
        let input = Input { path: path.clone(), values, allow_loss };
        let (plan, warnings) = Job::default().run(py, move || input.plan(&folder, options))?;
        warn(py, &path.display().to_string(), &warnings, allow_loss)?;
        let plan = plan.ok_or_else(|| Failure::bug("found no plan and no loss"))?;
        return Plan::of(py, plan);
    }
    if !values.is_empty() {
        return Err(refuse("parameters: found some for solids, expected a model file (.json)"));
    }
    let mut union = Union::begin(&folder, options)?;
    if let Ok(solid) = source.cast::<Solid>() {
        union = union.with(py, Arc::clone(solid.get().node()))?;
    } else {
        let solids = source.try_iter().map_err(|_| unusable(source, ""))?;
        for solid in solids {
            py.check_signals()?;
            let solid = solid?;
            let node = solid.cast::<Solid>().map(|solid| Arc::clone(solid.get().node()));
            let node = node.map_err(|_| unusable(&solid, " in it"))?;
            drop(solid);
            union = union.with(py, node)?;
        }
    }
    Plan::of(py, Job::default().run(py, move || union.finish())?)
}

/// The error of something else than solids.
fn unusable(value: &Bound<'_, PyAny>, place: &str) -> PyErr {
    let name = value.get_type().name().map_or_else(|_| "something else".to_owned(), |name| name.to_string());
    refuse(format!("source: found {name}{place}, expected a file or solids"))
}

/// The union of solids, of which one is known at a time.
struct Union {
    builder: PlanBuilder,
    materials: Vec<Material>,
    numbers: HashMap<String, Vec<MaterialId>>,
}

impl Union {
    fn begin(folder: &Path, options: BlockOptions) -> Outcome<Self> {
        let mut builder = PlanBuilder::create(folder, options)?;
        builder.begin(Operation::Union)?;
        Ok(Self { builder, materials: Vec::new(), numbers: HashMap::new() })
    }

    /// Takes a solid.
    fn with(mut self, py: Python<'_>, node: Arc<Node>) -> PyResult<Self> {
        let is_short = node.pieces() < FEW_BODIES;
        Job::default().short_if(is_short).run(py, move || {
            let Model { materials, mut tree } = node.model()?;
            let numbers: Vec<MaterialId> = materials.into_iter().map(|material| self.number(material)).collect();
            let used = tree.brushes_mut().iter_mut().flat_map(Brush::materials_mut);
            used.for_each(|own| *own = numbers[own.0 as usize]);
            tree.send(&mut Checked(&mut self.builder))?;
            Ok(self)
        })
    }

    /// The number of a material.
    fn number(&mut self, material: Material) -> MaterialId {
        let known = self.numbers.get(&material.name);
        let same = known.and_then(|known| known.iter().find(|number| self.materials[number.0 as usize] == material));
        same.copied().unwrap_or_else(|| {
            let number = MaterialId(self.materials.len() as u32);
            self.numbers.entry(material.name.clone()).or_default().push(number);
            self.materials.push(material);
            number
        })
    }

    fn finish(mut self) -> Outcome<BlockPlan> {
        self.builder.end()?;
        Ok(self.builder.finish(self.materials)?)
    }
}

/// A file with a model.
struct Input {
    path: PathBuf,
    values: Vec<(String, f64)>,
    allow_loss: bool,
}

impl Input {
    /// The plan, where nothing is lost that must not be, and what was noticed.
    fn plan(&self, folder: &Path, options: BlockOptions) -> Outcome<(Option<BlockPlan>, Vec<Warning>)> {
        let (path, name) = (&self.path, self.path.display().to_string());
        let kind = kind_of(path)?;
        if !self.values.is_empty() && kind != FileKind::Model {
            return Err(unread(path, &ReadError::Parameters { name }));
        }
        let beside = path.parent().map(Path::to_owned).unwrap_or_default();
        let create = || PlanBuilder::create(folder, options);
        let (builder, materials, mut warnings) = match kind {
            FileKind::Map => {
                let from = open_stream(path).map_err(|error| at(path, error))?;
                let mut builder = create()?;
                if self.allow_loss {
                    builder = builder.leaving_out_unbounded();
                }
                let read = stream_map(from, &name, &MapOptions::default(), &mut Checked(&mut builder));
                let summary = read.map_err(|error| self.of_stream(error))?;
                (builder, summary.materials, summary.warnings)
            }
            FileKind::Model => {
                let text = read_file(path, MAX_TEXT as u64).map_err(|error| at(path, error))?;
                let max_pieces = usize::try_from(MAX_STREAMED).unwrap_or(usize::MAX);
                let parameters = self.values.clone();
                let options = ModelOptions { parameters, max_pieces, folder: beside, ..ModelOptions::default() };
                let mut builder = create()?;
                let read = stream_model(&text, &name, &options, &mut Checked(&mut builder));
                let summary = read.map_err(|error| self.of_stream(error))?;
                (builder, summary.materials, summary.warnings)
            }
            FileKind::Scad | FileKind::Mesh(_) => {
                let options = ReadOptions { folder: beside, ..ReadOptions::default() };
                let (Model { materials, tree }, warnings) = read(path, &options)?;
                let mut builder = create()?;
                tree.send(&mut Checked(&mut builder)).map_err(|error| self.refused(error))?;
                (builder, materials, warnings)
            }
        };
        // what is lost is an error before the long part of the work
        if !self.allow_loss && warnings.iter().any(|warning| warning.left_out > 0) {
            return Ok((None, warnings));
        }
        let plan = builder.finish(materials).map_err(|error| self.refused(error))?;
        if plan.model().unbounded > 0 {
            let (count, line) = (plan.model().unbounded, plan.model().first_unbounded);
            let message = format!("left out {count} brushes that are not bounded, the first of them here");
            warnings.push(Warning::loss(line, message, usize::try_from(count).unwrap_or(usize::MAX)));
        }
        Ok((Some(plan), warnings))
    }

    fn of_stream<E>(&self, error: StreamError<E, BlocksError>) -> Failure
    where
        ReadError: From<E>,
    {
        match error {
            StreamError::Input(error) => unread(&self.path, &error.into()),
            StreamError::Sink(error) => self.refused(error),
        }
    }

    /// Why the model of the file has no plan.
    fn refused(&self, error: BlocksError) -> Failure {
        if !matches!(error, BlocksError::Brush { .. } | BlocksError::Unbounded) {
            return error.into();
        }
        let line = Some(error.line() as usize).filter(|line| *line > 0);
        let place = line.map_or_else(String::new, |line| format!(":{line}"));
        let is_map = self.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("map"));
        let help = if is_map { " (allow_loss=True goes on without it)" } else { "" };
        let message = format!("{}{place}: {error}{help}", self.path.display());
        Failure { message, line, ..at(&self.path, "") }
    }
}

/// Takes pieces of a tree until the work is to end.
struct Checked<'a>(&'a mut PlanBuilder);

impl TreeSink for Checked<'_> {
    type Error = BlocksError;

    fn begin(&mut self, operation: Operation) -> Result<(), BlocksError> {
        self.0.begin(operation)
    }

    fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), BlocksError> {
        check();
        self.0.leaf(brush, line)
    }

    fn end(&mut self) -> Result<(), BlocksError> {
        self.0.end()
    }
}
