//! `build --blocks` and `--tiles`: the same solid as at once, from a stream, with what is up to date kept.

use std::fs;
use std::path::Path;

use planecut_testkit::data::data;
use serde_json::{Value, json};

use crate::support::{Run, agree, command, everything_in, files_below, finish, folder, keep, planecut, run_with};

/// Towers in rows, with a hall cut through all of them.
const CITY: &str = r#"{"planecut": 1, "materials": {"stone": {"color": [0.5, 0.5, 0.45]}, "brick": {}}, "model": {"difference": [
    {"union": [
        {"material": "stone", "array": {"of": {"box": {"min": [0, 0, 0], "max": [3, 3, 8]}}, "count": [20, 16, 1], "step": [4, 4, 0]}},
        {"material": "brick", "array": {"of": {"cylinder": {"height": 10, "radius": 1.25, "segments": 9}}, "count": [20, 16, 1], "step": [4, 4, 0]}},
        {"material": "stone", "box": {"min": [-1, -1, -1], "max": [81, 65, 0.5]}}
    ]},
    {"material": "brick", "box": {"min": [-2, 29.5, 0.25], "max": [90, 30.5, 4]}}
]}}"#;

/// Runs the program in a folder.
fn run(folder: &Path, args: &str) -> Run {
    finish(command().current_dir(folder).args(args.split(' ')))
}

fn json_of(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("a file")).expect("JSON")
}

/// Builds an input at once and in blocks, and compares what the reports say and whether the meshes are sound; gives the number of blocks.
#[track_caller]
fn compare(input: &Path, brushes: usize) -> u64 {
    let folder = folder();
    let build = |name: &str, more: &[&str]| {
        let (mesh, report) = (folder.path().join(format!("{name}.ply")), folder.path().join(format!("{name}.json")));
        let args = [
            "build".as_ref(),
            input.as_os_str(),
            "-o".as_ref(),
            mesh.as_os_str(),
            "--report".as_ref(),
            report.as_os_str(),
        ];
        let run = finish(command().args(args).args(more));
        (run.status, run.stderr, report, mesh)
    };
    let (status, warnings, report, at_once) = build("whole", &[]);
    let whole = json_of(&report);
    let (of_blocks, told, report, mesh) = build("blocks", &[&format!("--blocks={brushes}")]);
    let blocks = json_of(&report);
    assert_eq!(of_blocks, status, "{}: {told}", input.display());
    let name = input.display();
    for part in ["volume", "area"] {
        let expected = whole["solid"][part].as_f64().expect("a number");
        assert!(agree(&blocks["solid"][part], expected, 1e-9), "{name}: {part} {} {expected}", blocks["solid"]);
    }
    let expected = whole["mesh"]["volume"].as_f64().expect("a number");
    assert!(agree(&blocks["mesh"]["volume"], expected, 1e-9), "{name}: {}", blocks["mesh"]);
    for axis in 0..3 {
        assert_eq!(blocks["solid"]["min"][axis], whole["solid"]["min"][axis], "{name}");
        assert_eq!(blocks["solid"]["max"][axis], whole["solid"]["max"][axis], "{name}");
    }
    for part in ["brushes", "empty_brushes", "materials", "unbounded_brushes", "redundant_planes"] {
        assert_eq!(blocks["model"][part], whole["model"][part], "{name}: {part}");
    }
    // each thing that is left out is warned of alike
    assert_eq!(told.lines().count(), warnings.lines().count(), "{told}\n{warnings}");
    // watertight by its indices, and as sound as what is built at once
    let check = |mesh: &Path| planecut(["check".as_ref(), mesh.as_os_str()]);
    if check(&at_once).status == 0 {
        let sound = check(&mesh);
        // where the solid touches itself along an edge between two walls, indices name that edge for both: docs/scale.md
        let is_doubled = sound.stderr.contains("is used 2 times in each direction");
        assert!(sound.status == 0 || is_doubled, "{name}: {}", sound.stderr);
    }
    blocks["blocks"]["count"].as_u64().expect("a number")
}

#[test]
fn examples_are_the_same_in_blocks() {
    let folder = folder();
    let city = folder.path().join("city.json");
    fs::write(&city, CITY).expect("written");
    assert!(compare(&city, 40) > 8);
    assert!(compare(&keep(), 20) > 3);
}

planecut_testkit::tests_on_data!(maps_are_the_same_in_blocks, trees_of_openscad_are_the_same_in_blocks);

fn maps_are_the_same_in_blocks() {
    let mut blocks = 0;
    let wanted = ["e1m1.map", "e2m7.map", "mfxsp20.map", "retrojam1_ericw.map", "dm1.map", "end.map", "64u_rabbit.map"];
    for (name, _) in files_below(&data("map")) {
        if wanted.iter().any(|wanted| name.ends_with(wanted)) {
            blocks += compare(&data("map").join(name), 60);
        }
    }
    assert!(blocks > 300, "{blocks}");
}

