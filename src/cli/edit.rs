//! `planecut edit`: a live model, edits applied to it one by one, and the mesh that is left.

use std::path::Path;
use std::time::{Duration, Instant};

use planecut::csg::{Edit, EditError, Evaluation, LiveModel, Mesh, Model, evaluate_with, summarize};
use planecut::export::Part;
use planecut::import::Warning;
use planecut::import::edits::{EditsImport, read_edits};
use planecut::reading::FileKind;

use super::args::EditArgs;
use super::error::{CliError, Done};
use super::input::Input;
use super::output::{MeshTarget, Output, Target, check_targets};
use super::pieces::{bounded_model, bounded_tree_of, brushes, of_cells};
use super::product::{Contents, Product, encode, first_written, produce};
use super::progress::Progress;
use super::reading_args::ReadingArgs;
use super::report::{EditPart, Report, evaluation_time, milliseconds};
use super::serve;
use super::solve::{Read, Solved, evaluate_model, read, solid_warnings, solved, unbounded_of};

/// What is to be written where.
struct Plan<'a> {
    args: &'a EditArgs,
    /// Where the edits are.
    edits: &'a Path,
    input: Input,
    kind: FileKind,
    meshes: Vec<MeshTarget>,
    report: Option<Target>,
}

/// Runs the command: everything is complete before the first file gets its name.
///
/// # Errors
/// Any [`CliError`] but those of `check`.
pub(crate) fn run(args: &EditArgs) -> Result<Done, CliError> {
    let Some(edits) = args.edits.as_deref().filter(|_| !args.serve) else { return serve::run(args) };
    let begin = Instant::now();
    let plan = Plan::resolve(args, edits)?;
    let product = produce(&args.common, &plan.input, plan.report.as_ref(), begin, |progress| plan.carry_out(progress));
    product.map(|warnings| Done::with(&warnings, args.reading.allow_loss))
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a EditArgs, edits: &'a Path) -> Result<Self, CliError> {
        let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
        args.reading.check(kind)?;
        args.output.assets.check_without_sources()?;
        let plan = Self {
            args,
            edits,
            input,
            kind,
            meshes: args.output.targets()?,
            report: args.output.report.as_deref().map(Target::new),
        };
        let meshes: Vec<Target> = plan.meshes.iter().flat_map(MeshTarget::targets).collect();
        for file in [plan.input.file(), Some(edits)] {
            check_targets(file, meshes.iter().chain(&plan.report))?;
        }
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let begin = Instant::now();
        let (model, warnings) = read_model(&self.input, self.kind, &self.args.reading, progress)?;
        let text = Input::plain(self.edits).read()?;
        let EditsImport { edits, materials } = read_edits(&text, &self.edits.display().to_string(), &model.materials)?;
        let import_time = begin.elapsed();
        let mut live = live_model(&self.input, self.kind, model, progress)?;
        for material in materials {
            live.add_material(material);
        }
        progress.stage("editing");
        let done = self.edit(&mut live, edits)?;
        let mesh = mesh_of(&live, self.edits, 0)?;
        let read = Read { model: live.to_model(), warnings, ..Read::default() };
        let edited = if self.report.is_some() || self.args.verify {
            self.compared(mesh, read, done, import_time, progress)?
        } else {
            self.without_comparison(mesh, read)
        };
        self.encode(edited, progress)
    }

    /// Applies edits, each given with its line; with `--verify` each result is compared with a fresh build.
    fn edit(&self, live: &mut LiveModel, edits: Vec<(u32, Edit)>) -> Result<Applied, CliError> {
        let mut done = Applied { times: Vec::with_capacity(edits.len()), fresh_times: Vec::new(), fresh: None };
        for (line, edit) in edits {
            let refused = |source| CliError::Edit { path: self.edits.to_owned(), line, source };
            let before = Instant::now();
            live.apply(edit).map_err(refused)?;
            done.times.push(before.elapsed());
            if self.args.verify {
                let fresh = evaluate_with(&live.to_model(), unbounded_of(self.kind));
                let fresh = fresh.map_err(|source| refused(source.into()))?;
                check_same(&mesh_of(live, self.edits, line)?, &fresh.mesh, self.edits, line)?;
                done.fresh_times.push(evaluation_time(&fresh.times));
                done.fresh = Some(fresh);
            }
        }
        Ok(done)
    }

    /// The edited model and the report on it, compared with a fresh build.
    fn compared(
        &self,
        mesh: Mesh,
        read: Read,
        mut done: Applied,
        import_time: Duration,
        progress: &Progress,
    ) -> Result<Edited, CliError> {
        let fresh = match done.fresh {
            // the last edit was compared already
            Some(fresh) => fresh,
            None => {
                let fresh = evaluate_model(&self.input, self.kind, &read.model)?;
                check_same(&mesh, &fresh.mesh, self.edits, 0)?;
                done.fresh_times.push(evaluation_time(&fresh.times));
                fresh
            }
        };
        let mut solved = solved(&self.input, self.kind, read, fresh, import_time, progress);
        solved.report.set_edit(EditPart {
            edits: done.times.len(),
            median_ms: quantile(&mut done.times, 0.5),
            p99_ms: quantile(&mut done.times, 0.99),
            fresh_ms: quantile(&mut done.fresh_times, 0.5),
            same_as_fresh: true,
        });
        let Solved { model, unbounded, report, warnings, .. } = solved;
        Ok(Edited { model, mesh, unbounded, warnings, report: Some(report) })
    }

    /// The edited model where no comparison is asked for: nothing but its brushes is looked at again, for the warnings.
    fn without_comparison(&self, mesh: Mesh, Read { model, mut warnings, .. }: Read) -> Edited {
        let summary = summarize(&model);
        warnings.extend(solid_warnings(self.kind, &model, &summary, &mesh));
        Edited { model, mesh, unbounded: summary.unbounded, warnings, report: None }
    }

    fn encode(&self, edited: Edited, progress: &Progress) -> Result<Product, CliError> {
        let Edited { model, mesh, unbounded, warnings, mut report } = edited;
        let begin = Instant::now();
        progress.stage("encoding");
        let outputs = encode_model(self.args, (&self.input, self.kind), (&model, &unbounded), &mesh, &self.meshes)?;
        let encoding = begin.elapsed();
        let first = self.meshes.first().filter(|_| self.report.is_some());
        let options = self.args.output.assets.options(self.args.output.scale);
        if let (Some(written), Some(report)) =
            (first_written(first, &[Part::new("solid", &mesh)], &options)?, &mut report)
        {
            report.set_written(&written);
        }
        Ok(Product { warnings, report, outputs, encoding })
    }
}

