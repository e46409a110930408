//! `planecut render`: pictures of models: one, a turntable, or a contact sheet of several.

mod args;
mod subject;

pub(crate) use self::args::RenderArgs;
use self::args::IdKind;
use self::subject::{Drawn, subject};
use std::path::PathBuf;

use super::error::CliError;
use super::input::{Input, InputKind};
use super::output::{Output, Target, check_targets};
use super::pool::on_threads;
use super::product::draw;
use super::progress::Progress;
use super::terminal;
use planecut::export::{PreviewOptions, render_buffers};

/// What is to be drawn from what.
struct Plan<'a> {
    args: &'a RenderArgs,
    inputs: Vec<(Input, InputKind)>,
    picture: Target,
    depth: Option<Target>,
    ids: Option<Target>,
    options: PreviewOptions,
}

/// Runs the command.
///
/// # Errors
/// [`CliError`] where the arguments or the input are unusable, or the picture cannot be written.
pub(crate) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let plan = Plan::resolve(args)?;
    let progress = Progress::start(args.common.quiet);
    let (drawn, outputs) = on_threads(args.common.threads, || plan.carry_out(&progress))?;
    drop(progress);
    if !args.common.quiet {
        for ((input, _), drawn) in plan.inputs.iter().zip(&drawn) {
            terminal::print_warnings(&input.name(), &drawn.warnings);
        }
    }
    outputs.into_iter().try_for_each(Output::commit)
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a RenderArgs) -> Result<Self, CliError> {
        let resolve = |path: &PathBuf| {
            let (input, kind) = Input::resolve_any(path, args.reading.input_format)?;
            args.reading.check(kind)?;
            Ok((input, kind))
        };
        let plan = Self {
            args,
            inputs: args.inputs.iter().map(resolve).collect::<Result<_, CliError>>()?,
            picture: Target::picture(&args.output)?,
            depth: args.buffers.depth.as_deref().map(Target::picture).transpose()?,
            ids: args.buffers.ids.as_deref().map(Target::picture).transpose()?,
            options: args.options(false),
        };
        for (input, _) in &plan.inputs {
            check_targets(input.file(), [&plan.picture].into_iter().chain(&plan.depth).chain(&plan.ids))?;
        }
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<(Vec<Drawn>, Vec<Output>), CliError> {
        let (input, kind) = &self.inputs[0];
        let drawn = subject(input, *kind, self.args, &self.options, progress)?;
        progress.stage("drawing");
        let mut outputs = vec![draw(&drawn.subject, &self.picture, &self.options)?];
        outputs.extend(self.buffers(&drawn)?);
        Ok((vec![drawn], outputs))
    }

    /// Depth and ids, as far as they are asked for.
    fn buffers(&self, drawn: &Drawn) -> Result<Vec<Output>, CliError> {
        let Some(first) = self.depth.as_ref().or(self.ids.as_ref()) else { return Ok(Vec::new()) };
        let buffers = render_buffers(&drawn.subject, &self.options)
            .map_err(|source| CliError::Encode { output: first.to_string(), source })?;
        let mut outputs = Vec::new();
        if let Some(target) = &self.depth {
            outputs.push(target.begin(|out| Ok(out.write_all(&buffers.depth_png()?)?))?);
        }
        if let Some(target) = &self.ids {
            let mesh = drawn.subject.as_mesh();
            let material = |face: u32| mesh.faces[face as usize].material.0;
            let number = |face: u32| match self.args.buffers.id_of {
                IdKind::Face => face,
                IdKind::Material => material(face),
                IdKind::Brush => drawn.sources.get(material(face) as usize).map_or(0, |source| source.brush),
            };
            outputs.push(target.begin(|out| Ok(out.write_all(&buffers.id_png(number)?)?))?);
        }
        Ok(outputs)
    }
}
