//! The process that does jobs, one after another: what is asked for comes as lines of JSON on standard input, answers go to standard output.

use std::ffi::OsString;
use std::io::{self, BufRead, Write};
use std::panic;
use std::time::Instant;

use planecut::import::file;
use serde::{Deserialize, Serialize};

use crate::cli::error::{CliError, Done, FAILED};
use crate::cli::{parse_and_run, terminal};

/// A command line to carry out.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Request {
    pub(super) arguments: Vec<String>,
    /// Where its outputs go, as arguments name it: who does it elsewhere puts another folder in its place.
    #[serde(default)]
    pub(super) folder: String,
}

/// What became of it.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Answer {
    pub(super) status: u8,
    pub(super) seconds: f64,
    pub(super) error: Option<String>,
    pub(super) warnings: Vec<String>,
    /// What the command has printed.
    pub(super) text: String,
    /// The files that it has read, or looked for.
    pub(super) read: Vec<String>,
    /// Whether the process ends now, because nobody knows what a bug has left behind.
    pub(super) is_last: bool,
}

/// Does jobs until there are no more.
///
/// # Errors
/// [`CliError::Stdout`] where nobody takes the answers, [`CliError::Usage`] for a request that is none and for a limit that the system does not set.
pub(super) fn run(memory: Option<u64>) -> Result<Done, CliError> {
    if let Some(megabytes) = memory {
        limit_memory(megabytes)?;
    }
    let mut answers = io::stdout();
    for line in io::stdin().lock().lines() {
        let request: Request = line
            .map_err(|error| error.to_string())
            .and_then(|line| serde_json::from_str(&line).map_err(|error| error.to_string()))
            .map_err(|error| CliError::Usage(format!("found a request that is none: {error}")))?;
        let answer = answer(request);
        let mut text = serde_json::to_vec(&answer).map_err(|error| CliError::Stdout(error.into()))?;
        text.push(b'\n');
        answers.write_all(&text).and_then(|()| answers.flush()).map_err(CliError::Stdout)?;
        if answer.is_last {
            break;
        }
    }
    Ok(Done::Complete)
}

fn answer(request: Request) -> Answer {
    let arguments: Vec<OsString> = request.arguments.into_iter().map(OsString::from).collect();
    let begin = Instant::now();
    terminal::begin_capture();
    file::begin_record();
    let outcome = panic::catch_unwind(|| parse_and_run(&arguments));
    let seconds = begin.elapsed().as_secs_f64();
    let read = file::end_record().into_iter().map(|path| path.display().to_string()).collect();
    let terminal::Captured { text, mut lines } = terminal::end_capture();
    let (status, error, is_last) = match outcome {
        Ok(Ok(done)) => (done.exit_status(), None, false),
        Ok(Err(error)) => (error.exit_status(), Some(terminal::in_one_line(&error.to_string())), false),
        // the hook has told it as the last line
        Err(_) => (FAILED, Some(lines.pop().unwrap_or_default()), true),
    };
    Answer { status, seconds, error, warnings: lines, text, read, is_last }
}

#[cfg(unix)]
fn limit_memory(megabytes: u64) -> Result<(), CliError> {
    use rustix::process::{Resource, Rlimit, setrlimit};
    // what is mapped counts, also where nothing is written to it; a worker in Python keeps freed memory
    planecut_csg::spare_addresses();
    let bytes = Some(megabytes.saturating_mul(1_000_000));
    setrlimit(Resource::Data, Rlimit { current: bytes, maximum: bytes }).map_err(|error| {
        CliError::Usage(format!("found a system that sets no limit on memory: {error}, expected one that does"))
    })
}

#[cfg(not(unix))]
fn limit_memory(_megabytes: u64) -> Result<(), CliError> {
    Err(CliError::Usage("found --memory, expected it on Unix alone".to_owned()))
}
