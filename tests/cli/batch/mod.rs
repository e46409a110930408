//! `batch`: many jobs, what fails among them, what is made again, and what the cache holds.

mod cache;
mod manifest;
mod support;

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::support::{command, files_below, finish, folder, planecut};
use support::Batch;

#[test]
fn every_job_gives_the_bytes_of_its_command() {
    let batch = Batch::new();
    batch.write("pin.stl.json", r#"{"planecut": 1, "model": {"sphere": {"radius": 2, "segments": 12}}}"#);
    let jobs = [
        json!({"id": "wide", "command": "build", "input": "box.json", "outputs": ["wide.glb", "obj/wide.obj"], "options": {"set": {"w": 7}, "mtl": true}}),
        json!({"id": "both", "command": "build", "input": ["box.json", "pin.stl.json"], "outputs": ["both.stl"], "options": {"combine": "difference", "cells": true}}),
        json!({"id": "few", "command": "coarsen", "input": "pin.stl.json", "outputs": ["few.urdf"], "options": {"max-cells": 1}}),
        json!({"id": "seen", "command": "render", "input": "box.json", "outputs": ["seen.png"], "options": {"size": "64x48"}}),
    ];
    let run = batch.run(&jobs, "--jobs 2");
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let alone = folder();
    fs::create_dir(alone.path().join("obj")).expect("made");
    let place = |name: &str| alone.path().join(name).display().to_string();
    let commands = [
        format!("build box.json -o {} -o {} --set w=7 --mtl", place("wide.glb"), place("obj/wide.obj")),
        format!("build box.json pin.stl.json -o {} --combine difference --cells", place("both.stl")),
        format!("coarsen pin.stl.json -o {} --max-cells 1", place("few.urdf")),
        format!("render box.json -o {} --size 64x48", place("seen.png")),
    ];
    for line in &commands {
        assert_eq!(finish(command().current_dir(batch.path()).args(line.split(' '))).status, 0, "{line}");
    }
    let results = batch.results();
    let told: Vec<&str> = results.iter().map(|result| result["id"].as_str().expect("an id")).collect();
    assert_eq!(told, ["wide", "both", "few", "seen"]);
    for result in &results {
        assert_eq!((&result["status"], &result["cached"], &result["error"]), (&json!(0), &json!(false), &Value::Null));
        assert!(result["seconds"].as_f64().expect("a number") > 0.0);
    }
    let mut made = files_below(&batch.out());
    made.retain(|(name, _)| name != "results.jsonl");
    assert_eq!(made, files_below(alone.path()));
    // a rigid body has a mesh in a file beside it
    assert!(made.len() > 6, "{:?}", made.iter().map(|(name, _)| name).collect::<Vec<_>>());
}

#[test]
fn reports_and_checks_are_jobs_too() {
    let batch = Batch::new();
    let built = [
        json!({"id": "build", "command": "build", "input": "box.json", "outputs": ["box.glb"], "options": {"report": "reports/box.json"}}),
        json!({"id": "info", "command": "info", "input": "box.json", "outputs": ["info.json"]}),
    ];
    assert_eq!(batch.run(&built, "").status, 0);
    for name in ["reports/box.json", "info.json"] {
        let report: Value = serde_json::from_slice(&fs::read(batch.out().join(name)).expect("there")).expect("JSON");
        assert_eq!(report["solid"]["volume"], json!(1.0), "{name}");
    }
    let glb = batch.out().join("box.glb").display().to_string();
    let checked = [
        json!({"id": "sound", "command": "check", "input": glb, "outputs": ["sound.txt"]}),
        json!({"id": "none", "command": "check", "input": "open.obj", "outputs": ["none.txt"]}),
    ];
    batch.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let run = batch.run(&checked, "");
    run.expect_error(1, "results.jsonl: found 1 of 2 jobs that failed, expected none");
    let results = batch.results();
    assert!(fs::read_to_string(batch.out().join("sound.txt")).expect("there").contains("watertight"));
    assert_eq!(results[1]["status"], json!(1));
    assert!(results[1]["error"].as_str().expect("an error").contains("open.obj: found "), "{}", results[1]);
    assert!(!batch.out().join("none.txt").exists());
}

#[test]
fn what_fails_is_a_line_and_the_others_go_on() {
    let batch = Batch::new();
    batch.write("broken.json", "{\"planecut\": 1,\n \"model\": {\"box\": 1}}\n");
    batch.write(
        "slow.json",
        r#"{"planecut": 1, "model": {"torus": {"radius": 2, "tube": 1, "segments": 1400, "tube_segments": 1400}}}"#,
    );
    let build =
        |id: &str, input: &str| json!({"id": id, "command": "build", "input": input, "outputs": [format!("{id}.glb")]});
    let jobs = [
        build("a", "box.json"),
        build("missing", "nosuch.json"),
        build("broken", "broken.json"),
        build("slow", "slow.json"),
        build("b", "box.json"),
    ];
    let begin = Instant::now();
    let run = batch.run(&jobs, "--jobs 1 --timeout 1.5");
    run.expect_error(1, "found 3 of 5 jobs that failed");
    // without an end to it the job takes minutes
    assert!(begin.elapsed() < Duration::from_secs(60));
    let results = batch.results();
    let told =
        |k: usize| (results[k]["status"].as_u64().expect("a status"), results[k]["error"].as_str().unwrap_or(""));
    assert_eq!((told(0), told(4)), ((0, ""), (0, "")));
    assert_eq!(told(1), (2, "nosuch.json: found no such file, expected a file that can be read"));
    assert!(told(2).0 == 2 && told(2).1.starts_with("broken.json:2: "), "{:?}", told(2));
    assert_eq!(told(3), (1, "found more than 1.5 seconds of work, expected no more (--timeout)"));
    let made: Vec<String> = files_below(&batch.out()).into_iter().map(|(name, _)| name).collect();
    assert_eq!(made, ["a.glb", "b.glb", "results.jsonl"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_job_that_takes_too_much_memory_is_ended_alone() {
    let batch = Batch::new();
    batch.write("large.json", r#"{"planecut": 1, "model": {"sphere": {"radius": 2, "segments": 900}}}"#);
    let jobs = [
        json!({"id": "large", "command": "build", "input": "large.json", "outputs": ["large.glb"]}),
        json!({"id": "small", "command": "build", "input": "box.json", "outputs": ["small.glb"]}),
    ];
    batch.run(&jobs, "--jobs 1 --memory 120").expect_error(1, "found 1 of 2 jobs that failed");
    let results = batch.results();
    assert_eq!((&results[0]["status"], &results[1]["status"]), (&json!(1), &json!(0)));
    assert!(results[0]["error"].as_str().expect("an error").starts_with("found no more memory ("), "{}", results[0]);
    assert_eq!(batch.run(&jobs, "--jobs 1").status, 0);
}

#[test]
fn a_loss_is_the_status_of_the_batch_unless_the_job_allows_it() {
    let batch = Batch::new();
    batch.write("loss.csg", "cube([1, 1, 1]);\nimport(\"nosuch.stl\");\n");
    let job = |allow: bool| {
        [
            json!({"id": "a", "command": "build", "input": "loss.csg", "outputs": ["a.glb"], "options": {"keep-going": true, "allow-loss": allow}}),
        ]
    };
    assert_eq!(batch.run(&job(false), "").status, 3);
    let [result] = &batch.results()[..] else { panic!("one result") };
    assert_eq!(result["status"], json!(3));
    assert!(result["warnings"][0].as_str().expect("a warning").starts_with("loss.csg:2: "), "{result}");
    assert_eq!(batch.run(&job(true), "").status, 0);
}

#[test]
fn what_is_up_to_date_is_not_made_again() {
    let batch = Batch::new();
    batch.write("cube.stl", CUBE);
    batch.write("mesh.json", r#"{"planecut": 1, "model": {"mesh": "cube.stl"}}"#);
    let jobs = [
        json!({"id": "mesh", "command": "build", "input": "mesh.json", "outputs": ["mesh.glb"]}),
        json!({"id": "box", "command": "build", "input": "box.json", "outputs": ["box.glb"]}),
    ];
    assert_eq!(batch.run(&jobs, "").status, 0);
    let first = batch.results();
    assert_eq!(first[0]["read"], json!(["cube.stl"]));
    assert_eq!(batch.run(&jobs, "").status, 0);
    // times and all
    assert_eq!(batch.results(), first);
    // the mesh that the model names is another one
    batch.write("cube.stl", &CUBE.replace('1', "2"));
    assert_eq!(batch.run(&jobs, "").status, 0);
    let second = batch.results();
    assert_eq!(second[1], first[1]);
    assert_ne!(second[0]["key"], first[0]["key"]);
    // an output is gone
    fs::remove_file(batch.out().join("box.glb")).expect("removed");
    assert_eq!(batch.run(&jobs, "").status, 0);
    assert!(batch.out().join("box.glb").is_file());
    assert_eq!(batch.results()[0], second[0]);
    // an option is another one
    let other = [
        jobs[0].clone(),
        json!({"id": "box", "command": "build", "input": "box.json", "outputs": ["box.glb"], "options": {"scale": 2}}),
    ];
    let before = fs::read(batch.out().join("box.glb")).expect("there");
    assert_eq!(batch.run(&other, "").status, 0);
    assert_ne!(fs::read(batch.out().join("box.glb")).expect("there"), before);
}

#[test]
fn a_batch_that_is_killed_goes_on_where_it_was() {
    let batch = Batch::new();
    let jobs: Vec<Value> = (0..400)
        .map(|k| json!({"id": k.to_string(), "command": "build", "input": "box.json", "outputs": [format!("{k}.glb")], "options": {"set": {"w": k + 1}}}))
        .collect();
    batch.manifest(&jobs);
    let mut child = batch.command("--jobs 2").stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    while fs::read_to_string(batch.out().join("results.jsonl")).unwrap_or_default().lines().count() < 20 {
        sleep(Duration::from_millis(2));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    // as if the last line had been cut off, too
    let text = fs::read(batch.out().join("results.jsonl")).expect("there");
    fs::write(batch.out().join("results.jsonl"), &text[..text.len() - 5]).expect("written");
    let before = batch.results();
    assert!((19..400).contains(&before.len()), "{}", before.len());
    assert_eq!(batch.run(&jobs, "--jobs 2").status, 0);
    let after = batch.results();
    assert_eq!(after.len(), jobs.len());
    let kept = before.iter().filter(|result| after.contains(result)).count();
    assert_eq!(kept, before.len());
    assert_eq!(files_below(&batch.out()).len(), jobs.len() + 1);
}

#[test]
fn two_batches_do_not_write_into_one_folder() {
    let batch = Batch::new();
    batch.write(
        "slow.json",
        r#"{"planecut": 1, "model": {"torus": {"radius": 2, "tube": 1, "segments": 1400, "tube_segments": 1400}}}"#,
    );
    batch.manifest(&[json!({"id": "slow", "command": "build", "input": "slow.json", "outputs": ["slow.glb"]})]);
    let mut child = batch.command("").stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    while !batch.out().join("results.jsonl").exists() {
        sleep(Duration::from_millis(2));
    }
    let other = finish(&mut batch.command(""));
    child.kill().and_then(|()| child.wait()).expect("ended");
    other.expect_error(2, "out: found a folder that another batch writes into, expected one of its own");
}

#[test]
fn its_processes_say_what_is_no_request() {
    planecut(["batch", "--worker", "m.jsonl"]).expect_error(2, "cannot be used with");
    let folder = folder();
    let run = crate::support::run_with(folder.path(), "batch --worker", b"what\n");
    run.expect_error(2, "found a request that is none");
}

/// A cube as text, whose size is the digit 1.
const CUBE: &str = include_str!("cube.stl");
