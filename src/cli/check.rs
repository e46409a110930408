//! `planecut check`: is a mesh watertight, manifold and not self-crossing?

use planecut::check::{CheckOptions, CheckReport, TOLERANCE_F32, TOLERANCE_F64, check_mesh};
use planecut::import::mesh::{MeshFormat, Precision, read_mesh_or_empty};
use planecut::reading::FileKind;

use super::args::CheckArgs;
use super::error::CliError;
use super::input::Input;
use super::pool::on_threads;
use super::progress::Progress;
use super::terminal;

/// Runs the command: one line on standard output where the mesh is sound.
///
/// # Errors
/// [`CliError::NotSound`] where it is not, another [`CliError`] where it cannot be read.
pub(crate) fn run(args: &CheckArgs) -> Result<(), CliError> {
    let expected = "a mesh: `.obj`, `.stl`, `.ply`, `.glb` or `.gltf`";
    let mesh_format = |kind| match kind {
        FileKind::Mesh(format) => Some(format),
        FileKind::Model | FileKind::Map | FileKind::Scad => None,
    };
    let (input, format) = Input::resolve(&args.mesh, None, mesh_format, expected)?;
    let progress = Progress::start(args.common.quiet);
    let report = on_threads(args.common.threads, || check(&input, format, args.tolerance, &progress))?;
    drop(progress);
    match report.first_problem() {
        Some(problem) => Err(CliError::NotSound { path: input.path, problem }),
        None => terminal::print_text(&describe(&input, &report)),
    }
}

fn check(
    input: &Input,
    format: MeshFormat,
    tolerance: Option<f64>,
    progress: &Progress,
) -> Result<CheckReport, CliError> {
    progress.stage("reading");
    let mesh = read_mesh_or_empty(&input.read()?, format, &input.name())?;
    let tolerance = tolerance.unwrap_or(match mesh.precision {
        Precision::Single => TOLERANCE_F32,
        Precision::Double | Precision::Digits(_) | Precision::Places(_) => TOLERANCE_F64,
    });
    progress.stage("checking");
    let check = |crossings| check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions { tolerance, crossings });
    // Crossings are sought only where nothing worse is to be told: what is open, doubled or degenerate may have them by the million.
    let report = check(false);
    Ok(if report.is_sound() { check(true) } else { report })
}

fn describe(input: &Input, report: &CheckReport) -> String {
    let topology = &report.topology;
    format!(
        "{}: {report}; vertices {}, triangles {}, components {}, genus {}, volume {}\n",
        input.name(),
        topology.vertices,
        topology.triangles,
        topology.components,
        topology.genus.unwrap_or(0),
        topology.measures.volume,
    )
}
