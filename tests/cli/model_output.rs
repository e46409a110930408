//! `-o NAME.json`: the tree of operations as a model file, which gives the same solid again.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::{ROOT, Run, agree, block, command, finish, folder, keep, planecut, run_with, write_map};

fn run_in(folder: &Path, args: &str) -> Run {
    finish(command().current_dir(folder).args(args.split(' ')))
}

fn value(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Builds an input to a model file and to GLB, and that model file to GLB: byte for byte the same, and the model file again, too.
#[track_caller]
fn assert_same_again(folder: &Path, input: &Path, options: &str) {
    let input = input.display();
    run_in(folder, &format!("build {input} -q -o a.json -o a.glb{options}"));
    run_in(folder, "build a.json -q -o b.json -o b.glb").expect_quiet_success();
    let read = |name: &str| std::fs::read(folder.join(name)).expect(name);
    assert!(read("a.glb") == read("b.glb"), "{input}");
    assert!(read("a.json") == read("b.json"), "{input}");
}

#[test]
fn a_map_as_a_model_gives_the_same_mesh() {
    let folder = folder();
    assert_same_again(folder.path(), &keep(), "");
    let model = value(&folder.path().join("a.json"));
    let brushes = planecut(["info".as_ref(), keep().as_os_str()]).json()["model"]["brushes"].clone();
    assert_eq!(json!(model["model"]["union"].as_array().expect("a union").len()), brushes);
}

#[test]
fn examples_as_models_give_the_same_meshes() {
    let folder = folder();
    for entry in std::fs::read_dir(Path::new(ROOT).join("examples")).expect("the examples") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "json") {
            assert_same_again(folder.path(), &path, "");
        }
    }
    for name in ["clamp", "x_end"] {
        assert_same_again(folder.path(), &Path::new(ROOT).join(format!("examples/csg/{name}.csg")), "");
    }
}

/// Closed meshes stay closed meshes: no triangle of the file is cut or joined.
#[test]
fn meshes_are_written_with_their_triangles() {
    let folder = folder();
    let mesh = Path::new(ROOT).join("import/tests/files/l.obj");
    assert_same_again(folder.path(), &mesh, "");
    let model = value(&folder.path().join("a.json"));
    let node = &model["model"]["union"][0];
    assert_eq!(node["name"], json!("L"));
    let triangles = node["mesh"]["triangles"].as_array().expect("triangles").len();
    assert_eq!(node["mesh"]["materials"].as_array().map(Vec::len), Some(triangles));
}

/// Where texture coordinates are written, each face has a material of its own on the way; a model file has those of the input.
#[test]
fn materials_are_those_of_the_input_whatever_else_is_written() {
    let folder = folder();
    let keep = keep();
    run_in(folder.path(), &format!("build {} -q -o a.json", keep.display()));
    run_in(folder.path(), &format!("build {} -q -o b.json -o b.glb --uv source --ids", keep.display()));
    run_in(folder.path(), &format!("build {} -q -o c.json -o c.glb --cells", keep.display()));
    run_in(folder.path(), &format!("build {} -q -o d.json -o d.glb --parts", keep.display()));
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
    for other in ["b.json", "c.json", "d.json"] {
        assert!(read("a.json") == read(other), "{other}");
    }
}

#[test]
fn edited_models_are_written_with_their_tree() {
    let folder = folder();
    let plate = r#"{"planecut": 1, "materials": {"steel": {}}, "model": {"material": "steel", "name": "plate", "difference": [
      {"box": {"min": [0, 0, 0], "max": [10, 10, 2]}}, {"box": {"min": [4, 4, -1], "max": [6, 6, 3]}, "name": "hole"}]}}"#;
    std::fs::write(folder.path().join("plate.json"), plate).expect("a folder that can be written");
    let edits = r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 12}
{"op": "add_brush", "planes": [[1,0,0,1], [-1,0,0,0], [0,1,0,1], [0,-1,0,0], [0,0,1,3], [0,0,-1,0]], "material": "brass"}
"#;
    std::fs::write(folder.path().join("e.jsonl"), edits).expect("a folder that can be written");
    run_in(folder.path(), "edit plate.json e.jsonl -o a.json -o a.glb").expect_quiet_success();
    run_in(folder.path(), "build a.json -o b.glb --report r.json").expect_quiet_success();
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
    assert!(read("a.glb") == read("b.glb"));
    let report = value(&folder.path().join("r.json"));
    assert_eq!(report["solid"]["volume"], json!(12.0 * 10.0 * 2.0 - 2.0 * 2.0 * 2.0 + 1.0));
    let model = value(&folder.path().join("a.json"));
    assert_eq!(model["materials"], json!({"steel": {}, "brass": {}}));
    assert_eq!(model["model"]["union"][0]["difference"][1]["name"], json!("hole"));
    assert_eq!(model["model"]["union"][1]["material"], json!("brass"));
    // no edits, and no file is replaced that is read
    std::fs::write(folder.path().join("none.jsonl"), "").expect("a folder that can be written");
    run_in(folder.path(), "edit plate.json none.jsonl -o plate.json").expect_error(2, "the input");
    assert_eq!(read("plate.json"), plate.as_bytes());
    run_in(folder.path(), "build plate.json -o ./plate.json").expect_error(2, "the input");
    assert_eq!(read("plate.json"), plate.as_bytes());
}

