//! The process of an entrant, as seen from the one that lets them take turns.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use crate::contestants::Outcome;
use crate::contestants::worker::Answer;
use crate::entrant::{Entrant, MANIFOLD3D};
use crate::machine;

/// A process that waits for its turn.
pub(crate) struct Process {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Failure {
    /// The process was too slow.
    OverLimit(String),
    /// It refused, crashed or could not be started.
    Refused(String),
}

impl Failure {
    fn of(text: impl Into<String>) -> Self {
        Self::Refused(text.into())
    }

    pub(crate) fn text(&self) -> &str {
        let (Self::OverLimit(text) | Self::Refused(text)) = self;
        text
    }
}

impl Process {
    /// Starts a process that reads the scene; [`Self::until_ready`] waits for it.
    pub(crate) fn start(entrant: Entrant, scene: &Path) -> Result<Self, Failure> {
        let mut command = if entrant.name == MANIFOLD3D {
            let mut command =
                machine::pinned(concat!(env!("CARGO_MANIFEST_DIR"), "/../../validate/run"), entrant.cores);
            command.arg("--python").arg(concat!(env!("CARGO_MANIFEST_DIR"), "/manifold3d_worker.py"));
            command
        } else {
            let program = std::env::current_exe().map_err(|error| Failure::of(error.to_string()))?;
            let mut command = machine::pinned(&program.to_string_lossy(), entrant.cores);
            command.args(["--worker", entrant.name]);
            command
        };
        command.env("RAYON_NUM_THREADS", entrant.cores.to_string()).arg(scene);
        // what those say that panic would only be in the way of the tables
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(|error| Failure::of(error.to_string()))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Failure::of("its input or output is not there"));
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Self { child, input, answers })
    }

    /// Waits until the scene is read. From then on the peak of the memory is that of the runs.
    pub(crate) fn until_ready(&mut self, limit: Duration) -> Result<(), Failure> {
        match self.answer(limit)? {
            Answer::Ready => {
                // resets the peak; without it the peak counts the reading too
                let _ = std::fs::write(format!("/proc/{}/clear_refs", self.child.id()), "5");
                Ok(())
            }
            Answer::Ok(_) => Err(Failure::of("it answered before it was asked")),
            Answer::Err(error) => Err(Failure::Refused(error)),
        }
    }

    /// One run.
    pub(crate) fn run(&mut self, limit: Duration) -> Result<Outcome, Failure> {
        // an error here means that it has ended, which the answer says better
        let _ = self.input.write_all(b"run\n").and_then(|()| self.input.flush());
        match self.answer(limit)? {
            Answer::Ok(outcome) => Ok(outcome),
            Answer::Err(error) => Err(Failure::Refused(error)),
            Answer::Ready => Err(Failure::of("it began again")),
        }
    }

    fn answer(&mut self, limit: Duration) -> Result<Answer, Failure> {
        match self.answers.recv_timeout(limit) {
            Ok(line) => serde_json::from_str(&line).map_err(|error| Failure::of(format!("{error} in {line:?}"))),
            Err(RecvTimeoutError::Timeout) => {
                Err(Failure::OverLimit(format!("no end within {} s", limit.as_secs_f64())))
            }
            Err(RecvTimeoutError::Disconnected) => Err(match self.child.wait() {
                Ok(status) => Failure::of(format!("it ended: {status}")),
                Err(error) => Failure::of(error.to_string()),
            }),
        }
    }

    /// Resident memory now, in bytes, where the system tells.
    pub(crate) fn resident(&self) -> Option<u64> {
        self.status("VmRSS:")
    }

    /// The largest resident memory since the scene was read, in bytes, where the system tells.
    pub(crate) fn peak(&self) -> Option<u64> {
        self.status("VmHWM:")
    }

    fn status(&self, field: &str) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix(field))?;
        Some(line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok()? * 1024)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // it may be in a run that never ends
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
