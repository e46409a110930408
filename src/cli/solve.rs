//! From a map to its solid and the report on it: what `build`, `info` and `render` share.

use std::time::Instant;

use planecut::csg::check::check_topology;
use planecut::csg::{Mesh, Model, ModelSummary, evaluate};
use planecut::import::Warning;
use planecut::import::map::{MapOptions, read_map};

use super::error::CliError;
use super::input::Input;
use super::progress::Progress;
use super::report::{MeshPart, Report, milliseconds};

/// The solid of a map.
pub(crate) struct Solved {
    /// Its boundary.
    pub(crate) mesh: Mesh,
    /// The report, without the times of what comes after.
    pub(crate) report: Report,
    /// What was left out or is doubtful; the report tells the same.
    pub(crate) warnings: Vec<Warning>,
}

/// Reads a map and evaluates the union of its brushes on the current thread pool.
///
/// # Errors
/// [`CliError::Read`] or [`CliError::Map`] for unusable input, [`CliError::Weld`] for a bug.
pub(crate) fn solve(input: &Input, options: &MapOptions, progress: &Progress) -> Result<Solved, CliError> {
    let begin = Instant::now();
    progress.stage("reading");
    let mut import = read_map(&input.read()?, &input.name(), options)?;
    let import_time = begin.elapsed();
    progress.stage("evaluating");
    let weld_error = |source| CliError::Weld { path: input.path.clone(), source };
    let evaluation = evaluate(&import.model).map_err(weld_error)?;
    progress.stage("checking");
    let topology = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);

    let mut warnings = std::mem::take(&mut import.warnings);
    warnings.extend(brush_warnings(&import.model, &evaluation.model));
    if evaluation.mesh.triangles.is_empty() {
        warnings.push(Warning { line: 0, message: "the result is empty".to_owned() });
    }
    let mesh = MeshPart::of_solid(&topology, &evaluation.mesh);
    let mut report = Report::of_model(input.name(), import.model.materials.len(), &evaluation, mesh);
    report.time_ms.import = milliseconds(import_time);
    report.warnings = warnings.iter().map(ToString::to_string).collect();
    Ok(Solved { mesh: evaluation.mesh, report, warnings })
}

/// One warning for each kind of brush that adds nothing to the solid, on the line of the first of them.
fn brush_warnings(model: &Model, summary: &ModelSummary) -> impl Iterator<Item = Warning> {
    let kinds = [(&summary.empty, "without interior"), (&summary.unbounded, "that is not bounded")];
    kinds.into_iter().filter_map(|(numbers, kind)| {
        let line = model.tree.brushes()[*numbers.first()?].line;
        let message = match numbers.len() {
            1 => format!("left out a brush {kind}"),
            count => {
                let kind = kind.replace("that is", "that are");
                format!("left out {count} brushes {kind}, the first of them here")
            }
        };
        Some(Warning { line, message })
    })
}
