//! `planecut man`: manual pages, one of the program and one of each command.

use clap::Command;
use clap_mangen::Man;
use planecut::export::ExportError;

use super::args::{self, ManArgs};
use super::error::CliError;
use super::output::{Output, Target};
use super::terminal;

/// Runs the command: one page on standard output, or all of them into a folder.
///
/// # Errors
/// [`CliError::Usage`] for a command that does not exist, [`CliError::Write`] or [`CliError::Stdout`] where the system refuses.
pub(crate) fn run(args: &ManArgs) -> Result<(), CliError> {
    let mut program = args::command().disable_help_subcommand(true);
    // names of commands get that of the program in front: planecut-build
    program.build();
    if let Some(folder) = &args.dir {
        let commands = program.get_subcommands().chain([&program]);
        let outputs: Vec<Output> = commands
            .map(|command| {
                let page = page(command);
                Target::File(folder.join(page.get_filename())).begin(|out| Ok::<_, ExportError>(page.render(out)?))
            })
            .collect::<Result<_, _>>()?;
        return Output::commit_all(outputs);
    }
    let command = args.command.as_deref().map_or(Ok(&program), |name| find(&program, name))?;
    let mut text = Vec::new();
    page(command).render(&mut text).map_err(CliError::Stdout)?;
    terminal::print_text(&String::from_utf8_lossy(&text))
}

fn find<'a>(program: &'a Command, name: &str) -> Result<&'a Command, CliError> {
    program.find_subcommand(name).ok_or_else(|| {
        let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        CliError::Usage(format!("found command {name}, expected one of {}", names.join(", ")))
    })
}

fn page(command: &Command) -> Man {
    Man::new(command.clone()).source(concat!("planecut ", env!("CARGO_PKG_VERSION")))
}
