//! `planecut render`: pictures of models: one, a turntable, or a contact sheet of several.

mod args;
mod subject;

use std::collections::BTreeMap;
use std::path::PathBuf;

use planecut::import::Warning;
use planecut::picture::{
    AnimationFormat, AnimationWriter, Background, Picture, PictureError, PreviewOptions, SheetColors, Tile, Turntable,
    contact_sheet, render, render_buffers, sheet_layout,
};
use planecut::reading::FileKind;

use self::args::IdKind;
pub(crate) use self::args::RenderArgs;
use self::subject::{Drawn, subject};
use super::error::{CliError, Done};
use super::input::Input;
use super::output::{Output, PictureFormat, Target, check_targets};
use super::pool::on_threads;
use super::product::draw;
use super::progress::Progress;
use super::terminal;

/// What is to be drawn from what.
struct Plan<'a> {
    args: &'a RenderArgs,
    inputs: Vec<(Input, FileKind)>,
    picture: Target,
    /// `None` for a single picture.
    animation: Option<AnimationFormat>,
    depth: Option<Target>,
    ids: Option<Target>,
    options: PreviewOptions,
}

/// What was drawn: the pictures, and for each input what was left out.
type Made = (Vec<Output>, Vec<Vec<Warning>>);

/// Runs the command.
///
/// # Errors
/// [`CliError`] where the arguments or the input are unusable, or the picture cannot be written.
pub(crate) fn run(args: &RenderArgs) -> Result<Done, CliError> {
    let plan = Plan::resolve(args)?;
    let progress = Progress::start(args.common.quiet);
    let (outputs, warnings) = on_threads(args.common.threads, || plan.carry_out(&progress))?;
    drop(progress);
    if !args.common.quiet {
        for ((input, _), warnings) in plan.inputs.iter().zip(&warnings) {
            terminal::print_warnings(&input.name(), warnings);
        }
    }
    Output::commit_all(outputs)?;
    Ok(Done::with(warnings.iter().flatten(), args.reading.allow_loss))
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a RenderArgs) -> Result<Self, CliError> {
        let resolve = |path: &PathBuf| {
            let (input, kind) = Input::resolve_any(path, args.reading.input_format)?;
            args.reading.check(kind)?;
            Ok((input, kind))
        };
        let (picture, format) = PictureFormat::resolve(&args.output)?;
        let animation = match format {
            PictureFormat::Png => None,
            PictureFormat::Animation(format) => Some(format),
        };
        let plan = Self {
            args,
            inputs: args.inputs.iter().map(resolve).collect::<Result<_, CliError>>()?,
            picture,
            animation,
            depth: args.buffers.depth.as_deref().map(Target::picture).transpose()?,
            ids: args.buffers.ids.as_deref().map(Target::picture).transpose()?,
            options: args.options(animation.is_some()),
        };
        plan.check()?;
        Ok(plan)
    }

    /// Sees that what is asked for fits together, and that no output replaces an input.
    fn check(&self) -> Result<(), CliError> {
        let is_one = self.inputs.len() == 1;
        let refuse = |found: &str, expected: &str| Err(CliError::Usage(format!("found {found}, expected {expected}")));
        if !is_one && self.animation.is_some() {
            return refuse("a turntable of several inputs", "one input, or a picture (.png)");
        }
        if self.depth.is_some() || self.ids.is_some() {
            if !is_one || self.animation.is_some() {
                return refuse("--depth or --ids beside several pictures", "one input and one picture (.png)");
            }
            let is_whole = self.args.section().is_none() && self.args.spread().is_none();
            if self.args.buffers.id_of == IdKind::Brush && !is_whole {
                return refuse("--id-of brush with cells or a section", "it with the whole model");
            }
        }
        if self.args.sequence.columns.is_some() && is_one {
            return refuse("--columns with one input", "it with several");
        }
        for (input, _) in &self.inputs {
            check_targets(input.file(), [&self.picture].into_iter().chain(&self.depth).chain(&self.ids))?;
        }
        Ok(())
    }

    fn carry_out(&self, progress: &Progress) -> Result<Made, CliError> {
        let [(input, kind)] = &self.inputs[..] else { return self.contact_sheet(progress) };
        let drawn = subject(input, *kind, self.args, &self.options, progress)?;
        progress.stage("drawing");
        let mut outputs = vec![match self.animation {
            None => draw(&drawn.subject, &self.picture, &self.options)?,
            Some(format) => self.turntable(&drawn, format)?,
        }];
        outputs.extend(self.buffers(&drawn)?);
        Ok((outputs, vec![drawn.warnings]))
    }

    fn turntable(&self, drawn: &Drawn, format: AnimationFormat) -> Result<Output, CliError> {
        let PreviewOptions { width, height, .. } = self.options;
        let sequence = &self.args.sequence;
        self.picture.begin(|out| {
            let turntable = Turntable::new(&drawn.subject, &self.options, sequence.frames)?;
            let mut animation = AnimationWriter::new(format, width, height, sequence.frames, sequence.frame_time, out)?;
            // Colours are chosen for all sides of the model.
            let sides = sequence.frames.min(4);
            let samples = (0..sides).map(|side| side * sequence.frames / sides);
            let drawn = samples.map(|number| Ok((number, turntable.frame(number)?)));
            let mut drawn = drawn.collect::<Result<BTreeMap<u32, Picture>, PictureError>>()?;
            drawn.values().for_each(|sample| animation.learn(sample));
            for number in 0..turntable.frames() {
                let frame = match drawn.remove(&number) {
                    Some(frame) => frame,
                    None => turntable.frame(number)?,
                };
                animation.frame(&frame)?;
            }
            animation.finish()
        })
    }

    fn contact_sheet(&self, progress: &Progress) -> Result<Made, CliError> {
        let PreviewOptions { width, height, .. } = self.options;
        let failed = |source| CliError::Draw { output: self.picture.to_string(), source };
        let layout = sheet_layout(self.inputs.len(), [width, height], self.args.sequence.columns).map_err(failed)?;
        let [width, height] = layout.tile;
        let options = PreviewOptions { width, height, ..self.options };
        let (mut tiles, mut warnings) = (Vec::new(), Vec::new());
        for (input, kind) in &self.inputs {
            let drawn = subject(input, *kind, self.args, &options, progress)?;
            progress.stage("drawing");
            tiles.push(Tile { title: title_of(input), picture: render(&drawn.subject, &options).map_err(failed)? });
            warnings.push(drawn.warnings);
        }
        let colors = match self.options.background {
            Background::Light => SheetColors::LIGHT,
            Background::Dark => SheetColors::DARK,
            Background::Transparent => SheetColors::TRANSPARENT,
        };
        let sheet = contact_sheet(&tiles, &layout, &colors).map_err(failed)?;
        Ok((vec![self.picture.begin(|out| Ok::<_, PictureError>(out.write_all(&sheet.to_png()?)?))?], warnings))
    }

    /// Depth and ids, as far as they are asked for.
    fn buffers(&self, drawn: &Drawn) -> Result<Vec<Output>, CliError> {
        let Some(first) = self.depth.as_ref().or(self.ids.as_ref()) else { return Ok(Vec::new()) };
        let buffers = render_buffers(&drawn.subject, &self.options)
            .map_err(|source| CliError::Draw { output: first.to_string(), source })?;
        let mut outputs = Vec::new();
        if let Some(target) = &self.depth {
            outputs.push(target.begin(|out| Ok::<_, PictureError>(out.write_all(&buffers.depth_png()?)?))?);
        }
        if let Some(target) = &self.ids {
            let material = |face: u32| drawn.subject.faces()[face as usize].paint;
            let number = |face: u32| match self.args.buffers.id_of {
                IdKind::Face => face,
                IdKind::Material => material(face),
                IdKind::Brush => drawn.sources.get(material(face) as usize).map_or(0, |source| source.brush),
            };
            outputs.push(target.begin(|out| Ok::<_, PictureError>(out.write_all(&buffers.id_png(number)?)?))?);
        }
        Ok(outputs)
    }
}

/// What an input is called on a sheet: its file's name.
fn title_of(input: &Input) -> String {
    let name = input.path.file_name().unwrap_or(input.path.as_os_str());
    name.to_string_lossy().into_owned()
}
