//! `planecut completions`: a script that lets a shell complete the program's arguments.

use super::args::{self, CompletionsArgs};
use super::error::CliError;
use super::terminal;

/// Runs the command.
///
/// # Errors
/// [`CliError::Stdout`] where standard output cannot be written.
pub(crate) fn run(args: &CompletionsArgs) -> Result<(), CliError> {
    let mut command = args::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    terminal::print_text(&String::from_utf8_lossy(&script))
}
