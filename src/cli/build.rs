//! `planecut build`: a model or a map into meshes, a picture and a report.

use std::time::Instant;

use planecut::export::Part;
use planecut::picture::Subject;
use planecut::reading::FileKind;

use super::args::BuildArgs;
use super::combine::Inputs;
use super::error::{CliError, Done};
use super::in_blocks;
use super::output::{MeshTarget, OutputFormat, Target, check_targets};
use super::pieces::{Pieces, bounded_model, bounded_tree, brushes};
use super::product::{Contents, Product, draw, encode, first_written, produce};
use super::progress::Progress;
use super::report::milliseconds;
use super::solve::solve_split;

/// What is to be written where.
struct Plan<'a> {
    args: &'a BuildArgs,
    inputs: Inputs,
    kind: FileKind,
    meshes: Vec<MeshTarget>,
    preview: Option<Target>,
    report: Option<Target>,
}

/// Runs the command: everything is complete before the first file gets its name.
///
/// # Errors
/// Any [`CliError`] but those of `check`.
pub(crate) fn run(args: &BuildArgs) -> Result<Done, CliError> {
    if args.blocks.are_asked_for() {
        return in_blocks::run(args);
    }
    if args.blocks.work_dir.is_some() {
        return Err(CliError::Usage("found --work-dir alone, expected it with --blocks or --tiles".to_owned()));
    }
    let begin = Instant::now();
    let plan = Plan::resolve(args)?;
    let product =
        produce(&args.common, plan.inputs.first(), plan.report.as_ref(), begin, |progress| plan.carry_out(progress));
    product.map(|warnings| Done::with(&warnings, args.reading.allow_loss))
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a BuildArgs) -> Result<Self, CliError> {
        let inputs = Inputs::resolve(&args.inputs, args.combine, &args.reading)?;
        let plan = Self {
            args,
            kind: inputs.kind(),
            inputs,
            meshes: args.output.targets()?,
            preview: args.picture.preview.as_deref().map(Target::picture).transpose()?,
            report: args.output.report.as_deref().map(Target::new),
        };
        let meshes: Vec<Target> = plan.meshes.iter().flat_map(MeshTarget::targets).collect();
        for (input, _) in plan.inputs.all() {
            check_targets(input.file(), meshes.iter().chain(&plan.preview).chain(&plan.report))?;
        }
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let assets = &self.args.output.assets;
        let splits_by_face = assets.splits_by_face();
        let has_brushes = |place: &MeshTarget| matches!(place.format, OutputFormat::Brushes(_) | OutputFormat::Model);
        let needs_brushes = self.meshes.iter().any(has_brushes) || self.args.cells || self.args.parts;
        let (input, begin) = (self.inputs.first(), Instant::now());
        progress.stage("reading");
        let read = self.inputs.read(&self.args.reading.with_textures(assets.keeps_textures()))?;
        let mut solved = solve_split(input, self.kind, read, begin, splits_by_face, needs_brushes, progress)?;
        solved.report.set_inputs(self.inputs.told());
        let pieces = if self.args.cells {
            progress.stage("cutting cells");
            Some(Pieces::cells(input, self.kind, &mut solved)?)
        } else if self.args.parts {
            Some(Pieces::parts(input, self.kind, &mut solved)?)
        } else {
            None
        };
        let begin = Instant::now();
        progress.stage("encoding");
        let options = assets.options(self.args.output.scale);
        let solid = Part { name: "solid", mesh: &solved.mesh, sources: &solved.sources };
        let parts = pieces.as_ref().map_or_else(|| vec![solid], |pieces| pieces.as_parts(&solved.sources));
        let brushes = || brushes(&input.path, &bounded_tree(self.kind, &solved));
        let model = || bounded_model(self.kind, &solved.model, &solved.unbounded);
        let contents = Contents { parts: &parts, materials: &solved.model.materials, brushes: &brushes, model: &model };
        let mut outputs = encode(&contents, &self.meshes, &options)?;
        let encoding = begin.elapsed();
        let first = self.meshes.first().filter(|_| self.report.is_some());
        if let Some(written) = first_written(first, &parts, &options)? {
            solved.report.set_written(&written);
        }
        if let Some(target) = &self.preview {
            let drawing = Instant::now();
            progress.stage("drawing");
            outputs.push(draw(&Subject::of_mesh(&solved.mesh), target, &self.args.picture.options())?);
            solved.report.time_ms.preview = milliseconds(drawing.elapsed());
        }
        Ok(Product { warnings: solved.warnings, report: Some(solved.report), outputs, encoding })
    }
}
