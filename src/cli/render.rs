//! `planecut render`: the solid of a model or a map as a picture.

use super::args::RenderArgs;
use super::error::CliError;
use super::input::Input;
use super::output::{Target, check_targets};
use super::pool::on_threads;
use super::product::draw;
use super::progress::Progress;
use super::solve::solve;
use super::terminal;

/// Runs the command.
///
/// # Errors
/// [`CliError`] where the arguments or the input are unusable, or the picture cannot be written.
pub(crate) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
    args.reading.check(kind)?;
    let target = Target::picture(&args.output)?;
    check_targets(input.file(), [&target].into_iter())?;
    let progress = Progress::start(args.common.quiet);
    let (solved, picture) = on_threads(args.common.threads, || {
        let solved = solve(&input, kind, &args.reading, None, &progress)?;
        progress.stage("drawing");
        let picture = draw(&solved.mesh, &target, &args.size.preview(args.style))?;
        Ok((solved, picture))
    })?;
    drop(progress);
    if !args.common.quiet {
        terminal::print_warnings(&input.name(), &solved.warnings);
    }
    picture.commit()
}
