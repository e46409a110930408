//! A process that does jobs, from outside: it is asked, and ended where it takes too long.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use super::worker::{Answer, Request};
use crate::cli::error::CliError;

/// Last bytes of what a process says on standard error that are kept.
const LAST_BYTES: usize = 2000;

/// How processes are started.
#[derive(Debug, Clone)]
pub(super) struct Launch {
    /// The program and its arguments.
    pub(super) command: Vec<OsString>,
    pub(super) timeout: Option<Duration>,
    /// Whether memory is limited.
    pub(super) is_limited: bool,
}

/// What became of a request.
pub(super) enum Outcome {
    Answered(Answer),
    /// The process had to be ended, or has ended by itself; what is to be said of it.
    Lost(String),
}

/// A process that is kept for job after job.
pub(super) struct Process {
    child: Child,
    requests: ChildStdin,
    answers: Receiver<io::Result<String>>,
    said: Arc<Mutex<VecDeque<u8>>>,
    timeout: Option<Duration>,
}

impl Drop for Process {
    fn drop(&mut self) {
        // it may be in the middle of something, and ends by itself otherwise
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Process {
    /// Starts one.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the system does not start it.
    pub(super) fn start(launch: &Launch) -> Result<Self, CliError> {
        let (program, arguments) =
            launch.command.split_first().ok_or_else(|| failed(&io::ErrorKind::NotFound.into()))?;
        let mut command = Command::new(program);
        if launch.is_limited {
            // the allocator takes address space ahead of need: that counts as taken unless it is told so
            command.env("MIMALLOC_ARENA_EAGER_COMMIT", "0");
        }
        let mut child = command
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failed(&error))?;
        let no_pipe = || failed(&io::ErrorKind::BrokenPipe.into());
        let requests = child.stdin.take().ok_or_else(no_pipe)?;
        let output = child.stdout.take().ok_or_else(no_pipe)?;
        let mut errors = child.stderr.take().ok_or_else(no_pipe)?;
        let (sender, answers) = mpsc::channel();
        thread::spawn(move || {
            for line in BufReader::new(output).lines() {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        let said = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&said);
        thread::spawn(move || {
            let mut chunk = [0; 1024];
            while let Ok(count @ 1..) = errors.read(&mut chunk) {
                let Ok(mut said) = kept.lock() else { break };
                said.extend(&chunk[..count]);
                let surplus = said.len().saturating_sub(LAST_BYTES);
                said.drain(..surplus);
            }
        });
        Ok(Self { child, requests, answers, said, timeout: launch.timeout })
    }

    /// Has a command line carried out; a process that is lost is of no use any more.
    pub(super) fn ask(&mut self, request: &Request) -> Outcome {
        let sent = serde_json::to_vec(request).map_err(io::Error::from).and_then(|mut line| {
            line.push(b'\n');
            self.requests.write_all(&line)?;
            self.requests.flush()
        });
        if sent.is_err() {
            return Outcome::Lost(self.end());
        }
        let line = match self.timeout {
            Some(timeout) => self.answers.recv_timeout(timeout),
            None => self.answers.recv().map_err(RecvTimeoutError::from),
        };
        match line {
            Ok(Ok(line)) => match serde_json::from_str(&line) {
                Ok(answer) => Outcome::Answered(answer),
                Err(error) => Outcome::Lost(format!("found an answer of its process that is none: {error}")),
            },
            Err(RecvTimeoutError::Timeout) => {
                let seconds = self.timeout.unwrap_or_default().as_secs_f64();
                Outcome::Lost(format!("found more than {seconds} seconds of work, expected no more (--timeout)"))
            }
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => Outcome::Lost(self.end()),
        }
    }

    /// What is to be said of a process that has ended.
    fn end(&mut self) -> String {
        let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
        let said = self.said.lock().map(|mut said| said.drain(..).collect::<Vec<u8>>()).unwrap_or_default();
        let said = String::from_utf8_lossy(&said);
        let mut lines = said.lines().filter(|line| !line.trim().is_empty());
        if let Some(line) = lines.clone().find(|line| line.contains("memory allocation of")) {
            return format!("found no more memory ({line}), expected less work or a larger --memory");
        }
        match lines.next() {
            None => format!("found its process ended ({status}), expected an answer"),
            Some(first) => format!("found its process ended ({status}: {first}), expected an answer"),
        }
    }
}

fn failed(error: &io::Error) -> CliError {
    CliError::Usage(format!("found no process for jobs: {error}, expected the system to start one"))
}
