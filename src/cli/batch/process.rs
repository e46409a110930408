//! A process that does jobs, from outside: it is asked, and ended where it takes too long. It may be one of this machine, or whatever answers at an address.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::process::{Child, Command, Stdio};
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
    pub(super) how: How,
    pub(super) timeout: Option<Duration>,
    /// Whether memory is limited.
    pub(super) is_limited: bool,
}

/// Where jobs are done.
#[derive(Debug, Clone)]
pub(super) enum How {
    /// In a process of this machine: the program and its arguments.
    Command(Vec<OsString>),
    /// By whatever answers at an address, and what it is told first, so that it knows who asks.
    Address(String, String),
}

/// What became of a request.
pub(super) enum Outcome {
    Answered(Answer),
    /// The process had to be ended, or has ended by itself; what is to be said of it.
    Lost(String),
}

/// A process that is kept for job after job.
pub(super) struct Process {
    other: Other,
    requests: Box<dyn Write + Send>,
    answers: Receiver<io::Result<String>>,
    said: Arc<Mutex<VecDeque<u8>>>,
    timeout: Option<Duration>,
}

/// Who does the work.
enum Other {
    Child(Child),
    Connection(TcpStream),
}

impl Drop for Process {
    fn drop(&mut self) {
        // it may be in the middle of something, and ends by itself otherwise
        match &mut self.other {
            Other::Child(child) => {
                let _ = child.kill();
                let _ = child.wait();
            }
            Other::Connection(stream) => {
                let _ = stream.shutdown(Shutdown::Both);
            }
        }
    }
}

impl Process {
    /// Starts one.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the system does not start it.
    pub(super) fn start(launch: &Launch) -> Result<Self, CliError> {
        let said = Arc::new(Mutex::new(VecDeque::new()));
        match &launch.how {
            How::Command(command) => {
                let mut child = started(command, launch.is_limited).map_err(|error| failed(&error))?;
                let no_pipe = || failed(&io::ErrorKind::BrokenPipe.into());
                let requests = child.stdin.take().ok_or_else(no_pipe)?;
                let answers = lines_of(child.stdout.take().ok_or_else(no_pipe)?);
                keep_last(child.stderr.take().ok_or_else(no_pipe)?, Arc::clone(&said));
                let (other, requests) = (Other::Child(child), Box::new(requests));
                Ok(Self { other, requests, answers, said, timeout: launch.timeout })
            }
            How::Address(address, token) => {
                let connected = TcpStream::connect(address).and_then(|mut stream| {
                    stream.set_nodelay(true)?;
                    stream.write_all(format!("{token}\n").as_bytes())?;
                    Ok((stream.try_clone()?, stream.try_clone()?, stream))
                });
                let (requests, answers, stream) = connected.map_err(|error| failed(&error))?;
                let (other, requests) = (Other::Connection(stream), Box::new(requests));
                Ok(Self { other, requests, answers: lines_of(answers), said, timeout: launch.timeout })
            }
        }
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
        let status = match &mut self.other {
            Other::Child(child) => child.wait().map_or_else(|error| error.to_string(), |status| status.to_string()),
            Other::Connection(_) => "its connection is closed".to_owned(),
        };
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

fn started(command: &[OsString], is_limited: bool) -> io::Result<Child> {
    let (program, arguments) = command.split_first().ok_or(io::ErrorKind::NotFound)?;
    let mut command = Command::new(program);
    if is_limited {
        // the allocator takes address space ahead of need: that counts as taken unless it is told so
        command.env("MIMALLOC_ARENA_EAGER_COMMIT", "0");
    }
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
}

/// The lines of a stream as they come.
fn lines_of(stream: impl Read + Send + 'static) -> Receiver<io::Result<String>> {
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        for line in BufReader::new(stream).lines() {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    lines
}

/// Keeps what a stream says last.
fn keep_last(mut stream: impl Read + Send + 'static, kept: Arc<Mutex<VecDeque<u8>>>) {
    thread::spawn(move || {
        let mut chunk = [0; 1024];
        while let Ok(count @ 1..) = stream.read(&mut chunk) {
            let Ok(mut said) = kept.lock() else { break };
            said.extend(&chunk[..count]);
            let surplus = said.len().saturating_sub(LAST_BYTES);
            said.drain(..surplus);
        }
    });
}

fn failed(error: &io::Error) -> CliError {
    CliError::Usage(format!("found no process for jobs: {error}, expected the system to start one"))
}
