//! What `build`, `edit` and `coarsen` make: all of it is there before the first file is written.

use std::time::{Duration, Instant};

use planecut::csg::Mesh;
use planecut::export::{ExportOptions, Part, PreviewOptions, encode_parts, render_preview};

use super::args::CommonArgs;
use super::error::CliError;
use super::input::Input;
use super::output::{MeshTarget, Target};
use super::pool::on_threads;
use super::progress::Progress;
use super::report::milliseconds;
use super::solve::Solved;
use super::terminal;

/// An output that is complete in memory.
pub(crate) type Encoded = (Target, Vec<u8>);

/// What is there before the first file is written.
pub(crate) struct Product {
    pub(crate) solved: Solved,
    pub(crate) outputs: Vec<Encoded>,
    /// How long the meshes took to encode.
    pub(crate) encoding: Duration,
}

impl Product {
    /// Prints the warnings about an input and writes all outputs, the report last; `begin` is when the work began.
    ///
    /// # Errors
    /// [`CliError::Write`] or [`CliError::Stdout`] where the system refuses.
    fn write(mut self, input: &str, is_quiet: bool, report: Option<&Target>, begin: Instant) -> Result<(), CliError> {
        if !is_quiet {
            terminal::print_warnings(input, &self.solved.warnings);
        }
        let writing = Instant::now();
        for (target, bytes) in &self.outputs {
            target.write(bytes)?;
        }
        if let Some(target) = report {
            let report = &mut self.solved.report;
            report.time_ms.export = milliseconds(self.encoding + writing.elapsed());
            report.time_ms.total = milliseconds(begin.elapsed());
            // Last, so that a report is a sign that all else is there.
            target.write(report.to_json().as_bytes())?;
        }
        Ok(())
    }
}

/// Makes a product on as many threads as asked for, with a spinner, and writes it.
///
/// # Errors
/// What `work` gives, [`CliError::Threads`], and those of writing.
pub(crate) fn produce(
    common: &CommonArgs,
    input: &Input,
    report: Option<&Target>,
    begin: Instant,
    work: impl FnOnce(&Progress) -> Result<Product, CliError> + Send,
) -> Result<(), CliError> {
    let progress = Progress::start(common.quiet);
    let product = on_threads(common.threads, || work(&progress))?;
    drop(progress);
    product.write(&input.name(), common.quiet, report, begin)
}

/// Draws a mesh for a place.
///
/// # Errors
/// [`CliError::Encode`].
pub(crate) fn draw(mesh: &Mesh, target: &Target, options: &PreviewOptions) -> Result<Encoded, CliError> {
    match render_preview(mesh, options) {
        Ok(picture) => Ok((target.clone(), picture)),
        Err(source) => Err(CliError::Encode { output: target.to_string(), source }),
    }
}

/// Encodes parts for each of some places.
///
/// # Errors
/// [`CliError::Encode`].
pub(crate) fn encode(
    parts: &[Part<'_>],
    meshes: &[MeshTarget],
    options: &ExportOptions,
) -> Result<Vec<Encoded>, CliError> {
    let encode_one = |MeshTarget { target, format }: &MeshTarget| match encode_parts(parts, *format, options) {
        Ok(bytes) => Ok((target.clone(), bytes)),
        Err(source) => Err(CliError::Encode { output: target.to_string(), source }),
    };
    meshes.iter().map(encode_one).collect()
}
