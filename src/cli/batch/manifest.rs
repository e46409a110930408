//! The manifest: jobs, one JSON object a line.

use std::ffi::OsString;
use std::fmt;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};
use serde_json::Value;

use super::job::{Job, JobCommand};
use crate::cli::args;
use crate::cli::error::CliError;
use crate::cli::input::Input;

/// A line as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    id: String,
    command: JobCommand,
    input: OneOrMore,
    #[serde(default)]
    outputs: Vec<String>,
    #[serde(default)]
    options: Options,
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum OneOrMore {
    One(String),
    More(Vec<String>),
}

/// Options, none of them twice: of two the reader of JSON would drop one.
#[derive(Debug, Default)]
struct Options(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for Options {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Members;
        impl<'de> Visitor<'de> for Members {
            type Value = Options;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of options")
            }

            fn visit_map<M: MapAccess<'de>>(self, mut members: M) -> Result<Options, M::Error> {
                let mut options: Vec<(String, Value)> = Vec::new();
                while let Some((name, value)) = members.next_entry::<String, Value>()? {
                    if options.iter().any(|(other, _)| *other == name) {
                        return Err(M::Error::custom(format_args!("the option `{name}` twice")));
                    }
                    options.push((name, value));
                }
                options.sort_by(|(one, _), (other, _)| one.cmp(other));
                Ok(Options(options))
            }
        }
        deserializer.deserialize_map(Members)
    }
}

/// Reads all jobs, and sees of each that its command line can be understood.
///
/// # Errors
/// [`CliError::Read`], and [`CliError::Manifest`] with the line of the first job that is none.
pub(super) fn read(path: &Path) -> Result<Vec<Job>, CliError> {
    let input = if path == Path::new("-") { Input::stdin() } else { Input::plain(path) };
    let bytes = input.read()?;
    let refuse = |line: usize, message: String| CliError::Manifest { path: input.path.clone(), line, message };
    let mut jobs = Vec::new();
    let mut ids: FxHashMap<String, usize> = FxHashMap::default();
    let mut outputs: FxHashMap<String, usize> = FxHashMap::default();
    for (number, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        let number = number + 1;
        if line.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        let job = job_of(line).map_err(|message| refuse(number, message))?;
        if let Some(first) = ids.insert(job.id.clone(), number) {
            return Err(refuse(number, format!("found the id {:?} of line {first}, expected another one", job.id)));
        }
        for name in job.named_outputs() {
            if let Some(first) = outputs.insert(name.to_owned(), number) {
                return Err(refuse(
                    number,
                    format!("found the output {name:?} of line {first}, expected another name"),
                ));
            }
        }
        jobs.push(job);
    }
    Ok(jobs)
}

fn job_of(line: &[u8]) -> Result<Job, String> {
    let Line { id, command, input, outputs, options } =
        serde_json::from_slice(line).map_err(|error| format!("found {}", without_place(&error.to_string())))?;
    let inputs = match input {
        OneOrMore::One(input) => vec![input],
        OneOrMore::More(inputs) => inputs,
    };
    let job = Job { id, command, inputs, outputs, options: options.0 };
    job.check()?;
    let arguments: Vec<OsString> = job.arguments(Path::new("out"), 1);
    match args::parse(&arguments) {
        Ok(Some(_)) => Ok(job),
        Ok(None) => Err("found an option that asks for help, expected a job".to_owned()),
        Err(CliError::Usage(message)) => Err(message),
        Err(error) => Err(error.to_string()),
    }
}

/// A message of the JSON reader without the place in the line, which is the only one there is.
fn without_place(message: &str) -> &str {
    message.rfind(" at line ").map_or(message, |end| &message[..end])
}
