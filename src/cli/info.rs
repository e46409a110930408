//! `planecut info`: what a file holds, as the report's JSON on standard output.

use std::fmt::Display;
use std::time::Instant;

use planecut::check::check_topology;
use planecut::import::Warning;
use planecut::import::mesh::{MeshFormat, read_mesh, solid_of_mesh};
use planecut::reading::FileKind;

use super::args::InfoArgs;
use super::error::{CliError, Done, advice};
use super::input::Input;
use super::pool::on_threads;
use super::progress::Progress;
use super::reading_args::ReadingArgs;
use super::report::{Report, milliseconds};
use super::solve::{Read, solve, solve_read};
use super::terminal;

/// Runs the command. What makes a solid is evaluated; of a mesh, counts are those of the file.
///
/// # Errors
/// [`CliError`] where the input is unusable, or where the solid has no mesh.
pub(crate) fn run(args: &InfoArgs) -> Result<Done, CliError> {
    let begin = Instant::now();
    let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
    args.reading.check(kind)?;
    let progress = Progress::start(args.common.quiet);
    let (mut report, warnings) = on_threads(args.common.threads, || match kind {
        FileKind::Mesh(format) => report_on_mesh(&input, format, &args.reading, &progress),
        kind => {
            let solved = solve(&input, kind, &args.reading, None, false, &progress)?;
            Ok((solved.report, solved.warnings))
        }
    })?;
    drop(progress);
    if !args.common.quiet {
        terminal::print_warnings(&input.name(), &warnings);
    }
    report.time_ms.total = milliseconds(begin.elapsed());
    terminal::print_text(&report.to_json())?;
    Ok(Done::with(&warnings, args.reading.allow_loss))
}

/// What the file says of the mesh, and what its solid is where there is one.
fn report_on_mesh(
    input: &Input,
    format: MeshFormat,
    reading: &ReadingArgs,
    progress: &Progress,
) -> Result<(Report, Vec<Warning>), CliError> {
    let begin = Instant::now();
    progress.stage("reading");
    let kind = FileKind::Mesh(format);
    let mesh = read_mesh(&input.read()?, format, &input.name())?;
    let reading_time = begin.elapsed();
    let topology = check_topology(&mesh.positions, &mesh.triangles);
    let mut report = Report::of_mesh(input.given(), kind.name(), &topology);
    report.time_ms.import = milliseconds(reading_time);
    let mut warnings: Vec<Warning> = topology.first_defect.map(warning).into_iter().collect();
    let begin = Instant::now();
    match solid_of_mesh(mesh, format, &input.name(), &reading.solid_options()) {
        Ok(import) => {
            let read = Read { model: import.model, warnings: import.warnings, ..Read::default() };
            let solved = solve_read(input, kind, read, reading_time + begin.elapsed(), progress)?;
            report.take_model(solved.report);
            warnings.extend(solved.warnings);
        }
        Err(error) => warnings.push(warning(format_args!("no solid: {error}{}", advice(&error)))),
    }
    report.warn(&warnings);
    Ok((report, warnings))
}

fn warning(message: impl Display) -> Warning {
    Warning::note(0, message.to_string())
}
