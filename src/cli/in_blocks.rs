//! `planecut build --blocks`: a model that is larger than memory, block by block.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use planecut::blocks::{BlockPlan, BlocksError, Pieces, PlanBuilder, evaluate_all};
use planecut::csg::{BlockOptions, Material, Model};
use planecut::export::{ExportError, ExportOptions, write_mtl_of_pieces, write_pieces};
use planecut::import::Warning;
use planecut::import::stream::{StreamError, stream_map, stream_model};
use planecut::reading::FileKind;
use planecut::tiles::{TileOptions, TilesError, write_tiles};
use tempfile::TempDir;

use super::args::BuildArgs;
use super::error::{CliError, Done};
use super::input::Input;
use super::output::{MeshTarget, Output, OutputFormat, Target, check_targets};
use super::pool::on_threads;
use super::progress::Progress;
use super::reading_args::ReadingArgs;
use super::report::{Report, milliseconds};
use super::solve::{Read, read};
use super::terminal;

/// What is to be written where.
struct Job<'a> {
    args: &'a BuildArgs,
    input: Input,
    kind: FileKind,
    reading: ReadingArgs,
    meshes: Vec<MeshTarget>,
    report: Option<Target>,
}

/// What was made of the input.
struct Made {
    outputs: Vec<Output>,
    warnings: Vec<Warning>,
    report: Report,
}

/// Runs the command: all blocks are evaluated, and fit together, before the first file gets its name.
///
/// # Errors
/// Any [`CliError`] but those of `check`.
pub(crate) fn run(args: &BuildArgs) -> Result<Done, CliError> {
    let begin = Instant::now();
    let job = Job::resolve(args)?;
    // gone when it is dropped
    let (work, _temporary) = match &args.blocks.work_dir {
        Some(folder) => (folder.clone(), None),
        None => {
            let folder = TempDir::with_prefix("planecut-blocks-")
                .map_err(|source| write_error(&std::env::temp_dir(), source))?;
            (folder.path().to_owned(), Some(folder))
        }
    };
    let progress = Progress::start(args.common.quiet);
    let made = on_threads(args.common.threads, || job.carry_out(&work, begin, &progress));
    drop(progress);
    let Made { outputs, warnings, mut report } = made?;
    if !args.common.quiet {
        terminal::print_warnings(&job.input.name(), &warnings);
    }
    let writing = Instant::now();
    Output::commit_all(outputs)?;
    if let Some(target) = &job.report {
        report.time_ms.export += milliseconds(writing.elapsed());
        report.time_ms.total = milliseconds(begin.elapsed());
        target.write(report.to_json().as_bytes())?;
    }
    Ok(Done::with(&warnings, args.reading.allow_loss))
}

impl<'a> Job<'a> {
    fn resolve(args: &'a BuildArgs) -> Result<Self, CliError> {
        let [path] = &args.inputs[..] else {
            return Err(CliError::Usage("found several inputs with --blocks or --tiles, expected one".to_owned()));
        };
        let (input, kind) = Input::resolve_any(path, args.reading.input_format)?;
        args.reading.check(kind)?;
        let meshes = args.output.targets()?;
        if let Some(place) = meshes.iter().find(|place| !matches!(place.format, OutputFormat::Mesh(_))) {
            let path = PathBuf::from(place.target.to_string());
            let expected = "a mesh (.glb, .gltf, .obj, .stl or .ply) with --blocks";
            return Err(CliError::Output { path, found: "convex bodies or a model", expected });
        }
        let report = args.output.report.as_deref().map(Target::new);
        let targets: Vec<Target> = meshes.iter().flat_map(MeshTarget::targets).collect();
        check_targets(input.file(), targets.iter().chain(&report))?;
        Ok(Self { args, input, kind, reading: args.reading.streamed(), meshes, report })
    }

    fn carry_out(&self, work: &Path, begin: Instant, progress: &Progress) -> Result<Made, CliError> {
        progress.stage("reading");
        let options =
            BlockOptions { brushes: self.args.blocks.blocks.flatten().unwrap_or(BlockOptions::default().brushes) };
        let (plan, mut warnings) = self.plan(work, options)?;
        if plan.model().unbounded > 0 {
            let (count, line) = (plan.model().unbounded, plan.model().first_unbounded);
            let message = format!("left out {count} brushes that are not bounded, the first of them here");
            warnings.push(Warning::loss(line, message, usize::try_from(count).unwrap_or(usize::MAX)));
        }
        let read = begin.elapsed();
        let evaluating = Instant::now();
        let pieces = self.evaluate(&plan, progress)?;
        let evaluated = evaluating.elapsed();
        let encoding = Instant::now();
        progress.stage("writing");
        let (outputs, vertices) = self.write(&pieces)?;
        if let Some(folder) = &self.args.blocks.tiles {
            progress.stage("writing tiles");
            let options = TileOptions { export: self.export_options(), ..TileOptions::default() };
            write_tiles(&pieces, folder, &options).map_err(|source| tiles_error(folder, source))?;
        }
        let mut report = Report::of_blocks(self.input.given(), self.kind.name(), &plan, &pieces, vertices);
        report.set_times(read, evaluated, encoding.elapsed());
        report.warn(&warnings);
        Ok(Made { outputs, warnings, report })
    }

