//! Model files on the command line: from a file, from standard input, with other parameters, as skin and as cells.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::support::{Run, agree, block, command, finish, folder, planecut, run_with, write_map};

/// A plate with a hole: 10 × 10 × 2 without 2 × 2 × 2, two cubes wide where `n` is 2.
const PLATE: &str = r#"{
  "planecut": 1,
  "materials": {"steel": {"color": [0.5, 0.5, 0.6], "metallic": 1, "roughness": 0.25}},
  "parameters": {"width": 10, "hole": "=width / 5"},
  "model": {
    "material": "steel",
    "difference": [
      {"box": {"min": [0, 0, 0], "max": ["=width", 10, 2]}},
      {"box": {"min": [4, 4, -1], "max": ["=4 + hole", 6, 3]}}
    ]
  }
}
"#;

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a folder that can be written");
    path
}

fn run(folder: &Path, args: &str) -> Run {
    finish(command().current_dir(folder).args(args.split(' ')))
}

/// The report on a text.
fn info(text: &str) -> Value {
    let folder = folder();
    write(folder.path(), "m.json", text);
    run(folder.path(), "info m.json").json()
}

fn model(node: &str) -> String {
    format!("{{\"planecut\": 1, \"model\": {node}}}")
}

#[test]
fn a_model_is_built_from_a_file_and_from_standard_input() {
    let folder = folder();
    write(folder.path(), "plate.json", PLATE);
    run(folder.path(), "build plate.json -o a.glb -o a.obj -o a.stl --report a.rep").expect_quiet_success();
    run_with(folder.path(), "build - -o b.glb -o b.obj -o b.stl --report b.rep", PLATE.as_bytes())
        .expect_quiet_success();
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
    for format in ["glb", "obj", "stl"] {
        assert!(read(&format!("a.{format}")) == read(&format!("b.{format}")), "{format}");
    }
    for (name, input) in [("a.rep", "plate.json"), ("b.rep", "-")] {
        let report: Value = serde_json::from_slice(&read(name)).expect("JSON");
        assert_eq!((&report["input"], &report["format"]), (&json!(input), &json!("json")));
        assert_eq!((&report["solid"]["volume"], &report["solid"]["cells"]), (&json!(192.0), &Value::Null));
        assert_eq!(report["mesh"]["genus"], json!(1));
        assert_eq!(report["warnings"], json!([]));
    }
    run(folder.path(), "render plate.json -o a.png --size 64x48").expect_quiet_success();
    run_with(folder.path(), "render - -o b.png --size 64x48", PLATE.as_bytes()).expect_quiet_success();
    assert!(read("a.png") == read("b.png"));
}

#[test]
fn materials_reach_the_file() {
    let folder = folder();
    write(folder.path(), "plate.json", PLATE);
    let glb = run(folder.path(), "build plate.json -o - --format gltf");
    let document: Value = glb.json();
    let material = &document["materials"][0];
    assert_eq!(material["name"], json!("steel"));
    let factors = &material["pbrMetallicRoughness"];
    assert_eq!(factors["baseColorFactor"], json!([0.5, 0.5, 0.6, 1.0]));
    // 1 is the default, which may be left out.
    assert_ne!(factors["metallicFactor"], json!(0.0));
    assert_eq!(factors["roughnessFactor"], json!(0.25));
}

#[test]
fn parameters_are_set_and_others_follow() {
    let folder = folder();
    write(folder.path(), "plate.json", PLATE);
    let volume = |args: &str| run(folder.path(), &format!("info plate.json{args}")).json()["solid"]["volume"].clone();
    assert_eq!(volume(" --set width=15"), json!(288.0));
    assert_eq!(volume(" --set width=15 --set hole=1"), json!(296.0));
    assert_eq!(volume(" --set width=15 --set width=10"), json!(192.0), "the last one counts");
    let refused = run(folder.path(), "info plate.json --set wdith=15");
    refused.expect_error(
        2,
        "plate.json: found a value for the parameter `wdith`, expected one of its parameters: width, hole",
    );
}

#[test]
fn errors_name_line_and_place() {
    let folder = folder();
    write(folder.path(), "m.json", &PLATE.replace("\"=4 + hole\"", "\"=4 + hoel\""));
    run(folder.path(), "build m.json -o m.glb").expect_error(
        2,
        "m.json:9: $.model.difference[1].box.max[0]: found `hoel` in the expression \"=4 + hoel\", expected a parameter of this file",
    );
    assert!(!folder.path().join("m.glb").exists());
    let error = run_with(folder.path(), "info -", b"{\"planecut\": 1}");
    error.expect_error(2, "standard input:1: $: found an object with planecut, expected the key `model` as well");
    run_with(folder.path(), "info -", b"").expect_error(2, "standard input:1: $: found the end of the file");
    run(folder.path(), "info n.json").expect_error(2, "n.json: found no such file");
    std::fs::create_dir(folder.path().join("d.json")).expect("made");
    run(folder.path(), "info d.json").expect_error(2, "d.json: found a folder");
}

