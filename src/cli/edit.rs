//! `planecut edit`: a live model, edits applied to it one by one, and the mesh that is left.

use std::path::Path;
use std::time::{Duration, Instant};

use planecut::csg::{EditError, LiveModel, Mesh, evaluate_with};
use planecut::export::Part;
use planecut::import::edits::{EditsImport, read_edits};

use super::args::EditArgs;
use super::error::CliError;
use super::input::{Input, InputKind};
use super::output::{MeshTarget, Target, check_targets};
use super::pieces::brushes;
use super::product::{Contents, Product, encode, first_written, produce};
use super::progress::Progress;
use super::report::{EditPart, milliseconds};
use super::solve::{Read, read, solve_read, unbounded_of};

/// What is to be written where.
struct Plan<'a> {
    args: &'a EditArgs,
    input: Input,
    kind: InputKind,
    meshes: Vec<MeshTarget>,
    report: Option<Target>,
}

/// Runs the command: everything is complete before the first file gets its name.
///
/// # Errors
/// Any [`CliError`] but those of `check`.
pub(crate) fn run(args: &EditArgs) -> Result<(), CliError> {
    let begin = Instant::now();
    let plan = Plan::resolve(args)?;
    produce(&args.common, &plan.input, plan.report.as_ref(), begin, |progress| plan.carry_out(progress))
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a EditArgs) -> Result<Self, CliError> {
        let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
        args.reading.check(kind)?;
        args.output.assets.check_without_sources()?;
        let plan = Self {
            args,
            input,
            kind,
            meshes: args.output.targets()?,
            report: args.output.report.as_deref().map(Target::new),
        };
        let meshes: Vec<Target> = plan.meshes.iter().flat_map(MeshTarget::targets).collect();
        for file in [plan.input.file(), Some(args.edits.as_path())] {
            check_targets(file, meshes.iter().chain(&plan.report))?;
        }
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let begin = Instant::now();
        progress.stage("reading");
        let Read { model, warnings, .. } = read(&self.input, self.kind, &self.args.reading)?;
        let text = Input::plain(&self.args.edits).read()?;
        let EditsImport { edits, materials } =
            read_edits(&text, &self.args.edits.display().to_string(), &model.materials)?;
        let import_time = begin.elapsed();
        progress.stage("evaluating");
        let mut live = LiveModel::from_model_with(model, unbounded_of(self.kind)).map_err(|error| match error {
            EditError::Evaluate(source) => CliError::of_evaluation(&self.input.path, source),
            source => CliError::Edit { path: self.input.path.clone(), line: 0, source },
        })?;
        for material in materials {
            live.add_material(material);
        }
        progress.stage("editing");
        let mut times = Vec::with_capacity(edits.len());
        let mut fresh_times = Vec::new();
        for (line, edit) in edits {
            let refused = |source| CliError::Edit { path: self.args.edits.clone(), line, source };
            let before = Instant::now();
            live.apply(edit).map_err(refused)?;
            times.push(before.elapsed());
            if self.args.verify {
                let before = Instant::now();
                let fresh = evaluate_with(&live.to_model(), unbounded_of(self.kind));
                fresh_times.push(before.elapsed());
                let fresh = fresh.map_err(|source| refused(source.into()))?;
                check_same(&mesh_of(&live, &self.args.edits, line)?, &fresh.mesh, &self.args.edits, line)?;
            }
        }
        let mesh = mesh_of(&live, &self.args.edits, 0)?;
        let read = Read { model: live.to_model(), warnings, ..Read::default() };
        let mut solved = solve_read(&self.input, self.kind, read, import_time, progress)?;
        check_same(&mesh, &solved.mesh, &self.args.edits, 0)?;
        solved.report.set_edit(EditPart {
            edits: times.len(),
            median_ms: quantile(&mut times, 0.5),
            p99_ms: quantile(&mut times, 0.99),
            fresh_ms: quantile(&mut fresh_times, 0.5).unwrap_or(solved.report.time_ms.of_evaluation()),
            same_as_fresh: true,
        });
        let begin = Instant::now();
        progress.stage("encoding");
        let options = self.args.output.assets.options(self.args.output.scale);
        let parts = [Part::new("solid", &solved.mesh)];
        let contents =
            Contents { parts: &parts, materials: &solved.model.materials, brushes: &|| brushes(self.kind, &solved) };
        let outputs = encode(&contents, &self.meshes, &options)?;
        let encoding = begin.elapsed();
        let first = self.meshes.first().filter(|_| self.report.is_some());
        if let Some(written) = first_written(first, &parts, &options)? {
            solved.report.set_written(&written);
        }
        Ok(Product { solved, outputs, encoding })
    }
}

fn mesh_of(live: &LiveModel, path: &Path, line: u32) -> Result<Mesh, CliError> {
    live.mesh().map_err(|source| CliError::Edit { path: path.to_owned(), line, source: source.into() })
}

fn check_same(mesh: &Mesh, fresh: &Mesh, path: &Path, line: u32) -> Result<(), CliError> {
    if mesh == fresh { Ok(()) } else { Err(CliError::NotFresh { path: path.to_owned(), line }) }
}

/// The smallest time that such a share of all does not exceed, in milliseconds; nothing of none.
fn quantile(times: &mut [Duration], share: f64) -> Option<f64> {
    times.sort_unstable();
    let place = (share * times.len() as f64).ceil() as usize;
    times.get(place.saturating_sub(1)).map(|time| milliseconds(*time))
}
