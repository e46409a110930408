//! `planecut coarsen` for physics engines: rigid bodies in MJCF, URDF and USD, and the limits of `--engine`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use roxmltree::Document;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::support::{Run, agree, everything_in, folder, run_with};

/// A box along the axes, a turned one on it, and a pyramid beside them.
const PARTS: &str = r#"{"planecut": 1, "model": {"union": [
    {"box": {"min": [0, 0, 0], "max": [4, 2, 1]}},
    {"box": {"min": [-1, -0.5, 1], "max": [1, 0.5, 2]}, "matrix": [[0.8, -0.6, 0, 2], [0.6, 0.8, 0, 1], [0, 0, 1, 0]]},
    {"points": [[6, 0, 0], [8, 0, 0], [8, 2, 0], [6, 2, 0], [7, 1, 3]]}
]}}"#;

/// A folder with the parts as `m.json`.
fn folder_with_parts() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("m.json"), PARTS).expect("written");
    folder
}

fn coarsen(folder: &Path, arguments: &str) -> (Run, Value) {
    let run = run_with(folder, &format!("coarsen {arguments} --report r.json"), b"");
    let report =
        fs::read(folder.join("r.json")).map_or(Value::Null, |text| serde_json::from_slice(&text).expect("JSON"));
    (run, report["coarsen"].clone())
}

/// The numbers of an attribute.
fn numbers(node: roxmltree::Node<'_, '_>, attribute: &str) -> Vec<f64> {
    let text = node.attribute(attribute).unwrap_or_else(|| panic!("no {attribute} in {node:?}"));
    text.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

fn elements<'a>(document: &'a Document<'_>, name: &'a str) -> Vec<roxmltree::Node<'a, 'a>> {
    document.descendants().filter(|node| node.has_tag_name(name)).collect()
}

/// The vertices of an OBJ file.
fn vertices(path: &Path) -> Vec<[f64; 3]> {
    let text = fs::read_to_string(path).expect("text");
    let numbers = |line: &str| {
        let values: Vec<f64> = line.split_whitespace().skip(1).map(|value| value.parse().expect("a number")).collect();
        [values[0], values[1], values[2]]
    };
    text.lines().filter(|line| line.starts_with("v ")).map(numbers).collect()
}

#[test]
fn a_body_has_a_document_and_its_meshes_and_boxes_are_boxes() {
    let folder = folder_with_parts();
    let folder = folder.path();
    let (run, told) = coarsen(folder, "m.json -o b.xml -o b.urdf -o b.usda --density 2 --unit cm");
    run.expect_quiet_success();
    let files = ["b.urdf", "b.usda", "b.xml", "b_meshes", "collision_2.obj", "visual.obj"];
    let found: BTreeSet<String> = everything_in(folder).into_iter().collect();
    assert_eq!(found, files.into_iter().chain(["m.json", "r.json"]).map(str::to_owned).collect());
    assert_eq!((&told["boxes"], &told["cells_out"], &told["engine"]), (&json!(2), &json!(3), &json!(null)));
    // 8 + 2 + 4 cubic centimetres at 2 kg per cubic metre
    assert!(agree(&told["mass"]["mass"], 14e-6 * 2.0, 1e-12) && told["mass"]["of"] == "input", "{told}");

    let text = fs::read_to_string(folder.join("b.xml")).expect("text");
    let document = Document::parse(&text).expect("XML");
    let geoms = elements(&document, "geom");
    let boxes: Vec<_> = geoms.iter().filter(|geom| geom.attribute("type") == Some("box")).collect();
    assert_eq!(boxes.len(), 2);
    let single = |value: f64| f64::from(value as f32);
    let flat = boxes.iter().find(|geom| geom.attribute("quat").is_none()).expect("a box along the axes");
    let half = numbers(**flat, "size");
    for (half, expected) in half.iter().zip([0.02, 0.01, 0.005]) {
        assert!(*half >= expected && *half < expected * (1.0 + 1e-6) && single(*half) == *half, "{half}");
    }
    let turned = boxes.iter().find(|geom| geom.attribute("quat").is_some()).expect("a turned box");
    let [w, x, y, z] = numbers(**turned, "quat").try_into().expect("four numbers");
    // about z by some angle of 36.87° and right angles; or with axes in another order
    assert!((w * w + x * x + y * y + z * z - 1.0_f64).abs() < 1e-6);
    let mut sizes = numbers(**turned, "size");
    sizes.sort_by(f64::total_cmp);
    for (half, expected) in sizes.iter().zip([0.005, 0.005, 0.01]) {
        assert!(*half >= expected && *half < expected * (1.0 + 1e-5), "{half}");
    }
    let inertial = elements(&document, "inertial")[0];
    assert_eq!(numbers(inertial, "mass"), [told["mass"]["mass"].as_f64().expect("a number")]);
    let robot = fs::read_to_string(folder.join("b.urdf")).expect("text");
    let robot = Document::parse(&robot).expect("XML");
    assert_eq!((elements(&robot, "collision").len(), elements(&robot, "box").len()), (3, 2));
    assert_eq!(numbers(elements(&robot, "mass")[0], "value"), numbers(inertial, "mass"));
    for (attribute, place) in [("ixx", 0), ("iyy", 1), ("izz", 2), ("ixy", 3), ("ixz", 4), ("iyz", 5)] {
        let own = numbers(elements(&robot, "inertia")[0], attribute);
        assert_eq!(own, [numbers(inertial, "fullinertia")[place]], "{attribute}");
    }
    // the pyramid, rounded outward to single precision
    let pyramid = vertices(&folder.join("b_meshes/collision_2.obj"));
    assert!(pyramid.iter().flatten().all(|value| single(*value) == *value), "{pyramid:?}");
    let top = pyramid.iter().map(|vertex| vertex[2]).fold(0.0, f64::max);
    assert!((0.03..0.03 * (1.0 + 1e-5)).contains(&top), "{top}");
}

