//! Edits on the command line: what is written is what the edited model would be, and bad edits leave nothing behind.

use std::path::Path;

use planecut_testkit::data::data;
use serde_json::{Value, json};

use crate::support::{Run, agree, block, command, everything_in, finish, folder, write_map};

/// A block of 10 × 10 × 2 with a hole of 2 × 2.
const PLATE: &str = r#"{"planecut": 1, "materials": {"steel": {}}, "model": {"material": "steel", "difference": [
  {"box": {"min": [0, 0, 0], "max": [10, 10, 2]}}, {"box": {"min": [4, 4, -1], "max": [6, 6, 3]}}]}}"#;

/// Runs `edit plate.json edits.jsonl` with more arguments.
fn edit(folder: &Path, edits: &str, arguments: &str) -> Run {
    std::fs::write(folder.join("plate.json"), PLATE).expect("a folder that can be written");
    std::fs::write(folder.join("edits.jsonl"), edits).expect("a folder that can be written");
    finish(command().current_dir(folder).args(["edit", "plate.json", "edits.jsonl"]).args(arguments.split(' ')))
}

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("r.json")).expect("a report")).expect("JSON")
}

#[test]
fn edits_are_done_one_after_another() {
    let folder = folder();
    // the plate half as long, a corner cut off and back, the hole turned by hand, a peg, and one edit that is undone
    let edits = r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 5}
{"op": "add_plane", "brush": 0, "plane": [-1, -1, 0, -4]}
{"op": "remove_plane", "brush": 0, "plane": 6}

{"op": "transform_brush", "brush": 1, "matrix": [[1,0,0,-2],[0,1,0,0],[0,0,1,0]]}
{"op": "add_brush", "planes": [[1,0,0,1], [-1,0,0,0], [0,1,0,1], [0,-1,0,0], [0,0,1,3], [0,0,-1,0]], "material": "brass"}
{"op": "remove_brush", "brush": 1}
{"op": "undo"}
{"op": "set_role", "brush": 1, "role": "add"}
{"op": "undo"}
{"op": "redo"}
{"op": "undo"}
"#;
    edit(folder.path(), edits, "-o a.obj -o a.glb --verify --report r.json").expect_quiet_success();
    let found = report(folder.path());
    assert_eq!(found["solid"]["volume"], json!(5.0 * 10.0 * 2.0 - 2.0 * 2.0 * 2.0 + 1.0));
    assert_eq!((&found["model"]["brushes"], &found["model"]["materials"]), (&json!(3), &json!(2)));
    let edit = &found["edit"];
    assert_eq!((&edit["edits"], &edit["same_as_fresh"]), (&json!(11), &json!(true)));
    assert!(["median_ms", "p99_ms", "fresh_ms"].iter().all(|key| edit[key].as_f64().is_some_and(|ms| ms > 0.0)));
    // the same as a model
    let model = r#"{"planecut": 1, "materials": {"steel": {}, "brass": {}}, "model": {"union": [
      {"material": "steel", "difference": [{"box": {"min": [0, 0, 0], "max": [5, 10, 2]}},
        {"box": {"min": [2, 4, -1], "max": [4, 6, 3]}}]},
      {"material": "brass", "box": {"min": [0, 0, 0], "max": [1, 1, 3]}}]}}"#;
    std::fs::write(folder.path().join("m.json"), model).expect("a folder that can be written");
    finish(command().current_dir(folder.path()).args("build m.json -o b.obj -o b.glb".split(' ')))
        .expect_quiet_success();
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
    assert!(read("a.glb") == read("b.glb"));
    assert!(read("a.obj") == read("b.obj"));
}

