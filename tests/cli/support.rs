//! Running the program, and small maps to run it on.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// The workspace.
pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// What a run of the program left.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) status: i32,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

impl Run {
    /// Fails the test unless the run was a success without a word on standard error.
    #[track_caller]
    pub(crate) fn expect_quiet_success(self) -> Self {
        assert_eq!((self.status, self.stderr.as_str()), (0, ""));
        self
    }

    /// Fails the test unless the run ended with `status` and one line that starts with `error:` and mentions `words`.
    #[track_caller]
    pub(crate) fn expect_error(&self, status: i32, words: &str) {
        let line = self.stderr.strip_suffix('\n').unwrap_or(&self.stderr);
        let is_one_error = line.starts_with("error: ") && !line.contains('\n');
        assert!(is_one_error && line.contains(words), "expected one error about {words:?}, found:\n{}", self.stderr);
        assert_eq!(self.status, status, "{line}");
    }

    /// Standard output as JSON, of a run that left nothing out.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.status, 0, "{}", self.stderr);
        self.lossy_json()
    }

    /// Standard output as JSON, of a run that may have left out solids.
    #[track_caller]
    pub(crate) fn lossy_json(&self) -> Value {
        assert!(matches!(self.status, 0 | 3), "{}", self.stderr);
        serde_json::from_slice(&self.stdout).expect("JSON on standard output")
    }
}

/// The program, with nothing on standard input.
pub(crate) fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_planecut"));
    command.stdin(Stdio::null());
    command
}

/// Runs the program.
pub(crate) fn planecut<S: AsRef<OsStr>>(args: impl IntoIterator<Item = S>) -> Run {
    finish(command().args(args))
}

/// Runs the program in `folder` with `input` on standard input.
pub(crate) fn run_with(folder: &Path, args: &str, input: &[u8]) -> Run {
    let mut child = command()
        .current_dir(folder)
        .args(args.split(' '))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // A program that refuses its arguments does not read.
    let _ = child.stdin.take().expect("a pipe").write_all(input);
    let output = child.wait_with_output().expect("the program ends");
    let stderr = String::from_utf8(output.stderr).expect("messages are UTF-8");
    Run { status: output.status.code().unwrap_or(-1), stdout: output.stdout, stderr }
}

/// Runs a command to its end.
pub(crate) fn finish(command: &mut Command) -> Run {
    let output = command.output().expect("the program starts");
    let stderr = String::from_utf8(output.stderr).expect("messages are UTF-8");
    // A process that a signal ended has no status; no test expects that.
    Run { status: output.status.code().unwrap_or(-1), stdout: output.stdout, stderr }
}

/// An empty folder of the test's own.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder for temporary files")
}

/// All files below a folder with their content, by name.
pub(crate) fn files_below(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let (mut files, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below").display().to_string();
                files.push((name, std::fs::read(&path).expect("read")));
            }
        }
    }
    files.sort();
    files
}

/// Every file and folder below `folder`, by name.
pub(crate) fn everything_in(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        names.push(path.file_name().expect("a name").to_string_lossy().into_owned());
        if path.is_dir() {
            names.extend(everything_in(&path));
        }
    }
    names.sort();
    names
}

/// Writes a map of the given brushes into `folder`.
pub(crate) fn write_map(folder: &Path, name: &str, brushes: &[String]) -> PathBuf {
    let path = folder.join(name);
    let text = format!("{{\n\"classname\" \"worldspawn\"\n{}}}\n", brushes.concat());
    std::fs::write(&path, text).expect("a folder that can be written");
    path
}

/// The text of a box, by its smallest and largest coordinates.
pub(crate) fn block(min: [i32; 3], max: [i32; 3], texture: &str) -> String {
    let mut text = "{\n".to_owned();
    for axis in 0..3 {
        for (corner, turn) in [(min, false), (max, true)] {
            let step = |k: usize| {
                let mut point = corner;
                point[(axis + k) % 3] += 1;
                point
            };
            // The outward normal is (p0 − p1) × (p2 − p1).
            let (first, last) = if turn { (step(1), step(2)) } else { (step(2), step(1)) };
            for point in [first, corner, last] {
                text += &format!("( {} {} {} ) ", point[0], point[1], point[2]);
            }
            text += &format!("{texture} 0 0 0 1 1\n");
        }
    }
    text + "}\n"
}

/// The project's example.
pub(crate) fn keep() -> PathBuf {
    Path::new(ROOT).join("examples/keep.map")
}

/// Whether two numbers agree but for a part of `tolerance`.
pub(crate) fn agree(a: &Value, b: f64, tolerance: f64) -> bool {
    a.as_f64().is_some_and(|a| (a - b).abs() <= tolerance * b.abs().max(f64::MIN_POSITIVE))
}
