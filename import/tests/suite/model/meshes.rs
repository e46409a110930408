//! Nodes that are mesh files: where they are, what they are made of, and what is said of those that are no solid.

use planecut_csg::MaterialId;

use crate::measures::area_of;

use super::support::{assert_close, file, model, read, volume};

#[track_caller]
fn expect(node: &str, expected: f64) {
    assert_close(volume(&file(node)), expected, node);
}

#[test]
fn a_mesh_is_an_operand_like_any_other() {
    expect(r#"{"mesh": "l.obj"}"#, 3.0);
    expect(r#"{"mesh": {"file": "l.obj", "scale": 2}}"#, 24.0);
    expect(r#"{"mesh": "./l.obj", "transform": [{"mirror": [1, 0, 0]}, {"scale": [1, 2, 3]}]}"#, 18.0);
    let slot = r#"{"box": {"min": [-1, 0.25, -1], "max": [3, 0.75, 2]}}"#;
    expect(&format!(r#"{{"difference": [{{"mesh": "l.obj"}}, {slot}]}}"#), 2.0);
    expect(&format!(r#"{{"intersection": [{slot}, {{"mesh": "l.obj"}}]}}"#), 1.0);
    // copies share the mesh, and one overlaps the other by half of an arm
    expect(r#"{"array": {"of": {"mesh": "l.obj"}, "count": [2, 1, 1], "step": [1.5, 0, 0]}}"#, 5.5);
}

#[test]
fn the_rule_says_what_is_inside() {
    expect(r#"{"mesh": "nested.obj"}"#, 27.0);
    expect(r#"{"mesh": {"file": "nested.obj", "rule": "nonzero"}}"#, 27.0);
    expect(r#"{"mesh": {"file": "nested.obj", "rule": "odd"}}"#, 26.0);
}

#[test]
fn what_needs_convex_bodies_makes_them_of_meshes() {
    let cube = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;
    // an L with arms twice as wide and high: its outline has area 3 + 8 + 1, a corner of 1 is not filled
    expect(&format!(r#"{{"minkowski": [{{"mesh": "l.obj"}}, {cube}]}}"#), 16.0);
    expect(r#"{"hull": [{"mesh": "l.obj"}]}"#, 3.5);
    expect(r#"{"extrude": {"outline": {"project": {"mesh": "l.obj"}}, "height": 2}}"#, 6.0);
    expect(r#"{"extrude": {"outline": {"slice": {"of": {"mesh": "l.obj"}, "z": 0.5}}, "height": 2}}"#, 6.0);
}

#[test]
fn faces_have_the_materials_of_the_file_then_those_of_nodes() {
    let text = r#"{"planecut": 1, "materials": {"stone": {"color": [1, 0, 0]}, "snow": {}}, "model":
        {"union": [{"mesh": "l.obj", "matrix": [[1, 0, 0, 9], [0, 1, 0, 0], [0, 0, 1, 0]]}, {"mesh": "cube.obj"}],
         "material": "snow", "name": "both"}}"#;
    let import = read(text).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["stone", "snow", "old oak"]);
    let [l, cube] = import.model.tree.brushes() else { panic!("two leaves") };
    let mut used: Vec<MaterialId> = l.materials().collect();
    used.sort_unstable();
    assert_eq!(used, [MaterialId(0), MaterialId(2)], "the lid and the walls, the floor");
    assert!(cube.materials().all(|material| material == MaterialId(1)));
    assert_eq!((l.name.as_deref(), cube.name.as_deref()), (Some("L"), Some("cube")));
    assert!((area_of(&import.model, MaterialId(2)) - 3.0).abs() < 1e-12, "the floor alone");
}

#[test]
fn brushes_have_the_line_of_their_node() {
    let import = model("{\n\"union\": [\n{\"mesh\": \"l.obj\"}]}");
    assert_eq!(import.model.tree.source_line(0).map(u32::from), Some(3));
}

#[test]
fn an_open_mesh_is_refused_unless_its_vertices_are_joined() {
    let error = read(&file(r#"{"mesh": "open.obj"}"#)).expect_err("open").to_string();
    assert!(error.starts_with("m.json:1: $.model.mesh: found a mesh that is no solid (open.obj:"), "{error}");
    assert!(error.contains("found 4 open edges, the first one from ("), "{error}");
    assert!(error.ends_with("expected a closed mesh, or the key `close`, a distance within which vertices are joined"));
    let import = model(r#"{"mesh": {"file": "open.obj", "close": 0.002}}"#);
    assert!(import.warnings[0].message.contains("`open.obj`: joined 1 vert"), "{:?}", import.warnings);
    expect(r#"{"mesh": {"file": "open.obj", "close": 0.002}}"#, 3.0);
}

#[test]
fn names_that_are_no_mesh_beside_the_model_are_refused() {
    let refused = |value: &str, path: &str, found: &str, expected: &str| {
        let error = read(&file(&format!(r#"{{"mesh": {value}}}"#))).expect_err(value).to_string();
        let begin = format!("m.json:1: {path}: found {found}, expected {expected}");
        assert!(error.starts_with(&begin), "{error}\n{begin}");
    };
    let beside = "the name of a mesh file beside the model, or in a folder there";
    refused(r#""../l.obj""#, "$.model.mesh", "\"../l.obj\"", beside);
    refused(r#"{"file": "/etc/l.obj"}"#, "$.model.mesh.file", "\"/etc/l.obj\"", beside);
    refused(r#""""#, "$.model.mesh", "\"\"", beside);
    refused(r#""none.obj""#, "$.model.mesh", "\"none.obj\" (no such file)", "a file that can be read");
    refused(r#""l.map""#, "$.model.mesh", "\"l.map\"", "the name of a mesh: `.obj`");
    refused("7", "$.model.mesh", "7", "the name of a mesh file, or an object with the key file");
    refused(r#"{"file": "l.obj", "scale": "=1-1"}"#, "$.model.mesh.scale", "0 from \"=1-1\"", "a number above 0");
    refused(r#"{"file": "l.obj", "close": -1}"#, "$.model.mesh.close", "-1", "a number above 0");
    refused(
        r#"{"file": "l.obj", "rule": "even"}"#,
        "$.model.mesh.rule",
        "the text \"even\"",
        "one of positive, nonzero, odd",
    );
    refused(r#"{"files": "l.obj"}"#, "$.model.mesh.files", "the key `files`", "one of file, scale, rule, close");
}
