//! `planecut edit INPUT --serve`: a live model that an editor drives, edits and queries as JSON objects on standard input, a line each, each answered by a line on standard output.
//!
//! [`lines`] are of bounded length, a [`Session`] answers them, and [`save`] writes the model to a file where one asks for it.

mod lines;
mod save;

use std::io::{self, BufRead, ErrorKind, Write};
use std::path::Path;

use super::args::EditArgs;
use super::edit::begin;
use super::error::{CliError, Done};
use super::input::Input;
use super::pool::on_threads;
use super::progress::Progress;
use super::terminal;
use lines::{Line, Lines};
use planecut::csg::LiveModel;
use planecut::session::{Answer, Session, refusal};
use save::Saving;

/// Runs the command until standard input ends.
///
/// # Errors
/// Those of reading the input, [`CliError::Stdout`], and [`CliError::Bug`] after an edit that shows a bug: the model cannot be trusted then.
pub(crate) fn run(args: &EditArgs) -> Result<Done, CliError> {
    let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
    if input.file().is_none() {
        return Err(CliError::Usage(
            "found the input on standard input, expected a file: --serve reads edits there".into(),
        ));
    }
    args.reading.check(kind)?;
    args.output.assets.check_without_sources()?;
    on_threads(args.common.threads, || {
        let progress = Progress::start(args.common.quiet);
        let (live, warnings) = begin(&input, kind, &args.reading, &progress)?;
        drop(progress);
        if !args.common.quiet {
            terminal::print_warnings(&input.name(), &warnings);
        }
        let saving = Saving { args, input: &input, kind };
        match serve(Session::new(live), &saving, io::stdin().lock(), io::stdout().lock()) {
            // nobody is left to answer
            Err(CliError::Stdout(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(Done::Complete),
            outcome => outcome.map(|()| Done::Complete),
        }
    })
}

/// Answers each line but empty ones.
///
/// # Errors
/// [`CliError::Read`], [`CliError::Stdout`], and [`CliError::Bug`] after an edit that shows one.
fn serve(
    mut session: Session,
    saving: &Saving<'_>,
    input: impl BufRead,
    mut output: impl Write,
) -> Result<(), CliError> {
    for line in Lines::new(input) {
        let (message, bug) = match line {
            Ok(Line::Text(text)) if text.trim_ascii().is_empty() => continue,
            Ok(Line::Text(text)) => {
                let save = |live: &LiveModel, path: &Path| saving.save(live, path).map_err(|error| error.to_string());
                let Answer { message, bug } = session.answer(&text, save);
                (message, bug)
            }
            Ok(Line::TooLong) => {
                let fault = format!("found a line of more than {} bytes, expected a shorter one", lines::LIMIT);
                (refusal(None, &fault), None)
            }
            Err(source) => return Err(CliError::Read { path: "standard input".into(), source }),
        };
        let mut bytes = message.to_string().into_bytes();
        bytes.push(b'\n');
        output.write_all(&bytes).and_then(|()| output.flush()).map_err(CliError::Stdout)?;
        if let Some(source) = bug {
            return Err(CliError::of_evaluation(&saving.input.path, source));
        }
    }
    Ok(())
}
