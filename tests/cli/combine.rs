//! Several inputs as one solid, and options that say how meshes are taken.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::{Run, agree, block, command, finish, folder, write_map};

fn run(folder: &Path, arguments: &str) -> Run {
    finish(command().current_dir(folder).args(arguments.split(' ')))
}

/// Builds with a report; gives it.
#[track_caller]
fn built(folder: &Path, arguments: &str) -> Value {
    run(folder, &format!("build {arguments} -o out.obj --report r.json")).expect_quiet_success();
    serde_json::from_slice(&std::fs::read(folder.join("r.json")).expect("a report")).expect("JSON")
}

/// An L of 2 × 2 less 1 × 1, one unit high, moved by `z`, as an OBJ file with a material.
fn l_shape(z: f64, material: &str) -> String {
    let outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)];
    let mut text = format!("usemtl {material}\n");
    for height in [z, z + 1.0] {
        outline.iter().for_each(|(x, y)| text += &format!("v {x} {y} {height}\n"));
    }
    text += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
    (0..6).for_each(|k| text += &format!("f {} {} {} {}\n", k + 1, (k + 1) % 6 + 1, (k + 1) % 6 + 7, k + 7));
    text
}

/// A map, an OpenSCAD tree, a model and a mesh, all of the size of the unit cube but for the L, which has three.
fn inputs(folder: &Path) {
    write_map(folder, "m.map", &[block([0; 3], [1; 3], "stone")]);
    std::fs::write(folder.join("c.csg"), "cube(size = [1, 1, 1], center = false);\n").expect("a file");
    std::fs::write(folder.join("l.obj"), l_shape(0.0, "stone")).expect("a file");
    std::fs::write(folder.join("j.json"), r#"{"planecut": 1, "model": {"box": {"min": [1, 0, 0], "max": [3, 1, 1]}}}"#)
        .expect("a file");
}

#[test]
fn inputs_of_any_kinds_are_combined() {
    let folder = folder();
    inputs(folder.path());
    for (arguments, volume) in [
        ("l.obj m.map --combine difference", 2.0),
        ("m.map l.obj --combine difference", 0.0),
        ("l.obj j.json --combine difference", 2.0),
        ("l.obj j.json --combine union", 4.0),
        ("l.obj j.json --combine intersection", 1.0),
        ("l.obj j.json --combine xor", 3.0),
        ("l.obj j.json c.csg m.map --combine xor", 3.0),
        ("j.json m.map c.csg --combine union", 3.0),
        ("l.obj j.json m.map --combine difference", 1.0),
        ("l.obj --combine difference", 3.0),
    ] {
        let report = if volume == 0.0 {
            let empty = run(folder.path(), &format!("build {arguments} -o out.obj --report r.json"));
            assert_eq!((empty.status, empty.stderr.as_str()), (0, "warning: m.map: the result is empty\n"));
            serde_json::from_slice(&std::fs::read(folder.path().join("r.json")).expect("a report")).expect("JSON")
        } else {
            built(folder.path(), arguments)
        };
        assert_eq!(report["solid"]["volume"], json!(volume), "{arguments}");
        assert_eq!(report["mesh"]["volume"], json!(volume), "{arguments}");
    }
}

#[test]
fn the_report_names_all_inputs_and_counts_what_they_hold() {
    let folder = folder();
    inputs(folder.path());
    let report = built(folder.path(), "l.obj m.map j.json --combine difference");
    assert_eq!((&report["input"], &report["format"]), (&json!("l.obj"), &json!("obj")));
    let combine = json!({"operation": "difference", "inputs": ["l.obj", "m.map", "j.json"]});
    assert_eq!(report["combine"], combine);
    let model = &report["model"];
    assert_eq!((&model["brushes"], &model["meshes"], &model["mesh_triangles"]), (&json!(3), &json!(1), &json!(20)));
    // `stone` of both, and `default` of the model
    assert_eq!(model["materials"], json!(2));
    assert_eq!(built(folder.path(), "m.map").get("combine"), None);
}

#[test]
fn what_is_wrong_with_another_input_names_it() {
    let folder = folder();
    inputs(folder.path());
    std::fs::write(folder.path().join("open.obj"), l_shape(0.0, "stone").replace("f 6 5 4 3 2 1\n", ""))
        .expect("a file");
    run(folder.path(), "build l.obj open.obj --combine union -o out.glb").expect_error(2, "open.obj:15: the surface");
    run(folder.path(), "build l.obj none.obj --combine union -o out.glb")
        .expect_error(2, "none.obj: found no such file");
    run(folder.path(), "build l.obj m.map --combine union -o m.map").expect_error(2, "m.map: found the input");
    let whole = block([0; 3], [1; 3], "stone");
    let one_side_less =
        whole.lines().enumerate().filter(|(number, _)| *number != 6).map(|(_, line)| line.to_owned() + "\n");
    write_map(folder.path(), "u.map", &[block([5; 3], [6; 3], "stone"), one_side_less.collect()]);
    let lossy = run(folder.path(), "build l.obj u.map --combine union -o out.glb");
    assert_eq!(lossy.status, 3, "{}", lossy.stderr);
    assert!(lossy.stderr.starts_with("warning: l.obj: u.map:"), "{}", lossy.stderr);
}

/// The L twice in one object: one in the other's place but half a unit higher.
fn overlapping() -> String {
    let second = l_shape(0.5, "stone");
    let second: String = second
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(corners) => {
                let moved =
                    corners.split(' ').map(|corner| (corner.parse::<usize>().expect("a number") + 12).to_string());
                format!("f {}\n", moved.collect::<Vec<_>>().join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    l_shape(0.0, "stone") + &second
}

#[test]
fn winding_says_what_of_a_mesh_is_inside() {
    let folder = folder();
    std::fs::write(folder.path().join("o.obj"), overlapping()).expect("a file");
    for (winding, volume) in
        [("", 4.5), (" --winding positive", 4.5), (" --winding nonzero", 4.5), (" --winding odd", 3.0)]
    {
        let report = built(folder.path(), &format!("o.obj{winding}"));
        assert_eq!(report["solid"]["volume"], json!(volume), "{winding}");
        let cells = built(folder.path(), &format!("o.obj --cells{winding}"));
        assert!(agree(&cells["solid"]["volume"], volume, 1e-12), "{winding}");
        assert!(cells["solid"]["cells"].as_u64().is_some_and(|cells| cells > 1), "{cells}");
        let info = run(folder.path(), &format!("info o.obj{winding}")).json();
        assert_eq!(info["solid"]["volume"], json!(volume), "{winding}");
    }
}

#[test]
fn every_command_that_reads_meshes_joins_vertices_on_request() {
    let folder = folder();
    // one side has a corner of its own, a little off
    let loose = l_shape(0.0, "stone").replace("f 1 2 8 7\n", "v 2.001 0 0\nf 1 13 8 7\n");
    std::fs::write(folder.path().join("o.obj"), loose).expect("a file");
    std::fs::write(folder.path().join("none.jsonl"), "").expect("a file");
    for arguments in [
        "build o.obj -o a.glb",
        "build o.obj -o a.map",
        "build o.obj -o a.glb --cells",
        "coarsen o.obj -o a.glb --inner --max-cells 2",
        "render o.obj -o a.png --size 64x64 --style exploded",
        "render o.obj -o a.png --size 64x64 --section x",
        "edit o.obj none.jsonl -o a.glb --verify",
    ] {
        run(folder.path(), arguments).expect_error(2, "found 4 open edges, the first one from (");
        run(folder.path(), &format!("{arguments} --close 0.0001")).expect_error(2, "found 4 open edges");
        let closed = run(folder.path(), &format!("{arguments} --close 0.01"));
        assert_eq!(closed.status, 0, "{arguments}: {}", closed.stderr);
        assert_eq!(closed.stderr, "warning: o.obj: joined 1 vertex with others that are no farther than 0.01\n");
    }
    let info = run(folder.path(), "info o.obj --close 0.01").json();
    assert_eq!(info["solid"]["volume"], json!(3.0));
    // cells are made around what is open as well, and that is said
    for (options, words) in [("", "found 4 open edges, the first one from ("), (" --close 0.01", "joined 1 vertex")] {
        let cells = run(folder.path(), &format!("coarsen o.obj -o a.glb{options}"));
        assert_eq!(cells.status, 0, "{options}: {}", cells.stderr);
        assert!(cells.stderr.contains(words) && cells.stderr.lines().count() == 1, "{options}: {}", cells.stderr);
    }
}

#[test]
fn a_model_finds_its_meshes_in_its_own_folder() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("parts")).expect("a folder");
    std::fs::write(folder.path().join("parts/l.obj"), l_shape(0.0, "stone")).expect("a file");
    let model = r#"{"planecut": 1, "model": {"mesh": {"file": "l.obj", "scale": 2}}}"#;
    std::fs::write(folder.path().join("parts/m.json"), model).expect("a file");
    assert_eq!(built(folder.path(), "parts/m.json")["solid"]["volume"], json!(24.0));
    // standard input is in no folder: names are those of the working folder
    let words = "m.json:1: $.model.mesh.file: found \"l.obj\" (no such file), expected a file that can be read";
    std::fs::copy(folder.path().join("parts/m.json"), folder.path().join("m.json")).expect("a copy");
    run(folder.path(), "build m.json -o a.glb").expect_error(2, words);
    let piped = crate::support::run_with(&folder.path().join("parts"), "info -", model.as_bytes()).json();
    assert_eq!(piped["solid"]["volume"], json!(24.0));
}
