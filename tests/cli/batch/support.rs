//! A folder with a manifest, and what a batch makes of it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{Run, command, finish, folder};

/// A folder with `box.json`, a box of the width `w`, 1 by default.
pub(super) struct Batch(TempDir);

impl Batch {
    pub(super) fn new() -> Self {
        let batch = Self(folder());
        let text =
            r#"{"planecut": 1, "parameters": {"w": 1}, "model": {"box": {"min": [0, 0, 0], "max": ["=w", 1, 1]}}}"#;
        batch.write("box.json", text);
        batch
    }

    pub(super) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(super) fn out(&self) -> PathBuf {
        self.path().join("out")
    }

    pub(super) fn write(&self, name: &str, text: &str) {
        fs::write(self.path().join(name), text).expect("written");
    }

    pub(super) fn manifest(&self, jobs: &[Value]) {
        let lines: Vec<String> = jobs.iter().map(|job| format!("{job}\n")).collect();
        self.write("jobs.jsonl", &lines.concat());
    }

    /// The command for the manifest that is there.
    pub(super) fn command(&self, options: &str) -> Command {
        let mut command = command();
        command.current_dir(self.path()).args(["batch", "jobs.jsonl", "--out", "out"]);
        command.args(options.split_whitespace());
        command
    }

    pub(super) fn run(&self, jobs: &[Value], options: &str) -> Run {
        self.manifest(jobs);
        finish(&mut self.command(options))
    }

    /// The lines of the results that are whole.
    pub(super) fn results(&self) -> Vec<Value> {
        let text = fs::read_to_string(self.out().join("results.jsonl")).expect("results");
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
    }
}
