//! `planecut schema`: the JSON Schema of the model file.

use super::error::CliError;
use super::terminal;

/// The schema as it is published with the documentation; part of the program, so that it is there wherever the program is.
const SCHEMA: &str = include_str!("../../docs/model.schema.json");

/// Runs the command.
///
/// # Errors
/// [`CliError::Stdout`] where standard output cannot be written.
pub(crate) fn run() -> Result<(), CliError> {
    terminal::print_text(SCHEMA)
}