#[test]
fn models_go_through_pipes_and_scales() {
    let folder = folder();
    let cube = br#"{"planecut": 1, "model": {"difference": [{"box": {"min": [0, 0, 0], "max": [3, 3, 3]}}, {"box": {"min": [1, 1, 1], "max": [2, 2, 2]}}]}}"#;
    let first = run_with(folder.path(), "build - -o - --format json --scale 2", cube).expect_quiet_success();
    let second = run_with(folder.path(), "build - -o - --format JSON", &first.stdout).expect_quiet_success();
    assert!(first.stdout == second.stdout);
    std::fs::write(folder.path().join("a.json"), &first.stdout).expect("a folder that can be written");
    let info = run_in(folder.path(), "info a.json").json();
    assert_eq!((&info["solid"]["volume"], &info["model"]["brushes"]), (&json!(26.0 * 8.0), &json!(2)));
}

#[test]
fn cells_that_coarsen_makes_are_written_as_their_union() {
    let folder = folder();
    let box_of = |min: [i32; 3], max: [i32; 3]| json!({"box": {"min": min, "max": max}});
    let teeth = (0..4).map(|k| box_of([3 * k, 0, 1], [3 * k + 1, 2, 4]));
    let comb: Vec<Value> = teeth.chain([box_of([0, 0, 0], [10, 2, 1])]).collect();
    let comb = json!({"planecut": 1, "materials": {"wood": {}}, "model": {"union": comb, "material": "wood"}});
    std::fs::write(folder.path().join("comb.json"), comb.to_string()).expect("a folder that can be written");
    let command = "coarsen comb.json --max-cells 3 -o a.json -o a.obj -o cell-{}.json --report r.json";
    run_in(folder.path(), command).expect_quiet_success();
    let report = value(&folder.path().join("r.json"));
    let count = report["coarsen"]["cells_out"].as_u64().expect("a count") as usize;
    let cells = value(&folder.path().join("a.json"))["model"]["union"].as_array().expect("a union").clone();
    assert_eq!(cells.len(), count);
    let names: Vec<&str> = cells.iter().filter_map(|cell| cell["name"].as_str()).collect();
    assert_eq!(names, (0..count).map(|number| format!("cell {number}")).collect::<Vec<_>>());
    let info = run_in(folder.path(), "info a.json").json();
    assert_eq!((&info["model"]["brushes"], &info["model"]["unbounded_brushes"]), (&json!(count), &json!(0)));
    for (number, cell) in cells.iter().enumerate() {
        let alone = value(&folder.path().join(format!("cell-{number}.json")));
        assert_eq!(alone["model"]["union"], json!([cell]), "{number}");
    }
    assert!(cells.iter().all(|cell| cell["material"] == json!("wood")));
    // around the whole comb
    assert!(info["solid"]["volume"].as_f64().is_some_and(|volume| volume > 10.0 * 2.0 + 4.0 * 6.0));
}

/// What a map lacks in its mesh, its model lacks, too: a model may have brushes without end.
#[test]
fn brushes_of_maps_that_are_not_bounded_are_left_out() {
    let folder = folder();
    let whole = block([0, 0, 0], [4, 4, 4], "stone");
    let open = block([8, 0, 0], [9, 1, 1], "stone");
    // without its last face
    let lines: Vec<&str> = open.lines().collect();
    let open = format!("{}\n}}\n", lines[..lines.len() - 2].join("\n"));
    write_map(folder.path(), "m.map", &[whole, open]);
    assert_eq!(run_in(folder.path(), "build m.map -o a.json").status, 3);
    let info = run_in(folder.path(), "info a.json").json();
    assert_eq!(info["model"]["brushes"], json!(1));
    assert!(agree(&info["solid"]["volume"], 64.0, 1e-12));
}
