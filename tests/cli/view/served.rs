//! A program that serves a file, and how the tests talk with it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::Duration;

use tempfile::TempDir;

use crate::support::{command, folder};

pub(super) const MODEL: &str = r#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#;
pub(super) const INDEX: &str = "<!doctype html><title>a page</title>";

/// Longer than anything takes that is waited for: what does not come fails the test.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// A program that serves a file, in a folder with a page.
pub(super) struct Served {
    pub(super) child: Child,
    pub(super) port: u16,
    /// What the program printed.
    pub(super) line: String,
    pub(super) folder: TempDir,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer of the server.
pub(super) struct Answer {
    pub(super) status: u16,
    pub(super) head: String,
    pub(super) body: Vec<u8>,
}

impl Answer {
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let lines = self.head.lines().filter_map(|line| line.split_once(": "));
        lines.filter(|(found, _)| found.eq_ignore_ascii_case(name)).map(|(_, value)| value).next()
    }
}

/// A folder with a model of a name and a page.
pub(super) fn with_page(name: &str) -> TempDir {
    let folder = folder();
    std::fs::write(folder.path().join(name), MODEL).expect("written");
    std::fs::write(folder.path().join("secret.json"), "secret").expect("written");
    for (name, text) in [("index.html", INDEX), ("assets/page.js", "let a = 1;"), (".hidden", "secret")] {
        let path = folder.path().join("page").join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    }
    folder
}

pub(super) fn view(folder: &Path, name: &str) -> Command {
    let mut command = command();
    command.current_dir(folder).args(["view", name, "--page", "page"]);
    command
}

impl Served {
    pub(super) fn start() -> Self {
        let folder = with_page("box.json");
        let command = view(folder.path(), "box.json");
        Self::run(folder, command)
    }

    pub(super) fn run(folder: TempDir, mut command: Command) -> Self {
        let mut child = command
            .arg("--no-open")
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .expect("the program starts");
        let line = first_line(&mut child);
        let port =
            line.split_once("http://127.0.0.1:").and_then(|(_, rest)| rest.split_once('/')).expect("an address").0;
        Self { port: port.parse().expect("a port"), line, child, folder }
    }

    pub(super) fn file(&self) -> std::path::PathBuf {
        self.folder.path().join("box.json")
    }

    pub(super) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time");
        stream
    }

    /// The answer to a request with these lines, but for what names the server.
    pub(super) fn ask(&self, lines: &str) -> Answer {
        let (first, rest) = lines.split_once("\r\n").unwrap_or((lines, ""));
        self.ask_bytes(format!("{first}\r\nHost: 127.0.0.1:{}\r\n{rest}\r\n", self.port).as_bytes())
    }

    pub(super) fn ask_bytes(&self, request: &[u8]) -> Answer {
        let mut stream = self.connect();
        stream.write_all(request).expect("the server reads");
        answer(stream)
    }

    pub(super) fn get(&self, path: &str) -> Answer {
        self.ask(&format!("GET {path} HTTP/1.1"))
    }

    /// A stream of changes that has begun.
    pub(super) fn changes(&self, more: &str) -> Changes {
        let mut stream = self.connect();
        write!(stream, "GET /changes HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{more}\r\n", self.port).expect("written");
        let mut changes = Changes(BufReader::new(stream));
        let head: String = std::iter::from_fn(|| Some(changes.line()).filter(|line| !line.is_empty())).collect();
        assert!(head.starts_with("HTTP/1.1 200 OK") && head.contains("Content-Type: text/event-stream"), "{head}");
        changes
    }
}

/// A stream of events.
pub(super) struct Changes(BufReader<TcpStream>);

impl Changes {
    pub(super) fn line(&mut self) -> String {
        let mut line = String::new();
        self.0.read_line(&mut line).expect("something comes");
        assert!(line.ends_with('\n'), "the stream has ended: {line:?}");
        line.trim_end().to_owned()
    }

    /// The id and the data of the next event.
    pub(super) fn next(&mut self) -> (String, String) {
        let (mut id, mut data, mut is_change) = (String::new(), None, false);
        loop {
            let line = self.line();
            match line.split_once(": ") {
                Some(("id", value)) => id = value.to_owned(),
                Some(("event", value)) => is_change = value == "change",
                Some(("data", value)) => data = Some(value.to_owned()),
                Some(("", _)) => {}
                Some(_) => panic!("{line}"),
                None if is_change => return (id, data.expect("data")),
                None => assert_eq!((line.as_str(), &data), ("", &None)),
            }
        }
    }
}

/// The line that says where the file is.
pub(super) fn first_line(child: &mut Child) -> String {
    let mut output: BufReader<ChildStdout> = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut line = String::new();
    output.read_line(&mut line).expect("the program says where");
    line
}

pub(super) fn answer(mut stream: TcpStream) -> Answer {
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("an answer");
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").expect("the end of a head");
    let head = String::from_utf8(bytes[..end].to_vec()).expect("text");
    let status = head.strip_prefix("HTTP/1.1 ").and_then(|rest| rest[..3].parse().ok()).expect("a status");
    Answer { status, head, body: bytes[end + 4..].to_vec() }
}