fn trees_of_openscad_are_the_same_in_blocks() {
    let mut compared = 0;
    for (name, _) in files_below(&data("csg")).iter().filter(|(name, _)| name.ends_with(".csg")) {
        let tree = data("csg").join(name);
        let report = planecut(["info".as_ref(), tree.as_os_str()]);
        let Ok(report) = serde_json::from_slice::<Value>(&report.stdout) else { continue };
        let is_convex = report["model"]["meshes"] == json!(0) && report["model"]["brushes"].as_u64() < Some(4000);
        if is_convex && report["model"]["brushes"].as_u64() > Some(20) {
            // sheets without end are used as tools there
            if run(Path::new("."), &format!("build {} -o - --format stl --blocks -q", tree.display())).status == 1 {
                continue;
            }
            compare(&tree, 15);
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn the_same_bytes_come_of_any_number_of_threads() {
    let folder = folder();
    fs::write(folder.path().join("city.json"), CITY).expect("written");
    let outputs = ["a.glb", "a.stl", "a.ply", "a.obj"];
    for (threads, name) in [(1, "one"), (3, "three")] {
        let outputs = outputs.map(|output| format!("-o {name}/{output}")).join(" ");
        let args = format!("build city.json {outputs} --blocks=50 --mtl --threads {threads} --tiles {name}/tiles");
        run(folder.path(), &args).expect_quiet_success();
    }
    let [one, three] = ["one", "three"].map(|name| files_below(&folder.path().join(name)));
    assert!(one.len() > 10, "{}", one.len());
    assert_eq!(one, three);
}

#[test]
fn what_is_up_to_date_in_the_work_folder_is_not_evaluated_again() {
    let folder = folder();
    let city = folder.path().join("city.json");
    fs::write(&city, CITY).expect("written");
    let build = |output: &str| {
        let args = format!("build city.json -o {output} --blocks=50 --work-dir work");
        run(folder.path(), &args).expect_quiet_success();
    };
    build("first.ply");
    let pieces = folder.path().join("work/pieces");
    let times = || -> Vec<_> {
        let mut times: Vec<_> = fs::read_dir(&pieces)
            .expect("a folder")
            .map(|entry| entry.expect("an entry"))
            .map(|entry| (entry.file_name(), entry.metadata().expect("asked").modified().expect("a time")))
            .collect();
        times.sort();
        times
    };
    let before = times();
    assert!(before.len() > 8);
    // one is damaged, another gone
    let path = |k: usize| pieces.join(&before[k].0);
    let bytes = fs::read(path(0)).expect("a piece");
    fs::write(path(0), &bytes[..bytes.len() / 2]).expect("written");
    fs::write(path(2), b"").expect("written");
    fs::remove_file(path(1)).expect("removed");
    build("second.ply");
    let after = times();
    let again: Vec<usize> = (0..before.len()).filter(|k| before[*k] != after[*k]).collect();
    assert_eq!(again, [0, 1, 2]);
    let [first, second] = ["first.ply", "second.ply"].map(|name| fs::read(folder.path().join(name)).expect("a mesh"));
    assert!(first == second);
    // of a model that changes in one place, some blocks
    fs::write(&city, CITY.replace("[90, 30.5, 4]", "[90, 30.5, 5]")).expect("written");
    build("third.ply");
    let kept = times().iter().zip(&after).filter(|(now, before)| now == before).count();
    assert!(kept > 2 && kept < after.len(), "{kept} of {}", after.len());
}

#[test]
fn the_limit_on_pieces_holds_in_blocks_where_it_is_stated() {
    let folder = folder();
    // more brushes than a model that is held may have by default
    let text = r#"{"planecut": 1, "model": {"array": {"of": {"box": {"min": [0, 0, 0], "max": [0.5, 0.5, 0.5]}}, "count": [1100, 1000, 1], "step": [1, 1, 0]}}}"#;
    run_with(folder.path(), "build - -o a.stl --report r.json", text.as_bytes()).expect_error(2, "at most 1048576");
    let report = "build - -o a.stl --blocks=30000 --report r.json --max-pieces 1000";
    run_with(folder.path(), report, text.as_bytes()).expect_error(2, "at most 1000");
    assert!(everything_in(folder.path()).is_empty(), "{:?}", everything_in(folder.path()));
}

#[test]
fn what_cannot_be_done_in_blocks_is_one_error() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("box.json", r#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#);
    write("half.json", "{\"planecut\": 1, \"model\": {\"union\": [\n{\"halfspaces\": [[1, 0, 0, 1]]}]}}");
    write("outside.json", r#"{"planecut": 1, "model": {"complement": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}}"#);
    let tetrahedron = r#"{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]}"#;
    write("mesh.json", &format!("{{\"planecut\": 1, \"model\":\n\n{{\"mesh\": {tetrahedron}}}}}"));
    fs::create_dir(folder.path().join("taken")).expect("made");
    write("taken/mine.txt", "mine");
    let before = everything_in(folder.path());
    for (args, status, words) in [
        ("build half.json -o a.glb --blocks", 1, "half.json:2: found a brush that reaches infinity"),
        ("build mesh.json -o a.glb --blocks", 1, "mesh.json:3: found a closed mesh"),
        ("build outside.json -o a.glb --blocks", 1, "outside.json: the solid is not bounded"),
        ("build box.json -o a.glb --blocks --cells", 2, "--cells"),
        ("build box.json -o a.glb --blocks --preview a.png", 2, "--preview"),
        ("build box.json -o a.glb --blocks=0", 2, "at least 1"),
        ("build box.json -o a.map --blocks", 2, "a.map: found convex bodies or a model"),
        ("build box.json -o a.json --tiles t", 2, "a.json: found convex bodies or a model"),
        ("build box.json -o a.3mf --blocks", 1, "3mf"),
        ("build box.json -o a.glb --work-dir w", 2, "--work-dir"),
        ("build box.json box.json -o a.glb --blocks", 2, "one"),
        ("build box.json --blocks", 2, "--output"),
        ("build gone.json -o a.glb --blocks", 2, "gone.json"),
        ("build gone.map -o a.glb --blocks", 2, "gone.map"),
        ("build box.json --tiles taken", 1, "taken"),
        ("build box.json -o a.glb --blocks --work-dir taken", 1, "taken which is no folder of blocks"),
    ] {
        let run = run(folder.path(), args);
        run.expect_error(status, words);
        assert_eq!(everything_in(folder.path()), before, "{args}");
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_one_error() {
    let folder = folder();
    fs::write(folder.path().join("city.json"), CITY).expect("written");
    for name in ["a.stl", "a.ply", "a.obj", "a.glb"] {
        std::os::unix::fs::symlink("/dev/full", folder.path().join(name)).expect("made");
        run(folder.path(), &format!("build city.json -o {name} --blocks=80")).expect_error(1, name);
    }
}

#[test]
fn a_map_from_standard_input_is_read_as_a_stream() {
    let folder = folder();
    let text = fs::read(keep()).expect("the example");
    let args = "build - --input-format map -o a.glb --blocks=30 --report r.json";
    run_with(folder.path(), args, &text).expect_quiet_success();
    let report = json_of(&folder.path().join("r.json"));
    let whole = planecut(["info".as_ref(), keep().as_os_str()]).json();
    let expected = whole["solid"]["volume"].as_f64().expect("a number");
    assert!(agree(&report["solid"]["volume"], expected, 1e-9), "{}", report["solid"]);
    // the line of an error is that of the whole text
    let mut damaged = text;
    let end = damaged.iter().rposition(|byte| *byte == b'(').expect("a face");
    let line = 1 + damaged[..end].iter().filter(|byte| **byte == b'\n').count();
    damaged[end] = b'[';
    run_with(folder.path(), args, &damaged).expect_error(2, &format!("standard input:{line}: found"));
}

#[test]
fn a_tile_set_has_the_whole_model_in_its_leaves() {
    let folder = folder();
    fs::write(folder.path().join("city.json"), CITY).expect("written");
    run(folder.path(), "build city.json --tiles t --blocks=50 --scale 0.5 --report r.json").expect_quiet_success();
    let report = json_of(&folder.path().join("r.json"));
    let tileset = json_of(&folder.path().join("t/tileset.json"));
    assert_eq!(tileset["asset"]["version"], json!("1.1"));
    let (mut open, mut leaves, mut triangles) = (vec![tileset["root"].clone()], 0, 0);
    while let Some(tile) = open.pop() {
        let children = tile["children"].as_array().cloned().unwrap_or_default();
        let error = tile["geometricError"].as_f64().expect("a number");
        assert!(children.iter().all(|child| child["geometricError"].as_f64().expect("a number") < error));
        if children.is_empty() {
            leaves += 1;
            let path = folder.path().join("t").join(tile["content"]["uri"].as_str().expect("a name"));
            let glb = fs::read(&path).expect("a tile");
            let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
            let document: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
            for primitive in document["meshes"]
                .as_array()
                .expect("meshes")
                .iter()
                .flat_map(|mesh| mesh["primitives"].as_array().expect("a list"))
            {
                let accessor = primitive["indices"].as_u64().expect("indices") as usize;
                triangles += document["accessors"][accessor]["count"].as_u64().expect("a number") as usize / 3;
            }
        }
        open.extend(children);
    }
    assert!(leaves > 8);
    // single precision may leave out some that have no area there
    let all = report["mesh"]["triangles"].as_u64().expect("a number") as usize;
    assert!(triangles <= all && triangles * 1000 > all * 999, "{triangles} of {all}");
    // another one replaces it
    run(folder.path(), "build city.json --tiles t --blocks=500").expect_quiet_success();
}
