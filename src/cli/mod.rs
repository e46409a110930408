//! The command line: parse (`args`), resolve (`input`, `output`), run (one file for each command).
//!
//! Exit statuses are decided in `error` and nowhere else. Every error is one line on standard error.

mod args;
mod asset_args;
mod batch;
mod build;
mod check;
mod coarsen;
mod combine;
mod completions;
mod edit;
mod engine_args;
mod error;
mod in_blocks;
mod info;
mod input;
mod man;
mod output;
mod pieces;
mod pool;
mod product;
mod progress;
mod reading_args;
mod render;
mod report;
mod rigid_body;
mod schema;
mod serve;
mod solve;
mod surface;
mod terminal;
mod view;
mod written_cells;

use std::ffi::OsString;
use std::panic;
use std::sync::atomic::{AtomicBool, Ordering};

use args::Command;
use error::{CliError, Done, FAILED};

/// Runs the program on arguments, the first of which is its own name, and gives its exit status. It speaks on standard output and standard error, and
/// says there what panics: it is for a process that does nothing else.
#[must_use]
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    report_panics_in_one_line();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    match panic::catch_unwind(|| parse_and_run(&arguments)) {
        Ok(Ok(done)) => done.exit_status(),
        Ok(Err(error)) => {
            terminal::print_error(&error.to_string());
            error.exit_status()
        }
        Err(_) => FAILED,
    }
}

fn parse_and_run(arguments: &[OsString]) -> Result<Done, CliError> {
    let Some(command) = args::parse(arguments)? else { return Ok(Done::Complete) };
    match command {
        Command::Build(args) => return build::run(&args),
        Command::Info(args) => return info::run(&args),
        Command::Render(args) => return render::run(&args),
        Command::Edit(args) => return edit::run(&args),
        Command::Coarsen(args) => return coarsen::run(&args),
        Command::View(args) => return view::run(&args),
        Command::Batch(args) => return batch::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Schema => schema::run(),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }?;
    Ok(Done::Complete)
}

/// A panic is a bug of ours, and callers still get the one line and the status they expect of a job that failed.
fn report_panics_in_one_line() {
    static REPORTED: AtomicBool = AtomicBool::new(false);
    panic::set_hook(Box::new(|fault| {
        if !REPORTED.swap(true, Ordering::Relaxed) {
            terminal::print_error(&format!("found a bug in planecut, expected none: {fault}"));
        }
    }));
}
