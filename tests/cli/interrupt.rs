//! A program that is interrupted ends at once, and leaves nothing behind.
#![cfg(unix)]

use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::support::{command, everything_in, folder};

/// Takes minutes, in each of its steps: reading, evaluating, drawing.
const LONG: &str = r#"{"planecut": 1, "model": {"name": "ring", "torus": {"radius": 2, "tube": 1, "segments": 1400, "tube_segments": 1400}}}"#;
/// Has a turntable of many pictures, which are drawn while they are written.
const SMALL: &str = r#"{"planecut": 1, "model": {"sphere": {"radius": 1, "segments": 64}}}"#;

/// Sends a signal to a program that runs.
fn signal(child: &Child, name: &str) {
    let kill = format!("kill -{name} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().expect("a shell").success());
}

/// Interrupts the program in a folder of two inputs after a while, and sees what is left of it.
#[track_caller]
fn interrupted(args: &str, while_it_runs: Duration, how: &str, number: i32) {
    let folder = folder();
    for (name, text) in [("long.json", LONG), ("small.json", SMALL), ("edits.jsonl", "{\"op\": \"undo\"}\n")] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    let before = everything_in(folder.path());
    let mut child = start(folder.path(), args);
    // of a model on standard input the end is awaited
    let mut input = child.stdin.take().expect("a pipe");
    input.write_all(b"{\"planecut\": 1, ").expect("written");
    sleep(while_it_runs);
    assert!(child.try_wait().expect("asked").is_none(), "{args}: it had ended before");
    let begin = Instant::now();
    signal(&child, how);
    let status = child.wait().expect("waited");
    assert!(begin.elapsed() < Duration::from_secs(1), "{args}: {:?}", begin.elapsed());
    assert_eq!(status.signal(), Some(number), "{args}: {status}");
    assert_eq!(everything_in(folder.path()), before, "{args}");
}

fn start(folder: &Path, args: &str) -> Child {
    let mut command = command();
    command.current_dir(folder).args(args.split(' '));
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("the program starts")
}

const INT: i32 = 2;
const TERM: i32 = 15;

#[test]
fn an_interrupt_ends_every_job_within_a_second_and_leaves_nothing() {
    for (args, milliseconds) in [
        ("build long.json -o new/out.glb --report new/report.json", 100),
        ("build long.json -o out.glb -o out.obj --mtl --preview out.png", 700),
        ("build long.json -o parts.glb --parts", 400),
        ("info long.json", 300),
        ("coarsen long.json -o cells/{}.obj", 500),
        ("edit long.json edits.jsonl -o out.stl --verify", 500),
        ("render long.json -o new/long.png", 600),
        ("build - -o out.glb", 200),
    ] {
        interrupted(args, Duration::from_millis(milliseconds), "INT", INT);
    }
    interrupted("build long.json -o out.glb", Duration::from_millis(300), "TERM", TERM);
}

#[test]
fn an_interrupt_amid_writing_leaves_neither_file_nor_folder() {
    // pictures are drawn as they are written
    for place in ["turntable.gif", "new/folder/turntable.apng"] {
        let args = format!("render small.json -o {place} --frames 1000 --size 2000x2000");
        interrupted(&args, Duration::from_millis(1500), "INT", INT);
    }
}
