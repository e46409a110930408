//! `planecut info`: what a file holds, as the report's JSON on standard output.

use std::time::Instant;

use planecut::csg::check::check_topology;
use planecut::import::Warning;
use planecut::import::mesh::{MeshFormat, read_mesh};

use super::args::InfoArgs;
use super::error::CliError;
use super::input::{Input, Kind};
use super::pool::on_threads;
use super::progress::Progress;
use super::report::{Report, milliseconds};
use super::solve::solve;
use super::terminal;

/// Runs the command. A model or a map is evaluated; a mesh is taken as it is.
///
/// # Errors
/// [`CliError`] where the input is unusable, or where the solid has no mesh.
pub(crate) fn run(args: &InfoArgs) -> Result<(), CliError> {
    let begin = Instant::now();
    let expected = "`.json`, `.map`, `.csg`, `.obj`, `.stl`, `.ply`, `.glb` or `.gltf`";
    let (input, kind) = Input::resolve(&args.input, args.reading.input_format, Some, expected)?;
    args.reading.check(match kind {
        Kind::Model(kind) => Some(kind),
        Kind::Mesh(_) => None,
    })?;
    let progress = Progress::start(args.common.quiet);
    let (mut report, warnings) = on_threads(args.common.threads, || match kind {
        Kind::Model(kind) => {
            let solved = solve(&input, kind, &args.reading, &progress)?;
            Ok((solved.report, solved.warnings))
        }
        Kind::Mesh(format) => report_on_mesh(&input, format),
    })?;
    drop(progress);
    if !args.common.quiet {
        terminal::print_warnings(&input.name(), &warnings);
    }
    report.time_ms.total = milliseconds(begin.elapsed());
    terminal::print_text(&report.to_json())
}

fn report_on_mesh(input: &Input, format: MeshFormat) -> Result<(Report, Vec<Warning>), CliError> {
    let begin = Instant::now();
    let mesh = read_mesh(&input.read()?, format, &input.name())?;
    let import_time = begin.elapsed();
    let topology = check_topology(&mesh.positions, &mesh.triangles);
    let mut report = Report::of_mesh(input.given(), format_name(format), &topology);
    report.time_ms.import = milliseconds(import_time);
    let warning = topology.first_defect.map(|defect| Warning { line: 0, message: defect.to_string() });
    report.warnings = warning.iter().map(ToString::to_string).collect();
    Ok((report, warning.into_iter().collect()))
}

fn format_name(format: MeshFormat) -> &'static str {
    match format {
        MeshFormat::Obj => "obj",
        MeshFormat::Stl => "stl",
        MeshFormat::Ply => "ply",
        MeshFormat::Gltf => "gltf",
    }
}