/// Without `--verify` and `--report` the mesh is that of the live model and no fresh build is made: nothing that is written or said may differ.
#[test]
fn outputs_and_warnings_do_not_depend_on_the_comparison() {
    let names = ["a.glb", "a.obj", "a.stl", "a.csg", "a.map"];
    let outputs = names.map(|name| format!("-o {name}")).join(" ");
    let cases = [
        (r#"{"op": "add_plane", "brush": 0, "plane": [1, 2, 3, 9]}"#, 192.0),
        (r#"{"op": "move_plane", "brush": 1, "plane": 0, "offset": 2}"#, 200.0),
        (r#"{"op": "remove_brush", "brush": 0}"#, 0.0),
    ];
    for (edits, largest) in cases {
        let written = |arguments: &str| {
            let folder = folder();
            let run = edit(folder.path(), edits, &format!("{outputs}{arguments}"));
            assert_eq!(run.status, 0, "{}", run.stderr);
            let files = names.map(|name| std::fs::read(folder.path().join(name)).expect(name));
            (files, run.stderr, arguments.contains("--report").then(|| report(folder.path())))
        };
        let (expected, warnings, _) = written("");
        for arguments in [" --verify", " --report r.json", " --verify --report r.json"] {
            let (files, stderr, report) = written(arguments);
            assert!(files == expected, "{edits}{arguments}");
            assert_eq!(stderr, warnings, "{edits}{arguments}");
            assert!(
                report.is_none_or(|report| report["solid"]["volume"].as_f64().is_some_and(|volume| volume <= largest))
            );
        }
    }
}

#[test]
fn no_edits_leave_the_model_as_it_is() {
    let folder = folder();
    edit(folder.path(), "", "-o a.stl --report r.json").expect_quiet_success();
    let found = report(folder.path());
    assert_eq!((&found["solid"]["volume"], &found["edit"]["edits"]), (&json!(192.0), &json!(0)));
    assert_eq!((&found["edit"]["median_ms"], &found["edit"]["same_as_fresh"]), (&Value::Null, &json!(true)));
}

#[test]
fn bad_edits_are_one_error_and_leave_nothing() {
    let fine = r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 8}"#;
    let cases = [
        (r#"{"op": "remove_brush", "brush": 7}"#, 1, "found brush 7, expected"),
        (r#"{"op": "remove_plane", "brush": 0, "plane": 6}"#, 1, "found plane 6 of brush 0, expected"),
        (r#"{"op": "remove_plane", "brush": 0, "plane": 1}"#, 1, "found a solid that reaches infinity, expected"),
        (r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 1e300}"#, 1, "found a plane at offset 1e300"),
        (r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 1e999}"#, 2, "number out of range"),
        (r#"{"op": "redo"}"#, 1, "found nothing to do again, expected"),
        (r#"{"op": "add_plane", "brush": 0, "plane": [0, 0, 0, 1]}"#, 2, "found plane [0.0, 0.0, 0.0, 1.0], expected"),
        (r#"{"op": "transform_brush", "brush": 0, "matrix": [[1e300,0,0,0],[0,1,0,0],[0,0,1,0]]}"#, 2, "matrix"),
        ("{", 2, "EOF while parsing"),
        ("[1, 2]", 2, "expected an edit"),
    ];
    for (bad, status, words) in cases {
        let folder = folder();
        let run = edit(folder.path(), &format!("{fine}\n\n{bad}\n{fine}\n"), "-o out/a.glb --report r.json");
        run.expect_error(status, words);
        run.expect_error(status, "edits.jsonl:3: ");
        assert_eq!(everything_in(folder.path()), ["edits.jsonl", "plate.json"], "{bad}");
    }
    let folder = folder();
    edit(folder.path(), fine, "-o edits.jsonl.obj -o edits.jsonl").expect_error(2, "edits.jsonl: found");
    finish(command().current_dir(folder.path()).args("edit plate.json none.jsonl -o a.glb".split(' ')))
        .expect_error(2, "none.jsonl: found no such file");
}

#[test]
fn an_emptied_brush_is_no_error_and_comes_back() {
    let folder = folder();
    let emptied = r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": -8}"#;
    let run = edit(folder.path(), emptied, "-o a.glb --verify --report r.json");
    assert_eq!((run.status, run.stderr.contains("the result is empty")), (0, true), "{}", run.stderr);
    assert_eq!(report(folder.path())["mesh"]["triangles"], json!(0));
    edit(folder.path(), &format!("{emptied}\n{{\"op\": \"undo\"}}"), "-o a.glb --verify --report r.json")
        .expect_quiet_success();
    assert_eq!(report(folder.path())["solid"]["volume"], json!(192.0));
}

#[test]
fn brushes_of_a_map_that_lose_their_end_are_left_out() {
    let folder = folder();
    write_map(folder.path(), "m.map", &[block([0; 3], [2; 3], "a"), block([1; 3], [4; 3], "b")]);
    std::fs::write(folder.path().join("e.jsonl"), r#"{"op": "remove_plane", "brush": 1, "plane": 5}"#).expect("a file");
    for arguments in ["edit m.map e.jsonl -o b.glb", "edit m.map e.jsonl -o a.glb --verify --report r.json"] {
        let run = finish(command().current_dir(folder.path()).args(arguments.split(' ')));
        let is_left_out = run.stderr.contains("left out a brush that is not bounded");
        assert_eq!((run.status, is_left_out), (3, true), "{}", run.stderr);
    }
    assert_eq!(report(folder.path())["solid"]["volume"], json!(8.0));
}

planecut_testkit::tests_on_data!(edits_of_a_shared_map_give_the_mesh_of_a_fresh_build);

fn edits_of_a_shared_map_give_the_mesh_of_a_fresh_build() {
    let map = data("map/spacehare/64u_rabbit.map");
    let folder = folder();
    let mut edits = String::new();
    for k in 0..20 {
        let brush = 19 * k;
        edits += &format!(
            "{{\"op\": \"add_plane\", \"brush\": {brush}, \"plane\": [{}, 1, 0.5, {}]}}\n",
            k - 10,
            8 * k - 80
        );
        edits += &format!(
            "{{\"op\": \"transform_brush\", \"brush\": {brush}, \"matrix\": [[1,0,0,{k}],[0,1,0,-3],[0,0,1,2]]}}\n"
        );
        edits += if k % 3 == 0 { "{\"op\": \"undo\"}\n" } else { "" };
    }
    std::fs::write(folder.path().join("e.jsonl"), edits).expect("a file");
    let arguments = "e.jsonl -o a.glb --verify --quiet --report r.json";
    let run = finish(command().current_dir(folder.path()).arg("edit").arg(&map).args(arguments.split(' ')));
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let found = report(folder.path());
    let volume = found["mesh"]["volume"].as_f64().expect("a volume");
    assert!(agree(&found["solid"]["volume"], volume, 1e-9), "{found}");
    assert_eq!((&found["edit"]["edits"], &found["mesh"]["manifold"]), (&json!(47), &json!(true)));
}