    /// Reads the input, as a stream where its kind is read so.
    fn plan(&self, work: &Path, options: BlockOptions) -> Result<(BlockPlan, Vec<Warning>), CliError> {
        let failed = |source: BlocksError| self.failed(source);
        let mut builder = PlanBuilder::create(work, options).map_err(failed)?;
        let (materials, warnings): (Vec<Material>, Vec<Warning>) = match self.kind {
            FileKind::Map => {
                builder = builder.leaving_out_unbounded();
                let from = self.input.stream()?;
                let read = stream_map(from, &self.input.name(), &self.reading.map_options(), &mut builder);
                let summary = read.map_err(|error| self.of_stream(error))?;
                (summary.materials, summary.warnings)
            }
            FileKind::Model => {
                let (text, options) = (self.input.read()?, self.reading.model_options(&self.input));
                let read = stream_model(&text, &self.input.name(), &options, &mut builder);
                let summary = read.map_err(|error| self.of_stream(error))?;
                (summary.materials, summary.warnings)
            }
            FileKind::Scad | FileKind::Mesh(_) => {
                let Read { model: Model { materials, tree }, warnings, .. } =
                    read(&self.input, self.kind, &self.reading)?;
                tree.send(&mut builder).map_err(failed)?;
                (materials, warnings)
            }
        };
        Ok((builder.finish(materials).map_err(failed)?, warnings))
    }

    fn evaluate(&self, plan: &BlockPlan, progress: &Progress) -> Result<Pieces, CliError> {
        let available = || thread::available_parallelism().map_or(1, NonZero::get);
        let threads = self.args.common.threads.map_or_else(available, usize::from);
        let watch = |done, of| {
            progress.counted("evaluating blocks", done, of);
            true
        };
        evaluate_all(plan, threads, &watch).map_err(|source| self.failed(source))
    }

    /// Writes all outputs, which have no names yet; gives the vertices of the mesh, each counted once, where it was written.
    fn write(&self, pieces: &Pieces) -> Result<(Vec<Output>, Option<u64>), CliError> {
        let (mut outputs, mut vertices) = (Vec::new(), None);
        for place in &self.meshes {
            let OutputFormat::Mesh(format) = place.format else { unreachable!("others are refused") };
            let library = place.library();
            let material_library = library.as_ref().and_then(Target::file_name);
            let options = ExportOptions { material_library, ..self.export_options() };
            outputs.push(place.target.begin_large(|out| {
                vertices = Some(write_pieces(pieces, format, &options, out)?.vertices);
                Ok::<(), ExportError>(())
            })?);
            if let Some(library) = library {
                outputs.push(library.begin_large(|out| write_mtl_of_pieces(pieces, out))?);
            }
        }
        Ok((outputs, vertices))
    }

    fn export_options(&self) -> ExportOptions {
        self.args.output.assets.options(self.args.output.scale)
    }

    fn failed(&self, source: BlocksError) -> CliError {
        blocks_error(&self.input, source)
    }

    fn of_stream<E: Into<CliError>>(&self, error: StreamError<E, BlocksError>) -> CliError {
        match error {
            StreamError::Input(error) => error.into(),
            StreamError::Sink(source) => self.failed(source),
        }
    }
}

/// Why an input is not evaluated in blocks.
fn blocks_error(input: &Input, source: BlocksError) -> CliError {
    match source {
        BlocksError::Io { path, source } => CliError::Write { path, source },
        BlocksError::Export(ExportError::Write { path, source }) => CliError::Write { path, source },
        source => CliError::Blocks { path: input.path.clone(), source },
    }
}

/// Why a tile set is not written.
fn tiles_error(folder: &Path, source: TilesError) -> CliError {
    match source {
        TilesError::Write { path, source } | TilesError::Export(ExportError::Write { path, source }) => {
            CliError::Write { path, source }
        }
        source => CliError::Tiles { folder: folder.to_owned(), source },
    }
}

fn write_error(path: &Path, source: std::io::Error) -> CliError {
    CliError::Write { path: path.to_owned(), source }
}
