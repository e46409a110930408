//! What `build`, `edit` and `coarsen` make: all of it is complete before the first file gets its name.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use planecut::csg::{Brush, Material, Model};
use planecut::export::{ExportOptions, Part, Written, write_brushes, write_model, write_mtl, write_parts, written};
use planecut::import::Warning;
use planecut::picture::{PictureError, PreviewOptions, Subject, render};

use super::args::CommonArgs;
use super::error::CliError;
use super::input::Input;
use super::output::{MeshTarget, Output, OutputFormat, Target};
use super::pool::on_threads;
use super::progress::Progress;
use super::report::{Report, milliseconds};
use super::terminal;

/// What is there before the first file gets its name.
pub(crate) struct Product {
    pub(crate) warnings: Vec<Warning>,
    /// Without the times of writing; nothing where it is not asked for.
    pub(crate) report: Option<Report>,
    pub(crate) outputs: Vec<Output>,
    /// How long the meshes took to encode.
    pub(crate) encoding: Duration,
}

impl Product {
    /// Prints the warnings about an input and commits all outputs, the report last; `begin` is when the work began. Gives the
    /// warnings.
    ///
    /// # Errors
    /// [`CliError::Write`] or [`CliError::Stdout`] where the system refuses.
    fn commit(
        self,
        input: &str,
        is_quiet: bool,
        target: Option<&Target>,
        begin: Instant,
    ) -> Result<Vec<Warning>, CliError> {
        if !is_quiet {
            terminal::print_warnings(input, &self.warnings);
        }
        let writing = Instant::now();
        Output::commit_all(self.outputs)?;
        if let (Some(target), Some(mut report)) = (target, self.report) {
            report.time_ms.export = milliseconds(self.encoding + writing.elapsed());
            report.time_ms.total = milliseconds(begin.elapsed());
            // Last, so that a report is a sign that all else is there.
            target.write(report.to_json().as_bytes())?;
        }
        Ok(self.warnings)
    }
}

/// Makes a product on as many threads as asked for, with a spinner, and writes it; gives what there is to warn of.
///
/// # Errors
/// What `work` gives, [`CliError::Threads`], and those of writing.
pub(crate) fn produce(
    common: &CommonArgs,
    input: &Input,
    report: Option<&Target>,
    begin: Instant,
    work: impl FnOnce(&Progress) -> Result<Product, CliError> + Send,
) -> Result<Vec<Warning>, CliError> {
    let progress = Progress::start(common.quiet);
    let product = on_threads(common.threads, || work(&progress))?;
    drop(progress);
    product.commit(&input.name(), common.quiet, report, begin)
}

/// Draws a subject for a place.
///
/// # Errors
/// [`CliError::Draw`], [`CliError::Write`].
pub(crate) fn draw(subject: &Subject<'_>, target: &Target, options: &PreviewOptions) -> Result<Output, CliError> {
    target.begin(|out| Ok::<_, PictureError>(out.write_all(&render(subject, options)?.to_png()?)?))
}

/// What may be written of a solid.
pub(crate) struct Contents<'a> {
    pub(crate) parts: &'a [Part<'a>],
    pub(crate) materials: &'a [Material],
    /// Convex bodies, where they are asked for.
    pub(crate) brushes: &'a dyn Fn() -> Result<Vec<Brush>, CliError>,
    /// The model with its tree, where that is asked for.
    pub(crate) model: &'a dyn Fn() -> Cow<'a, Model>,
}

/// Writes what there is to each of some places, and materials beside an OBJ file where that is asked for.
///
/// # Errors
/// [`CliError::Encode`], [`CliError::Write`], and those of making convex bodies.
pub(crate) fn encode(
    contents: &Contents<'_>,
    places: &[MeshTarget],
    options: &ExportOptions,
) -> Result<Vec<Output>, CliError> {
    let mut outputs = Vec::with_capacity(places.len());
    let has_brushes = places.iter().any(|place| matches!(place.format, OutputFormat::Brushes(_)));
    let brushes = if has_brushes { (contents.brushes)()? } else { Vec::new() };
    for place in places {
        let library = place.library();
        let material_library = library.as_ref().and_then(Target::file_name);
        let options = ExportOptions { material_library, ..options.clone() };
        outputs.push(place.target.begin(|out| match place.format {
            OutputFormat::Mesh(format) => write_parts(contents.parts, format, &options, out),
            OutputFormat::Brushes(format) => write_brushes(&brushes, contents.materials, format, options.scale, out),
            OutputFormat::Model => write_model(&(contents.model)(), options.scale, out),
            OutputFormat::Physics(_) => unreachable!("rigid bodies have files of their own: `rigid_body`"),
        })?);
        if let Some(library) = library {
            outputs.push(library.begin(|out| write_mtl(contents.parts, out))?);
        }
    }
    Ok(outputs)
}

/// What the first output holds of some parts, for the report; nothing where there is none, or it holds the meshes as they are.
///
/// # Errors
/// [`CliError::Encode`].
pub(crate) fn first_written(
    first: Option<&MeshTarget>,
    parts: &[Part<'_>],
    options: &ExportOptions,
) -> Result<Option<Written>, CliError> {
    let Some(MeshTarget { target, format: OutputFormat::Mesh(format), .. }) = first else { return Ok(None) };
    written(parts, *format, options).map_err(|source| CliError::Encode { output: target.to_string(), source })
}
