//! `results.jsonl`: what became of each job. It grows while the batch runs, so that one that is killed goes on where it was.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use planecut::export::write_atomic;
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

use super::job::{Job, RESULTS};
use crate::cli::error::{CliError, INCOMPLETE};

/// A line of the results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct JobResult {
    pub(super) id: String,
    /// The exit status of the command; 1 where its process had to be ended.
    pub(super) status: u8,
    /// How long the job took when it was done.
    pub(super) seconds: f64,
    /// Whether it was taken from the cache.
    pub(super) cached: bool,
    pub(super) error: Option<String>,
    /// What the command warned of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) warnings: Vec<String>,
    /// The files that were written, in the folder of outputs.
    #[serde(default)]
    pub(super) files: Vec<String>,
    /// Files that were read beside those that the job names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) read: Vec<String>,
    /// The sum of what the result follows from; nothing where that could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) key: Option<String>,
}

impl JobResult {
    /// Whether the job was done, with all that the input states or without some of it.
    pub(super) fn is_done(&self) -> bool {
        is_done(self.status)
    }
}

/// Whether an exit status is that of a job that was done.
pub(super) fn is_done(status: u8) -> bool {
    matches!(status, 0 | INCOMPLETE)
}

/// The file of results.
pub(super) struct Results {
    path: PathBuf,
    file: File,
}

impl Results {
    /// Opens the file in a folder; also gives what an earlier batch has left there, by the ids of jobs. A line that was cut off is none.
    ///
    /// # Errors
    /// [`CliError::Read`] or [`CliError::Write`] where the system refuses.
    pub(super) fn open(folder: &Path) -> Result<(Self, FxHashMap<String, JobResult>), CliError> {
        let path = folder.join(RESULTS);
        let before = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(CliError::Read { path, source }),
        };
        let lines =
            before.split(|byte| *byte == b'\n').filter_map(|line| serde_json::from_slice::<JobResult>(line).ok());
        let known: FxHashMap<String, JobResult> = lines.map(|result| (result.id.clone(), result)).collect();
        let failed = |source| CliError::Write { path: path.clone(), source };
        let mut file = OpenOptions::new().append(true).create(true).open(&path).map_err(failed)?;
        if before.last().is_some_and(|byte| *byte != b'\n') {
            file.write_all(b"\n").map_err(failed)?;
        }
        Ok((Self { path, file }, known))
    }

    /// Adds a line.
    ///
    /// # Errors
    /// [`CliError::Write`] where the system refuses.
    pub(super) fn add(&mut self, result: &JobResult) -> Result<(), CliError> {
        let written = line_of(result).and_then(|line| self.file.write_all(&line));
        written.map_err(|source| CliError::Write { path: self.path.clone(), source })
    }

    /// Ends with a line for each job, in their order.
    ///
    /// # Errors
    /// [`CliError::Write`] where the system refuses.
    pub(super) fn end(self, jobs: &[Job], results: &FxHashMap<String, JobResult>) -> Result<(), CliError> {
        let failed = |source| CliError::Write { path: self.path.clone(), source };
        let mut text = Vec::new();
        for result in jobs.iter().filter_map(|job| results.get(&job.id)) {
            text.extend(line_of(result).map_err(failed)?);
        }
        write_atomic(&self.path, &text).map_err(|error| failed(io::Error::other(error.to_string())))
    }
}

fn line_of(result: &JobResult) -> io::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(result)?;
    line.push(b'\n');
    Ok(line)
}
