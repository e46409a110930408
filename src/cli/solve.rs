//! From an input to its solid and the report on it: what `build`, `info` and `render` share.

use std::num::NonZeroU32;
use std::time::{Duration, Instant};

use planecut::check::check_topology;
use planecut::csg::{
    Evaluation, FaceSource, Mesh, Model, ModelSummary, TextureAxes, Tree, UnboundedBrushes, evaluate_with,
};
use planecut::import::Warning;
use planecut::import::map::{MapImport, read_map};
use planecut::import::mesh::read_solid;
use planecut::import::model::read_model;
use planecut::import::scad::read_scad;
use planecut::reading::FileKind;

use super::error::CliError;
use super::input::Input;
use super::progress::Progress;
use super::reading_args::ReadingArgs;
use super::report::{MeshLeaves, MeshPart, Report, milliseconds};

/// The solid of a model.
pub(crate) struct Solved {
    /// What was read, without brushes where nobody needs them; where sources are known, each face of a brush has a material of its source.
    pub(crate) model: Model,
    /// Where the faces of each material come from, where that was asked for.
    pub(crate) sources: Vec<FaceSource>,
    /// The boundary of its solid.
    pub(crate) mesh: Mesh,
    /// Numbers of the brushes that are not bounded.
    pub(crate) unbounded: Vec<usize>,
    /// The report, without the times of what comes after.
    pub(crate) report: Report,
    /// What was left out or is doubtful; the report tells the same.
    pub(crate) warnings: Vec<Warning>,
}

/// Reads an input and evaluates its tree on the current thread pool. Faces of different sources stay apart where that is asked for: those of each face
/// of a brush, or those whose textures lie differently. Where nobody `needs_brushes`, the model that comes back has none: a million of them
/// take as much memory as their mesh.
///
/// # Errors
/// [`CliError`] for unusable input, [`CliError::Evaluate`] for a solid without a mesh, [`CliError::Bug`] for a bug.
pub(crate) fn solve(
    input: &Input,
    kind: FileKind,
    reading: &ReadingArgs,
    splits_by_face: Option<bool>,
    needs_brushes: bool,
    progress: &Progress,
) -> Result<Solved, CliError> {
    let begin = Instant::now();
    progress.stage("reading");
    let read = read(input, kind, reading)?;
    solve_split(input, kind, read, begin, splits_by_face, needs_brushes, progress)
}

/// The same for what was read of an input since `begin`.
///
/// # Errors
/// As [`solve_read`].
pub(crate) fn solve_split(
    input: &Input,
    kind: FileKind,
    mut read: Read,
    begin: Instant,
    splits_by_face: Option<bool>,
    needs_brushes: bool,
    progress: &Progress,
) -> Result<Solved, CliError> {
    read.drops_brushes = !needs_brushes;
    let materials = read.model.materials.len();
    let mut sources = Vec::new();
    if let Some(by_face) = splits_by_face {
        (read.model, sources) = read.model.split_by_source(&read.textures, by_face);
    }
    let mut solved = solve_read(input, kind, read, begin.elapsed(), progress)?;
    solved.report.set_materials(materials);
    Ok(Solved { sources, ..solved })
}

/// The same for what was read of an input, and how long that took.
///
/// # Errors
/// [`CliError::Evaluate`] for a solid without a mesh, [`CliError::Bug`] for a bug.
pub(crate) fn solve_read(
    input: &Input,
    kind: FileKind,
    read: Read,
    import_time: Duration,
    progress: &Progress,
) -> Result<Solved, CliError> {
    progress.stage("evaluating");
    let evaluation = evaluate_model(input, kind, &read.model)?;
    Ok(solved(input, kind, read, evaluation, import_time, progress))
}

/// The solid of a model that was evaluated, with the report on it.
pub(crate) fn solved(
    input: &Input,
    kind: FileKind,
    Read { mut model, mut warnings, drops_brushes, .. }: Read,
    evaluation: Evaluation,
    import_time: Duration,
    progress: &Progress,
) -> Solved {
    warnings.extend(solid_warnings(kind, &model, &evaluation.model, &evaluation.mesh));
    let meshes = MeshLeaves::of(&model.tree);
    if drops_brushes {
        model.tree = Tree::default();
    }
    progress.stage("checking");
    let topology = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
    let mesh = MeshPart::of_solid(&topology, evaluation.mesh.faces.len());
    let mut report = Report::of_model(input.given(), kind.name(), model.materials.len(), &evaluation, mesh);
    report.set_meshes(meshes);
    report.time_ms.import = milliseconds(import_time);
    report.warn(&warnings);
    Solved {
        model,
        sources: Vec::new(),
        mesh: evaluation.mesh,
        unbounded: evaluation.model.unbounded,
        report,
        warnings,
    }
}

