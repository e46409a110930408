//! Files appear when complete; standard output, pipes and full disks are handled as a pipeline expects.

use std::path::Path;
use std::process::Stdio;

use crate::support::{Run, block, command, everything_in, finish, folder, keep, planecut, write_map};

/// Runs `planecut` in `folder`, which gets an `m.map` with one box.
fn run_in(folder: &Path, args: &str) -> Run {
    write_map(folder, "m.map", &[block([0; 3], [1; 3], "stone")]);
    finish(command().current_dir(folder).args(args.split(' ')))
}

#[test]
fn all_outputs_of_one_run_and_missing_folders() {
    let folder = folder();
    let args =
        "build m.map -o x/y/a.glb -o a.gltf -o a.OBJ -o a.stl --preview p/a.png --preview-size 40x30 --report r/a.json";
    run_in(folder.path(), args).expect_quiet_success();
    let expected = ["a.OBJ", "a.glb", "a.gltf", "a.json", "a.png", "a.stl", "m.map", "p", "r", "x", "y"];
    assert_eq!(everything_in(folder.path()), expected);
    let picture = std::fs::read(folder.path().join("p/a.png")).expect("a picture");
    // The header of a PNG file: width and height are at bytes 16 to 24.
    assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n"));
    assert_eq!(picture[16..24], [0, 0, 0, 40, 0, 0, 0, 30]);
}

#[test]
fn standard_output_gets_the_bytes_of_the_file() {
    let folder = folder();
    for format in ["glb", "gltf", "obj", "stl"] {
        run_in(folder.path(), &format!("build m.map -o a.{format}")).expect_quiet_success();
        let run = run_in(folder.path(), &format!("build m.map -o - --format {format}")).expect_quiet_success();
        assert_eq!(run.stdout, std::fs::read(folder.path().join(format!("a.{format}"))).expect("a mesh"), "{format}");
    }
    run_in(folder.path(), "render m.map -o a.png --size 40x30").expect_quiet_success();
    let run = run_in(folder.path(), "render m.map -o - --size 40x30").expect_quiet_success();
    assert_eq!(run.stdout, std::fs::read(folder.path().join("a.png")).expect("a picture"));
}

#[test]
fn scale_multiplies_the_mesh_and_not_the_report() {
    let folder = folder();
    run_in(folder.path(), "build m.map -o a.obj --scale 2 --report r.json").expect_quiet_success();
    let mesh = run_in(folder.path(), "info a.obj").json();
    assert_eq!((mesh["mesh"]["volume"].as_f64(), mesh["format"].as_str()), (Some(8.0), Some("obj")));
    let report = std::fs::read(folder.path().join("r.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    assert_eq!(report["mesh"]["volume"].as_f64(), Some(1.0));
}

#[test]
fn a_place_that_cannot_be_written_fails_the_job() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "").expect("written");
    run_in(folder.path(), "build m.map -o file/a.glb").expect_error(1, "file/a.glb: found");
    assert_eq!(everything_in(folder.path()), ["file", "m.map"]);
}

/// A full disk behind any output: the job fails, and outputs that were complete before stay.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_fails_the_job() {
    use std::fs::OpenOptions;
    let Ok(full) = OpenOptions::new().write(true).open("/dev/full") else {
        println!("skipped: /dev/full is absent");
        return;
    };
    let folder = folder();
    run_in(folder.path(), "build m.map -o a.obj --report /dev/full").expect_error(1, "/dev/full: found");
    assert_eq!(everything_in(folder.path()), ["a.obj", "m.map"]);
    for args in ["info m.map", "build m.map -o - --format obj", "--help"] {
        let stdout = full.try_clone().expect("one more handle");
        let child = command().current_dir(&folder).args(args.split(' ')).stdout(stdout).stderr(Stdio::piped()).spawn();
        let output = child.expect("the program starts").wait_with_output().expect("it ends");
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(stderr.starts_with("error: standard output: found") && stderr.lines().count() == 1, "{stderr}");
        assert_eq!(output.status.code(), Some(1), "{args}");
    }
}

/// A reader that goes away: fine for text, a failure for a mesh that somebody waits for.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_panic() {
    let map = keep();
    for (args, status) in [(["info", "-q"].as_slice(), 0), (&["build", "-o", "-", "--format", "obj"], 1)] {
        let mut command = command();
        command.args(args).arg(&map).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!((output.status.code(), stderr.lines().count()), (Some(status), status as usize), "{stderr}");
        assert!(!stderr.contains("panicked"), "{stderr}");
    }
}

#[test]
fn quiet_says_nothing() {
    let folder = folder();
    let empty = write_map(folder.path(), "empty.map", &[]);
    planecut(["info".as_ref(), empty.as_os_str(), "--quiet".as_ref()]).expect_quiet_success();
}
