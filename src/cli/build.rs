//! `planecut build`: a model or a map into meshes, a picture and a report.

use std::time::Instant;

use planecut::export::{ExportOptions, Part, render_preview};

use super::args::{BuildArgs, Style};
use super::cells::Cells;
use super::error::CliError;
use super::input::{Input, InputKind};
use super::output::{MeshTarget, Target, check_targets};
use super::pool::on_threads;
use super::product::{Product, encode};
use super::progress::Progress;
use super::report::milliseconds;
use super::solve::solve;

/// What is to be written where.
struct Plan<'a> {
    args: &'a BuildArgs,
    input: Input,
    kind: InputKind,
    meshes: Vec<MeshTarget>,
    preview: Option<Target>,
    report: Option<Target>,
}

/// Runs the command: everything is encoded in memory before the first file is written.
///
/// # Errors
/// Any [`CliError`] but those of `check`.
pub(crate) fn run(args: &BuildArgs) -> Result<(), CliError> {
    let begin = Instant::now();
    let plan = Plan::resolve(args)?;
    let progress = Progress::start(args.common.quiet);
    let product = on_threads(args.common.threads, || plan.carry_out(&progress))?;
    drop(progress);
    product.write(&plan.input.name(), args.common.quiet, plan.report.as_ref(), begin)
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a BuildArgs) -> Result<Self, CliError> {
        let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
        args.reading.check(kind)?;
        let plan = Self {
            args,
            input,
            kind,
            meshes: MeshTarget::resolve_all(&args.outputs, args.format)?,
            preview: args.preview.as_deref().map(Target::picture).transpose()?,
            report: args.report.as_deref().map(Target::new),
        };
        let meshes = plan.meshes.iter().map(|mesh| &mesh.target);
        check_targets(plan.input.file(), meshes.chain(&plan.preview).chain(&plan.report))?;
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let mut solved = solve(&self.input, self.kind, &self.args.reading, progress)?;
        let cells = if self.args.cells {
            progress.stage("cutting cells");
            Some(Cells::new(&self.input, self.kind, &mut solved)?)
        } else {
            None
        };
        let begin = Instant::now();
        progress.stage("encoding");
        let options = ExportOptions { scale: self.args.scale, ..ExportOptions::default() };
        let mut outputs = match cells {
            Some(cells) => encode(&cells.parts(), &self.meshes, &options)?,
            None => encode(&[Part { name: "solid", mesh: &solved.mesh }], &self.meshes, &options)?,
        };
        let encoding = begin.elapsed();
        if let Some(target) = &self.preview {
            let drawing = Instant::now();
            progress.stage("drawing");
            let options = self.args.preview_size.preview(Style::Shaded);
            let picture = render_preview(&solved.mesh, &options)
                .map_err(|source| CliError::Encode { output: target.to_string(), source })?;
            outputs.push((target.clone(), picture));
            solved.report.time_ms.preview = milliseconds(drawing.elapsed());
        }
        Ok(Product { solved, outputs, encoding })
    }
}
