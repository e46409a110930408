//! `planecut coarsen` of meshes: closed, open and doubled ones, without their exact cells.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::support::{Run, folder as scratch, run_with};

/// The eight corners of a cube of side 2 and its sides, each two triangles; the lid is last.
const CORNERS: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n";
const SIDES: [&str; 6] = ["f 1 4 3 2", "f 1 2 6 5", "f 2 3 7 6", "f 3 4 8 7", "f 4 1 5 8", "f 5 6 7 8"];

fn cube_of(folder: &Path, sides: &[&str]) {
    fs::write(folder.join("m.obj"), format!("{CORNERS}{}\n", sides.join("\n"))).expect("written");
}

fn coarsen(folder: &Path, options: &str) -> (Run, Value) {
    let run = run_with(folder, format!("coarsen m.obj -o a.obj --report r.json {options}").trim_end(), b"");
    let report =
        fs::read(folder.join("r.json")).map_or(Value::Null, |text| serde_json::from_slice(&text).expect("JSON"));
    (run, report["coarsen"].clone())
}

#[test]
fn an_open_mesh_is_a_shell_and_that_is_said() {
    let folder = scratch();
    cube_of(folder.path(), &SIDES[..5]);
    let (run, told) = coarsen(folder.path(), "--max-cells 5 --min-thickness 0.125");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    for words in ["m.obj:", "found 4 open edges, the first one from", "shell 0.125 thick", "--solid", "--close"] {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    assert_eq!((&told["taken_as"], &told["thickness"]), (&json!("shell"), &json!(0.125)));
    // five sides of 2 by 2, each its own cell: nothing but their corners is in two
    assert_eq!((told["volume_in"].as_f64(), &told["cells_out"]), (Some(2.5), &json!(5)));
    assert!(told["volume_out"].as_f64().expect("a number") < 3.2, "{told}");
}

#[test]
fn an_open_mesh_is_filled_where_that_is_asked_for() {
    let folder = scratch();
    cube_of(folder.path(), &SIDES[..5]);
    let (run, told) = coarsen(folder.path(), "--max-cells 1 --solid");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("it is filled where it goes around more than half"), "{}", run.stderr);
    assert_eq!((&told["taken_as"], &told["thickness"]), (&json!("filled"), &json!(null)));
    assert!((told["volume_out"].as_f64().expect("a number") - 8.0).abs() < 1e-9, "{told}");
    // an estimate
    assert!((told["volume_in"].as_f64().expect("a number") - 8.0).abs() < 0.1, "{told}");
}

/// One sliver among 420 cells, flat by rounding, had the whole decomposition taken as a shell.
#[test]
fn a_flat_object_among_convex_ones_is_held_by_them() {
    let folder = scratch();
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    let cube = |first: usize| -> String {
        let side = |side: &str| {
            let corner = |corner: &str| corner.parse::<usize>().map_or(corner.to_owned(), |k| (k + first).to_string());
            side.split(' ').map(corner).collect::<Vec<_>>().join(" ")
        };
        SIDES.map(side).join("\n") + "\n"
    };
    let away = corners.replace("v 0", "v 3").replace("v 1", "v 4");
    // above the first cube
    let flat = "o flat\nv 0.25 0.25 1.125\nv 0.75 0.25 1.125\nv 0.5 0.75 1.125\nf 17 18 19\nf 17 19 18\n";
    let text = format!("o a\n{corners}{}o b\n{away}{}{flat}", cube(0), cube(8));
    fs::write(folder.path().join("m.obj"), text).expect("written");
    let (run, told) = coarsen(folder.path(), "--max-cells 2");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("object `flat`: found a surface that encloses no volume"), "{}", run.stderr);
    assert_eq!((&told["taken_as"], &told["cells_in"], &told["cells_out"]), (&json!("cells"), &json!(2), &json!(2)));
    // something, and no more than a box up to the triangle
    let added = told["volume_out"].as_f64().expect("a number") - 2.0;
    assert!(added > 0.0 && added < 0.125, "{told}");
}