#[test]
fn names_are_escaped_and_distinct() {
    let folder = folder_with_parts();
    let folder = folder.path();
    let (run, _) = coarsen(folder, "m.json -o a&b<c>.xml -o a&b<c>.urdf -o a&b<c>.usda --name visual");
    run.expect_quiet_success();
    let text = fs::read_to_string(folder.join("a&b<c>.xml")).expect("text");
    let document = Document::parse(&text).expect("XML");
    assert_eq!(elements(&document, "body")[0].attribute("name"), Some("a&b<c>"));
    let names: BTreeSet<_> = elements(&document, "geom").iter().filter_map(|geom| geom.attribute("name")).collect();
    assert_eq!(
        names,
        ["", "_2", "_3", "_4"].map(|end| format!("a&b<c>_visual{end}")).iter().map(String::as_str).collect()
    );
    // two bodies can be in one scene
    for (element, attribute) in [("mesh", "name"), ("geom", "class"), ("geom", "mesh"), ("default", "class")] {
        let names = elements(&document, element).into_iter().filter_map(|element| element.attribute(attribute));
        assert!(names.clone().count() > 0 && names.clone().all(|name| name.starts_with("a&b<c>_")), "{text}");
    }
    assert!(elements(&document, "compiler").is_empty());
    // folders have names that every system takes
    for mesh in elements(&document, "mesh") {
        assert!(folder.join(mesh.attribute("file").expect("a file")).is_file(), "{mesh:?}");
    }
    let text = fs::read_to_string(folder.join("a&b<c>.urdf")).expect("text");
    let document = Document::parse(&text).expect("XML");
    for mesh in elements(&document, "mesh") {
        assert!(folder.join(mesh.attribute("filename").expect("a file")).is_file(), "{mesh:?}");
    }
    let stage = fs::read_to_string(folder.join("a&b<c>.usda")).expect("text");
    assert!(stage.contains("defaultPrim = \"a_b_c_\"") && stage.contains("def Cube \"visual_2\""), "{stage}");
}

/// Numbers of single precision were written as the shortest text for these, which is another number in double precision.
#[test]
fn boxes_of_usd_far_from_the_origin_enclose_the_cell() {
    let folder = folder();
    let folder = folder.path();
    let (low, high) = ([1000.0, -2000.0, 3000.0], [1000.0999755859375, -1999.9000244140625, 3000.0999755859375]);
    let model = json!({"planecut": 1, "model": {"box": {"min": low, "max": high}}});
    fs::write(folder.join("m.json"), model.to_string()).expect("written");
    let (run, _) = coarsen(folder, "m.json -o b.usda");
    run.expect_quiet_success();
    let stage = fs::read_to_string(folder.join("b.usda")).expect("text");
    let numbers = |name: &str| -> Vec<f64> {
        let text = stage.split_once(&format!("double3 xformOp:{name} = (")).expect(name).1;
        let text = text.split_once(')').expect("an end").0;
        text.split(", ").map(|number| number.parse().expect("a number")).collect()
    };
    let (half, middle) = (numbers("scale"), numbers("translate"));
    for axis in 0..3 {
        assert!(middle[axis] - half[axis] <= low[axis] && middle[axis] + half[axis] >= high[axis], "{stage}");
    }
}

#[test]
fn masses_that_single_precision_does_not_hold_are_refused_in_usd() {
    let folder = folder_with_parts();
    let folder = folder.path();
    for scale in ["1e15", "1e-20"] {
        let (run, _) = coarsen(folder, &format!("m.json -o b.usda --scale {scale}"));
        run.expect_error(1, "mass or moment of inertia");
    }
    assert!(!folder.join("b.usda").exists());
}

#[test]
fn documents_of_one_name_share_meshes_however_their_folder_is_given() {
    let folder = folder_with_parts();
    let folder = folder.path();
    let (run, _) = coarsen(folder, "m.json -o b.xml -o ./b.urdf");
    run.expect_quiet_success();
}

