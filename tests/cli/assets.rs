//! What may be asked of meshes, from the command line.

use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use serde_json::{Value, json};

use crate::support::{ROOT, Run, command, everything_in, finish, folder};

const CUPBOARD: &str = r#"{"planecut": 1, "materials": {"oak": {"color": [0.5, 0.3, 0.1]}}, "model": {"union": [
    {"box": {"min": [0, 0, 0], "max": [8, 1, 8]}, "material": "oak"},
    {"name": "knob", "union": [{"box": {"min": [10, 0, 0], "max": [11, 1, 1]}}, {"box": {"min": [10, 0, 1], "max": [11, 2, 2]}}]},
    {"name": "knob", "union": [{"box": {"min": [20, 0, 0], "max": [21, 1, 1]}}, {"box": {"min": [20, 0, 1], "max": [21, 2, 2]}}]},
    {"name": "door", "difference": [{"box": {"min": [0, 2, 0], "max": [8, 3, 8]}}, {"box": {"min": [2, 1, 2], "max": [6, 4, 6]}}]}
]}}"#;

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("written");
}

fn run(folder: &Path, args: &str) -> Run {
    finish(command().current_dir(folder).args(args.split_whitespace()))
}

/// The JSON of a binary glTF file.
fn json_of(path: &Path) -> Value {
    let bytes = std::fs::read(path).expect("there");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).expect("JSON")
}

#[test]
fn parts_are_nodes_and_copies_share_a_mesh() {
    let folder = folder();
    write(folder.path(), "c.json", CUPBOARD);
    run(folder.path(), "build c.json -o c.glb --parts --report r").expect_quiet_success();
    let gltf = json_of(&folder.path().join("c.glb"));
    let nodes: Vec<&Value> = gltf["nodes"].as_array().expect("nodes").iter().map(|node| &node["name"]).collect();
    assert_eq!(nodes, ["planecut root", "solid", "knob", "knob", "door"]);
    assert_eq!(gltf["meshes"].as_array().map(Vec::len), Some(3));
    assert_eq!(gltf["nodes"][2]["mesh"], gltf["nodes"][3]["mesh"]);
    let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("r")).expect("r")).expect("JSON");
    assert_eq!((&report["mesh"]["components"], &report["mesh"]["genus"]), (&json!(4), &json!(1)));
    let clash = run(folder.path(), "build c.json -o c.glb --parts --cells");
    assert_eq!(clash.status, 2, "either parts or cells");
}

#[test]
fn options_reach_the_file() {
    let folder = folder();
    write(folder.path(), "c.json", CUPBOARD);
    let gltf = |options: &str| {
        run(folder.path(), &format!("build c.json -o c.glb {options}")).expect_quiet_success();
        json_of(&folder.path().join("c.glb"))
    };
    let attributes = |gltf: &Value| -> Vec<String> {
        let attributes = gltf["meshes"][0]["primitives"][0]["attributes"].as_object().expect("attributes");
        attributes.keys().cloned().collect()
    };
    assert_eq!(attributes(&gltf("")), ["NORMAL", "POSITION"]);
    assert_eq!(attributes(&gltf("--uv box --tangents")), ["NORMAL", "POSITION", "TANGENT", "TEXCOORD_0"]);
    assert_eq!(attributes(&gltf("--vertex-colors")), ["COLOR_0", "NORMAL", "POSITION"]);
    let metres = gltf("--unit mm --scale 2");
    assert_eq!(metres["nodes"][0]["scale"], json!([0.002, 0.002, 0.002]));
    let required = gltf("--quantize --meshopt")["extensionsRequired"].clone();
    assert_eq!(required, json!(["KHR_mesh_quantization", "EXT_meshopt_compression"]));
    let faces = gltf("--ids")["meshes"][0]["primitives"][0]["extras"]["faces"].clone();
    assert!(faces.as_array().is_some_and(|faces| faces.len() == 6), "{faces}: those of the box of oak");
    for refused in ["--tangents", "--uv-size 2", "--uv all", "--unit mile"] {
        assert_eq!(run(folder.path(), &format!("build c.json -o d.glb {refused}")).status, 2, "{refused}");
    }
    for refused in ["--smooth 200", "--uv box --uv-size 0"] {
        let refused = run(folder.path(), &format!("build c.json -o d.glb {refused}"));
        assert!(refused.status != 0 && refused.stderr.starts_with("error: "), "{}", refused.stderr);
    }
    for refused in ["--ids", "--uv source"] {
        let run = run(folder.path(), &format!("coarsen c.json -o d.glb {refused}"));
        run.expect_error(2, "expected it with build");
    }
    assert!(!folder.path().join("d.glb").exists());
}

#[test]
fn materials_of_obj_have_a_file_of_their_own_on_request() {
    let folder = folder();
    write(folder.path(), "c.json", CUPBOARD);
    run(folder.path(), "build c.json -o c.obj --mtl").expect_quiet_success();
    assert_eq!(everything_in(folder.path()), ["c.json", "c.mtl", "c.obj"]);
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("there");
    assert!(text("c.obj").contains("\nmtllib c.mtl\n") && text("c.mtl").contains("newmtl oak\n"));
    assert_eq!(run(folder.path(), "build c.json -o c.obj -o c.mtl --mtl").status, 2);
}

/// However far the work has come when it is killed, what is in the folder is whole.
#[test]
fn a_killed_process_leaves_nothing_half_written() {
    let folder = folder();
    let mut whole = 0;
    for milliseconds in [0, 20, 60, 120, 200, 300, 450, 700] {
        let place = folder.path().join(milliseconds.to_string());
        std::fs::create_dir(&place).expect("made");
        let mut child = command()
            .args(["build", &format!("{ROOT}/examples/gear.json"), "-o", "g.glb", "-o", "g.obj", "-o", "g.3mf", "-q"])
            .current_dir(&place)
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        std::thread::sleep(Duration::from_millis(milliseconds));
        child.kill().expect("killed");
        child.wait().expect("waited");
        for name in everything_in(&place) {
            if name.starts_with(".planecut-") {
                // between its name for the rename and the rename: whole, but not where it belongs
                continue;
            }
            assert!(["g.glb", "g.obj", "g.3mf"].contains(&name.as_str()), "{name}");
            whole += 1;
            let length = std::fs::metadata(place.join(&name)).expect("there").len();
            let known = folder.path().join(&name);
            match std::fs::read(&known) {
                Ok(bytes) => assert_eq!(bytes.len() as u64, length, "{name} at {milliseconds} ms"),
                Err(_) => {
                    std::fs::copy(place.join(&name), known).expect("copied");
                }
            }
        }
    }
    println!("{whole} files were complete");
}