#[test]
fn what_goes_around_nothing_stays_a_shell() {
    let folder = scratch();
    // each side from both sides
    let back: Vec<String> = SIDES
        .iter()
        .map(|side| {
            let mut corners: Vec<&str> = side.split(' ').skip(1).collect();
            corners.reverse();
            format!("f {}", corners.join(" "))
        })
        .collect();
    let both: Vec<&str> = SIDES.into_iter().chain(back.iter().map(String::as_str)).collect();
    cube_of(folder.path(), &both);
    for options in ["", "--solid"] {
        let (run, told) = coarsen(folder.path(), format!("--max-cells 6 {options}").trim_end());
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert_eq!(told["taken_as"], json!("shell"), "{options}: {}", run.stderr);
    }
}

#[test]
fn a_closed_mesh_is_a_solid_unless_its_shell_is_asked_for() {
    let folder = scratch();
    // convex as it is, it is a cell; with a dent it is not
    cube_of(folder.path(), &SIDES);
    let (run, told) = coarsen(folder.path(), "--max-cells 1");
    run.expect_quiet_success();
    assert_eq!(told["taken_as"], json!("cells"));
    let dented = format!("{CORNERS}v 1 1 1\n{}\nf 5 6 9\nf 6 7 9\nf 7 8 9\nf 8 5 9\n", SIDES[..5].join("\n"));
    fs::write(folder.path().join("m.obj"), dented).expect("written");
    let (run, told) = coarsen(folder.path(), "--max-cells 1");
    run.expect_quiet_success();
    assert_eq!(told["taken_as"], json!("solid"));
    assert!((told["volume_in"].as_f64().expect("a number") - (8.0 - 4.0 / 3.0)).abs() < 1e-12);
    assert!((told["volume_out"].as_f64().expect("a number") - 8.0).abs() < 1e-9);
    let (run, told) = coarsen(folder.path(), "--max-cells 8 --shell");
    run.expect_quiet_success();
    assert_eq!(told["taken_as"], json!("shell"));
    // exact cells where pieces of a surface exceed it too much
    let (run, told) = coarsen(folder.path(), "--max-excess 0");
    run.expect_quiet_success();
    assert_eq!((&told["taken_as"], told["excess"].as_f64()), (&json!("cells"), Some(0.0)));
    // and where cells are within
    let (run, told) = coarsen(folder.path(), "--max-cells 2 --inner");
    run.expect_quiet_success();
    assert_eq!(told["taken_as"], json!("cells"));
}

#[test]
fn limits_hold_for_cells_of_meshes() {
    let folder = scratch();
    cube_of(folder.path(), &SIDES[..5]);
    let (run, told) = coarsen(folder.path(), "--solid --max-cells 3 --max-faces 6 --max-vertices 8 --overlap-weight 1");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(told["cells_out"].as_u64().is_some_and(|cells| cells <= 3));
    let text = fs::read_to_string(folder.path().join("a.obj")).expect("text");
    let corners = text.lines().filter(|line| line.starts_with("v ")).count();
    assert!(corners <= 24, "{corners}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = scratch();
    cube_of(folder.path(), &SIDES[..5]);
    let refused = |options: &str, words: &str| coarsen(folder.path(), options).0.expect_error(2, words);
    refused("--shell --solid", "--solid");
    refused("--shell --inner", "--inner");
    refused("--overlap-weight=-1", "overlap-weight");
    refused("--max-gap x", "max-gap");
    // nothing fits into what is not closed
    refused("--inner", "not closed");
    fs::write(
        folder.path().join("m.json"),
        r#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#,
    )
    .expect("written");
    run_with(folder.path(), "coarsen m.json -o a.obj --shell", b"").expect_error(2, "expected it with a mesh");
    fs::write(folder.path().join("m.obj"), "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n").expect("written");
    coarsen(folder.path(), "").0.expect_error(1, "m.obj");
    assert!(!folder.path().join("a.obj").exists());
}
