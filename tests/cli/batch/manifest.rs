//! Manifests that are none: one error that names the line, and nothing is begun.

use std::fs;

use super::support::Batch;
use crate::support::{finish, run_with};

const GOOD: &str = r#"{"id": "a", "command": "build", "input": "box.json", "outputs": ["a.glb"]}"#;

#[test]
fn a_line_that_is_no_job_is_told_before_anything_is_done() {
    let with = |old: &str, new: &str| GOOD.replace(old, new);
    let cases = [
        ("{\"id\": \"b\"".to_owned(), "found EOF"),
        ("[1]".to_owned(), "found invalid"),
        (with("\"id\": \"a\", ", ""), "missing field `id`"),
        (with("\"id\"", "\"name\""), "unknown field `name`"),
        (with("build", "view"), "unknown variant `view`"),
        (with("\"box.json\"", "[]"), "found no input"),
        (with("\"box.json\"", "\"-\""), "found the input `-`"),
        (with("[\"a.glb\"]", "[]"), "found 0 outputs, expected one for `build`"),
        (with("a.glb", "../a.glb"), "found the output \"../a.glb\""),
        (with("a.glb", "/a.glb"), "found the output \"/a.glb\""),
        (with("\"outputs\"", "\"options\": {\"nosuch\": 1}, \"outputs\""), "--nosuch"),
        (with("\"outputs\"", "\"options\": {\"set\": {\"w\": \"wide\"}}, \"outputs\""), "expected NAME=VALUE"),
        (with("\"outputs\"", "\"options\": {\"scale\": 2, \"scale\": 3}, \"outputs\""), "the option `scale` twice"),
        (with("\"outputs\"", "\"options\": {\"help\": true}, \"outputs\""), "found the option `help`"),
        (with("\"outputs\"", "\"options\": {\"output\": \"b.glb\"}, \"outputs\""), "found the option `output`"),
        (with("a.glb", "b.glb"), "found the id \"a\" of line 1"),
        (with("\"id\": \"a\"", "\"id\": \"b\""), "found the output \"a.glb\" of line 1"),
    ];
    for (line, words) in cases {
        let batch = Batch::new();
        batch.write("jobs.jsonl", &format!("{GOOD}\n\n{line}\n"));
        let run = finish(&mut batch.command(""));
        run.expect_error(2, "jobs.jsonl:3: ");
        run.expect_error(2, words);
        assert!(!batch.out().exists(), "{line}");
    }
}

#[test]
fn a_manifest_may_be_empty_or_come_from_standard_input() {
    let batch = Batch::new();
    batch.write("jobs.jsonl", "\n");
    finish(&mut batch.command("")).expect_quiet_success();
    assert_eq!(fs::read(batch.out().join("results.jsonl")).expect("there"), b"");
    let run = run_with(batch.path(), "batch - --out other", format!("{GOOD}\n").as_bytes());
    run.expect_quiet_success();
    assert!(batch.path().join("other/a.glb").is_file());
    batch.write("jobs.jsonl", "nonsense");
    finish(&mut batch.command("")).expect_error(2, "jobs.jsonl:1: ");
    finish(batch.command("").args(["--cache-size", "3"])).expect_error(2, "--cache");
}
