//! A job: a command of the program with its input, its outputs and its options.

use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

use serde_json::Value;

/// The commands that a job may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum JobCommand {
    Build,
    Coarsen,
    Render,
    Check,
    Info,
}

impl JobCommand {
    /// Its name on the command line.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Build => "build",
            Self::Coarsen => "coarsen",
            Self::Render => "render",
            Self::Check => "check",
            Self::Info => "info",
        }
    }

    /// Whether its result is a text on standard output, which is the one output that a job may name.
    pub(super) fn prints(self) -> bool {
        matches!(self, Self::Check | Self::Info)
    }
}

/// Options that name files to write: these lie in the folder of the outputs, too.
const OUTPUT_OPTIONS: [&str; 4] = ["report", "preview", "depth", "ids"];
/// Options that name files to read.
const INPUT_OPTIONS: [&str; 1] = ["keep-clear"];
/// Options that the manifest says in another way, or the batch as a whole.
const OTHER_OPTIONS: [&str; 5] = ["output", "format", "quiet", "threads", "help"];

/// A line of the manifest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Job {
    pub(super) id: String,
    pub(super) command: JobCommand,
    pub(super) inputs: Vec<String>,
    pub(super) outputs: Vec<String>,
    /// Long options without their dashes, in the order of their names.
    pub(super) options: Vec<(String, Value)>,
}

impl Job {
    /// What is wrong with it beside what the command itself would say: `found …, expected …`.
    ///
    /// # Errors
    /// The message.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.inputs.is_empty() {
            return Err("found no input, expected the name of a file".to_owned());
        }
        if self.inputs.iter().any(|input| input == "-") {
            return Err(
                "found the input `-`, expected the name of a file: standard input is none for many jobs".to_owned()
            );
        }
        let most = if self.command.prints() || self.command == JobCommand::Render { 1 } else { usize::MAX };
        let least = usize::from(!self.command.prints());
        if !(least..=most).contains(&self.outputs.len()) {
            let expected = if least == 0 { "at most one" } else { "one" };
            let name = self.command.name();
            return Err(format!("found {} outputs, expected {expected} for `{name}`", self.outputs.len()));
        }
        for (name, value) in &self.options {
            if OTHER_OPTIONS.contains(&name.as_str()) {
                let expected = "the outputs in `outputs`, and what holds for all jobs on the command line";
                return Err(format!("found the option `{name}`, expected {expected}"));
            }
            if name.is_empty() || !name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'-') {
                return Err(format!(
                    "found the option {name:?}, expected the name of a long option without its dashes"
                ));
            }
            if OUTPUT_OPTIONS.contains(&name.as_str()) && !value.is_string() {
                return Err(format!("found {value} for the option `{name}`, expected the name of a file"));
            }
        }
        self.named_outputs().try_for_each(check_output)
    }

    /// The outputs that it names, those of options among them.
    pub(super) fn named_outputs(&self) -> impl Iterator<Item = &str> {
        let of_options = self.options.iter().filter(|(name, _)| OUTPUT_OPTIONS.contains(&name.as_str()));
        self.outputs.iter().map(String::as_str).chain(of_options.filter_map(|(_, value)| value.as_str()))
    }

    /// The outputs that are reports: they hold times, too.
    pub(super) fn reports(&self) -> impl Iterator<Item = &str> {
        let of_option =
            self.options.iter().filter(|(name, _)| name == "report").filter_map(|(_, value)| value.as_str());
        let printed = self.outputs.iter().filter(|_| self.command == JobCommand::Info).map(String::as_str);
        of_option.chain(printed)
    }

    /// All files that it names to be read.
    pub(super) fn named_inputs(&self) -> impl Iterator<Item = &str> {
        let of_options = self.options.iter().filter(|(name, _)| INPUT_OPTIONS.contains(&name.as_str()));
        let named = of_options.flat_map(|(_, value)| match value {
            Value::Array(items) => items.as_slice(),
            single => std::slice::from_ref(single),
        });
        self.inputs.iter().map(String::as_str).chain(named.filter_map(Value::as_str))
    }

    /// The command line that does it, with its outputs in a folder.
    pub(super) fn arguments(&self, folder: &Path, threads: u16) -> Vec<OsString> {
        let mut arguments: Vec<OsString> = vec!["planecut".into(), self.command.name().into()];
        if !self.command.prints() {
            for output in &self.outputs {
                arguments.extend(["-o".into(), folder.join(output).into_os_string()]);
            }
        }
        for (name, value) in &self.options {
            let is_output = OUTPUT_OPTIONS.contains(&name.as_str());
            for text in texts(value) {
                let mut argument = OsString::from(format!("--{name}"));
                if let Some(text) = text {
                    argument.push("=");
                    argument.push(if is_output { folder.join(&text).into_os_string() } else { text.into() });
                }
                arguments.push(argument);
            }
        }
        arguments.push(format!("--threads={threads}").into());
        arguments.push("--".into());
        arguments.extend(self.inputs.iter().map(OsString::from));
        arguments
    }
}