#[test]
fn the_mass_of_an_open_mesh_is_that_of_its_colliders() {
    let folder = folder();
    let folder = folder.path();
    let sides = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 4 3\nf 1 3 2\n";
    fs::write(folder.join("m.obj"), sides).expect("written");
    let (run, told) = coarsen(folder, "m.obj -o a.usda --min-thickness 0.5 --max-cells 1 --quiet");
    run.expect_quiet_success();
    assert_eq!(told["mass"]["of"], "colliders", "{told}");
    let volume = told["volume_out"].as_f64().expect("a number");
    assert!(volume >= 2.0 && agree(&told["mass"]["volume"], volume, 1e-9), "{told}");
    assert!(agree(&told["mass"]["mass"], 1000.0 * volume, 1e-9), "{told}");
    let stage = fs::read_to_string(folder.join("a.usda")).expect("text");
    // what is seen is the mesh itself
    assert!(stage.contains("faceVertexIndices = [0, 3, 2, 0, 2, 1]"), "{stage}");
}

#[test]
fn engines_set_caps_names_and_single_precision_unless_others_are_asked_for() {
    let folder = folder();
    let folder = folder.path();
    let drum = r#"{"planecut": 1, "model": {"cylinder": {"height": 1.1, "radius": 1.3, "segments": 200}}}"#;
    fs::write(folder.join("m.json"), drum).expect("written");
    let corners = |arguments: &str| {
        let (run, told) = coarsen(folder, format!("m.json -o part.obj {arguments}").trim_end());
        run.expect_quiet_success();
        let text = fs::read_to_string(folder.join("part.obj")).expect("text");
        let name = text.lines().find_map(|line| line.strip_prefix("o ")).expect("an object").to_owned();
        (vertices(&folder.join("part.obj")), name, told["engine"].clone())
    };
    let is_single = |corners: &[[f64; 3]]| corners.iter().flatten().all(|value| f64::from(*value as f32) == *value);
    let (all, name, engine) = corners("");
    assert_eq!((all.len(), name.as_str(), engine), (400, "cell_0", json!(null)));
    assert!(!is_single(&all));
    let caps = [
        ("mujoco", 400, "cell_0"),
        ("physx", 64, "cell_0"),
        ("bullet", 100, "cell_0"),
        ("jolt", 256, "cell_0"),
        ("rapier", 400, "cell_0"),
        ("godot", 256, "cell0-convcolonly"),
        ("unity", 129, "cell_0"),
        ("unreal", 400, "UCX_part_0"),
    ];
    for (engine, most, name) in caps {
        let (found, own, told) = corners(&format!("--engine {engine}"));
        assert!(found.len() <= most && found.len() > most / 2, "{engine}: {}", found.len());
        assert_eq!((own.as_str(), told), (name, json!(engine)));
        assert!(is_single(&found), "{engine}");
    }
    let (found, name, _) = corners("--engine godot --max-vertices 20 --name x{}");
    assert!(found.len() <= 20);
    assert_eq!(name, "x0");
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder_with_parts();
    let folder = folder.path();
    fs::write(folder.join("e.jsonl"), "").expect("written");
    let refused = |arguments: &str, words: &str| run_with(folder, arguments, b"").expect_error(2, words);
    refused("build m.json -o a.xml", "a.xml: found a rigid body");
    refused("edit m.json e.jsonl -o a.usda", "a.usda: found a rigid body");
    refused("coarsen m.json -o - --format urdf", "meshes in files beside it");
    refused("coarsen m.json -o a_{}.xml", "found {} in the name of a rigid body");
    refused("coarsen m.json -o a.xml --engine havok", "havok");
    refused("coarsen m.json -o a.xml --density 0", "--density");
    refused("coarsen m.json -o a.obj --engine jolt --inner", "--inner");
    assert_eq!(everything_in(folder), ["e.jsonl", "m.json"]);
    // one file is no trouble
    let run = run_with(folder, "coarsen m.json -o - --format usda", b"");
    assert!(run.status == 0 && run.stdout.starts_with(b"#usda 1.0"), "{}", run.stderr);
}

/// A name that another output has is found before anything is written, also where it is that of a mesh beside a document.
#[test]
fn meshes_replace_no_other_output() {
    let folder = folder_with_parts();
    let folder = folder.path();
    let run = run_with(folder, "coarsen m.json -o a.xml -o a_meshes/visual.obj", b"");
    run.expect_error(2, "two outputs of this name");
    assert_eq!(everything_in(folder), ["m.json"]);
}

#[test]
fn a_mass_that_mujoco_refuses_is_told() {
    let folder = folder_with_parts();
    let folder = folder.path();
    let (run, _) = coarsen(folder, "m.json -o a.xml --unit um");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.lines().count() == 1 && run.stderr.contains("MuJoCo refuses"), "{}", run.stderr);
    // others do not
    coarsen(folder, "m.json -o a.urdf --unit um").0.expect_quiet_success();
}