/// A live model of an input, and what there is to warn of.
///
/// # Errors
/// [`CliError`] for unusable input, [`CliError::Evaluate`] for a solid without a mesh, [`CliError::Bug`] for a bug.
pub(crate) fn begin(
    input: &Input,
    kind: FileKind,
    reading: &ReadingArgs,
    progress: &Progress,
) -> Result<(LiveModel, Vec<Warning>), CliError> {
    let (model, warnings) = read_model(input, kind, reading, progress)?;
    Ok((live_model(input, kind, model, progress)?, warnings))
}

/// What an input holds, as convex bodies: edits are of these.
fn read_model(
    input: &Input,
    kind: FileKind,
    reading: &ReadingArgs,
    progress: &Progress,
) -> Result<(Model, Vec<Warning>), CliError> {
    progress.stage("reading");
    let Read { mut model, warnings, .. } = read(input, kind, reading)?;
    model.tree = of_cells(&input.path, &model.tree)?.into_owned();
    Ok((model, warnings))
}

fn live_model(input: &Input, kind: FileKind, model: Model, progress: &Progress) -> Result<LiveModel, CliError> {
    progress.stage("evaluating");
    LiveModel::from_model_with(model, unbounded_of(kind)).map_err(|error| match error {
        EditError::Evaluate(source) => CliError::of_evaluation(&input.path, source),
        source => CliError::Edit { path: input.path.clone(), line: 0, source },
    })
}

/// The files of an edited model and its mesh; `unbounded` are the numbers of the brushes that are not bounded.
///
/// # Errors
/// [`CliError`] of encoding, and of beginning to write.
pub(crate) fn encode_model(
    args: &EditArgs,
    (input, kind): (&Input, FileKind),
    (model, unbounded): (&Model, &[usize]),
    mesh: &Mesh,
    targets: &[MeshTarget],
) -> Result<Vec<Output>, CliError> {
    let parts = [Part::new("solid", mesh)];
    let brushes = || brushes(&input.path, &bounded_tree_of(kind, model, unbounded));
    let tree = || bounded_model(kind, model, unbounded);
    let contents = Contents { parts: &parts, materials: &model.materials, brushes: &brushes, model: &tree };
    encode(&contents, targets, &args.output.assets.options(args.output.scale))
}

/// Edits that were applied, and how long each took.
struct Applied {
    times: Vec<Duration>,
    /// How long a fresh build took after each edit, where it was compared with one.
    fresh_times: Vec<Duration>,
    /// The last of these builds.
    fresh: Option<Evaluation>,
}

/// The model after all edits.
struct Edited {
    model: Model,
    mesh: Mesh,
    /// Numbers of the brushes that are not bounded.
    unbounded: Vec<usize>,
    warnings: Vec<Warning>,
    report: Option<Report>,
}

fn mesh_of(live: &LiveModel, path: &Path, line: u32) -> Result<Mesh, CliError> {
    live.mesh().map_err(|source| CliError::Edit { path: path.to_owned(), line, source: source.into() })
}

fn check_same(mesh: &Mesh, fresh: &Mesh, path: &Path, line: u32) -> Result<(), CliError> {
    if mesh == fresh { Ok(()) } else { Err(CliError::NotFresh { path: path.to_owned(), line }) }
}

/// The smallest time that a share `share` of all times does not exceed, in milliseconds; `None` of no times.
fn quantile(times: &mut [Duration], share: f64) -> Option<f64> {
    times.sort_unstable();
    let place = (share * times.len() as f64).ceil() as usize;
    times.get(place.saturating_sub(1)).map(|time| milliseconds(*time))
}