/// The values that an option is given: none where it is left out, one without a text where it stands by itself.
fn texts(value: &Value) -> Vec<Option<String>> {
    let plain = |value: &Value| match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match value {
        Value::Null | Value::Bool(false) => Vec::new(),
        Value::Bool(true) => vec![None],
        Value::Array(items) => items.iter().map(|item| Some(plain(item))).collect(),
        Value::Object(members) => {
            members.iter().map(|(name, value)| Some(format!("{name}={}", plain(value)))).collect()
        }
        other => vec![Some(plain(other))],
    }
}

/// The name of the file of results.
pub(super) const RESULTS: &str = "results.jsonl";
/// The folder, within that of the outputs, of what is not complete.
pub(super) const UNFINISHED: &str = ".planecut-batch";

/// Sees that an output lies in the folder of outputs.
fn check_output(name: &str) -> Result<(), String> {
    let mut components = Path::new(name).components();
    let is_below = !name.is_empty() && components.clone().all(|part| matches!(part, Component::Normal(_)));
    if !is_below || name.ends_with(['/', '\\']) {
        return Err(format!("found the output {name:?}, expected a name within the folder of outputs"));
    }
    let first = components.next().map(|part| PathBuf::from(part.as_os_str()));
    if [RESULTS, UNFINISHED].iter().any(|own| first.as_deref() == Some(Path::new(own))) {
        return Err(format!("found the output {name:?}, expected another name: the batch itself has it"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn job(options: Value) -> Job {
        let Value::Object(options) = options else { panic!("an object") };
        Job {
            id: "a".to_owned(),
            command: JobCommand::Build,
            inputs: vec!["-x.json".to_owned()],
            outputs: vec!["a/b.glb".to_owned()],
            options: options.into_iter().collect(),
        }
    }

    #[test]
    fn options_become_arguments() {
        let options = json!({"set": {"w": -7.5, "h": 2}, "cells": false, "parts": true, "skip-texture": ["a b", "c"], "scale": 2, "report": "r.json", "mtl": null});
        let found = job(options).arguments(Path::new("out"), 3);
        let expected = [
            "planecut",
            "build",
            "-o",
            "out/a/b.glb",
            "--parts",
            "--report=out/r.json",
            "--scale=2",
            "--set=h=2",
            "--set=w=-7.5",
            "--skip-texture=a b",
            "--skip-texture=c",
            "--threads=3",
            "--",
            "-x.json",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn outputs_stay_in_their_folder() {
        for name in ["", "/a.glb", "../a.glb", "a/../../b.glb", ".", "a/", "results.jsonl", ".planecut-batch/a.glb"] {
            let job = Job { outputs: vec![name.to_owned()], ..job(json!({})) };
            assert!(job.check().is_err(), "{name}");
        }
        assert!(job(json!({"report": "../r.json"})).check().is_err());
        assert!(job(json!({"output": "b.glb"})).check().is_err());
        assert!(job(json!({"report": "r/r.json"})).check().is_ok());
    }
}