/// What was read of an input.
#[derive(Default)]
pub(crate) struct Read {
    pub(crate) model: Model,
    pub(crate) warnings: Vec<Warning>,
    /// For each brush how the textures of its faces lie, where the input says it.
    pub(crate) textures: Vec<Vec<Option<TextureAxes>>>,
    /// Whether brushes are dropped once they are evaluated.
    pub(crate) drops_brushes: bool,
}

/// Reads an input.
///
/// # Errors
/// [`CliError`] for unusable input.
pub(crate) fn read(input: &Input, kind: FileKind, reading: &ReadingArgs) -> Result<Read, CliError> {
    let bytes = input.read()?;
    let (model, warnings) = match kind {
        FileKind::Model => {
            let import = read_model(&bytes, &input.name(), &reading.model_options(input))?;
            (import.model, import.warnings)
        }
        FileKind::Map => {
            let MapImport { model, warnings, textures, .. } = read_map(&bytes, &input.name(), &reading.map_options())?;
            return Ok(Read { model, warnings, textures, ..Read::default() });
        }
        FileKind::Scad => {
            let import = read_scad(&bytes, &input.name(), &reading.scad_options(input))?;
            (import.model, import.warnings)
        }
        FileKind::Mesh(format) => {
            let import = read_solid(&bytes, format, &input.name(), &reading.solid_options())?;
            (import.model, import.warnings)
        }
    };
    Ok(Read { model, warnings, ..Read::default() })
}

/// Evaluates the tree of a model on the current thread pool.
///
/// # Errors
/// [`CliError::Evaluate`] for a solid without a mesh, [`CliError::Bug`] for a bug.
pub(crate) fn evaluate_model(input: &Input, kind: FileKind, model: &Model) -> Result<Evaluation, CliError> {
    evaluate_with(model, unbounded_of(kind)).map_err(|source| CliError::of_evaluation(&input.path, source))
}

/// What becomes of unbounded brushes of an input.
pub(crate) fn unbounded_of(kind: FileKind) -> UnboundedBrushes {
    match kind {
        FileKind::Model | FileKind::Scad | FileKind::Mesh(_) => UnboundedBrushes::Keep,
        // Nobody means half of space in a map: the brush lacks a face.
        FileKind::Map => UnboundedBrushes::LeaveOut,
    }
}

/// What is doubtful about a solid: brushes that add nothing to it, and an empty result.
pub(crate) fn solid_warnings(kind: FileKind, model: &Model, summary: &ModelSummary, mesh: &Mesh) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = brush_warnings(kind, model, summary).collect();
    if mesh.triangles.is_empty() {
        warnings.push(Warning::note(0, "the result is empty"));
    }
    warnings
}

/// One warning for each kind of brush that adds nothing to the solid, on the line of the first of them.
pub(crate) fn brush_warnings(kind: FileKind, model: &Model, summary: &ModelSummary) -> impl Iterator<Item = Warning> {
    let unbounded: &[usize] = if kind == FileKind::Map { &summary.unbounded } else { &[] };
    // without interior there is nothing to leave out
    let kinds = [(&summary.empty[..], "without interior", false), (unbounded, "that is not bounded", true)];
    kinds.into_iter().filter_map(|(numbers, kind, is_loss)| {
        let line_of = |number: &usize| model.tree.source_line(*number).map_or(0, NonZeroU32::get);
        let line = line_of(numbers.first()?);
        let message = match numbers.len() {
            1 => format!("left out a brush {kind}"),
            count => {
                let kind = kind.replace("that is", "that are");
                let lines = numbers.iter().map(|number| line_of(number).to_string()).collect::<Vec<_>>().join(", ");
                format!("left out {count} brushes {kind}, the first of them here (lines {lines})")
            }
        };
        Some(Warning::loss(line, message, if is_loss { numbers.len() } else { 0 }))
    })
}