#[test]
fn an_unbounded_result_is_an_error_only_where_there_is_one() {
    let folder = folder();
    write(folder.path(), "m.json", &model(r#"{"complement": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#));
    for command in ["build m.json -o m.glb", "build m.json -o m.glb --cells", "info m.json", "render m.json -o m.png"] {
        run(folder.path(), command)
            .expect_error(1, "m.json: found a solid that reaches infinity, expected one that is bounded");
    }
    assert!(!folder.path().join("m.glb").exists());
    let half = info(&model(
        r#"{"intersection": [{"box": {"min": [0, 0, 0], "max": [2, 2, 2]}}, {"halfspaces": [[1, 1, 0, 2]]}]}"#,
    ));
    assert_eq!((&half["solid"]["volume"], &half["warnings"]), (&json!(4.0), &json!([])));
    assert_eq!(half["model"]["unbounded_brushes"], json!(1));
}

#[test]
fn an_empty_result_is_a_result() {
    let folder = folder();
    let cube = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;
    write(folder.path(), "m.json", &model(&format!("{{\"difference\": [{cube}, {cube}]}}")));
    for cells in ["", " --cells"] {
        let run =
            run(folder.path(), &format!("build m.json -o m.glb -o m.obj -o m.stl --preview m.png --report r{cells}"));
        assert_eq!((run.status, run.stderr.as_str()), (0, "warning: m.json: the result is empty\n"));
        let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("r")).expect("r")).expect("JSON");
        let expected = json!({
            "vertices": 0, "triangles": 0, "faces": 0, "components": 0, "genus": 0, "watertight": true, "manifold": true,
            "volume": 0.0
        });
        assert_eq!((&report["mesh"], &report["solid"]["volume"]), (&expected, &json!(0.0)));
        assert_eq!(report["solid"]["cells"], if cells.is_empty() { Value::Null } else { json!(0) });
        assert!(["m.glb", "m.obj", "m.stl", "m.png"].iter().all(|name| folder.path().join(name).is_file()));
    }
}

#[test]
fn cells_are_written_one_by_one() {
    let folder = folder();
    write(folder.path(), "plate.json", PLATE);
    run(folder.path(), "build plate.json -o c.gltf -o c.obj -o c.stl --cells --report r").expect_quiet_success();
    let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("r")).expect("r")).expect("JSON");
    let cells = report["solid"]["cells"].as_u64().expect("a count");
    assert_eq!(cells, 4, "a frame around a square hole");
    assert_eq!((&report["solid"]["volume"], &report["mesh"]["volume"]), (&json!(192.0), &json!(192.0)));
    assert_eq!((&report["mesh"]["components"], &report["mesh"]["vertices"]), (&json!(4), &json!(32)));
    assert_eq!((&report["mesh"]["watertight"], &report["mesh"]["manifold"]), (&json!(true), &json!(true)));
    let gltf: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("c.gltf")).expect("there")).expect("JSON");
    assert_eq!(gltf["meshes"].as_array().map(Vec::len), Some(3), "two of the four are alike but for their place");
    assert_eq!(gltf["nodes"].as_array().map(Vec::len), Some(5), "a root and one for each cell");
    let obj = std::fs::read_to_string(folder.path().join("c.obj")).expect("there");
    assert_eq!(obj.lines().filter(|line| line.starts_with("o ")).count(), 4);
    let mesh = run(folder.path(), "info c.obj").json()["mesh"].clone();
    assert_eq!((&mesh["watertight"], &mesh["manifold"], &mesh["components"]), (&json!(true), &json!(true), &json!(4)));
}

#[test]
fn cells_of_a_map_leave_out_what_is_unbounded() {
    let folder = folder();
    let unit = block([0; 3], [1; 3], "stone");
    let unbounded: Vec<&str> = unit.lines().filter(|line| !line.contains("( 1 1 1 )")).collect();
    let brushes = [block([0; 3], [2; 3], "stone"), block([1; 3], [3; 3], "stone"), unbounded.join("\n") + "\n"];
    let map = write_map(folder.path(), "m.map", &brushes);
    run(folder.path(), "build m.map -o m.obj --cells --report r -q --allow-loss").expect_quiet_success();
    let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("r")).expect("r")).expect("JSON");
    assert!(agree(&report["solid"]["volume"], 15.0, 1e-15), "{report}");
    assert!(report["solid"]["cells"].as_u64() >= Some(2));
    let text = std::fs::read(&map).expect("there");
    let piped = run_with(folder.path(), "info - --input-format map -q --allow-loss", &text).json();
    assert_eq!((&piped["format"], &piped["input"]), (&json!("map"), &json!("-")));
    assert_eq!(piped["solid"]["volume"], json!(15.0));
}

#[test]
fn what_is_doubtful_is_a_warning() {
    let folder = folder();
    let flat = r#"{"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}"#;
    let cube = r#"{"material": "stome", "box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;
    write(folder.path(), "m.json", &model(&format!("{{\"union\": [\n{flat},\n{cube}]}}")));
    let run = planecut(["info".as_ref(), folder.path().join("m.json").as_os_str()]);
    let warnings = run.json()["warnings"].clone();
    assert_eq!(
        warnings,
        json!([
            "line 3: the file defines no material `stome`; its colour is made up",
            "line 2: the hull of the points has no interior: they lie on a plane"
        ])
    );
    assert_eq!(run.stderr.lines().count(), 2);
}
