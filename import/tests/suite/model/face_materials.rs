//! Half-spaces with a list of materials: each face has its own.

use planecut_csg::{Brush, ModelSummary, evaluate};

use crate::measures::area_of;

use super::support::{file, read};

/// A box of 1 × 2 × 3: the sides across x, y and z, each pair of two.
const SIDES: &str = "[[1, 0, 0, 1], [-1, 0, 0, 0], [0, 1, 0, 2], [0, -1, 0, 0], [0, 0, 1, 3], [0, 0, -1, 0]]";

/// The names of the materials of a brush's faces, in a file with the materials a, b and c.
fn names_of(model: &str) -> Vec<Vec<String>> {
    let text = format!(r#"{{"planecut": 1, "materials": {{"a": {{}}, "b": {{}}, "c": {{}}}}, "model": {model}}}"#);
    let import = read(&text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    assert_eq!(import.warnings, [], "{text}");
    let materials = &import.model.materials;
    let of = |brush: &Brush| brush.materials().map(|material| materials[material.0 as usize].name.clone()).collect();
    import.model.tree.brushes().iter().map(of).collect()
}

#[test]
fn each_face_has_its_own_material_or_that_of_its_node() {
    let list = r#"["a", null, "b", "a", null, "c"]"#;
    let node = format!(r#"{{"halfspaces": {SIDES}, "materials": {list}"#);
    let with = |other: &str| vec![["a", other, "b", "a", other, "c"].map(str::to_owned).to_vec()];
    assert_eq!(names_of(&format!("{node}}}")), with("default"), "as without it");
    assert_eq!(names_of(&format!(r#"{node}, "material": "c"}}"#)), with("c"), "the node's own");
    assert_eq!(
        names_of(&format!(r#"{{"union": [{node}}}], "material": "b"}}"#)),
        with("b"),
        "that of the nodes around"
    );
    assert_eq!(names_of(&format!(r#"{{"material": "c", "materials": {list}, "halfspaces": {SIDES}}}"#)), with("c"));
    let nulls =
        format!(r#"{{"halfspaces": {SIDES}, "materials": [null, null, null, null, null, null], "material": "a"}}"#);
    assert_eq!(names_of(&nulls), [vec!["a".to_owned(); 6]]);
}

#[test]
fn copies_and_parts_keep_the_materials_of_faces() {
    let node = format!(r#"{{"halfspaces": {SIDES}, "materials": ["a", null, null, null, null, "b"]}}"#);
    let expected = ["a", "c", "c", "c", "c", "b"].map(str::to_owned).to_vec();
    let copies = format!(r#"{{"array": {{"of": {node}, "count": [2, 1, 1], "step": [5, 0, 0]}}, "material": "c"}}"#);
    assert_eq!(names_of(&copies), [expected.clone(), expected]);
}

#[test]
fn faces_of_the_solid_are_of_their_materials() {
    let model = format!(r#"{{"halfspaces": {SIDES}, "materials": ["a", "a", "b", "b", "c", "c"]}}"#);
    let import = read(&file(&model)).expect("read");
    let ModelSummary { brushes, .. } = evaluate(&import.model).expect("bounded").model;
    assert_eq!(brushes, 1);
    for (name, area) in [("a", 12.0), ("b", 6.0), ("c", 4.0)] {
        let number = import.model.materials.iter().position(|material| material.name == name).expect(name);
        assert!((area_of(&import.model, planecut_csg::MaterialId(number as u32)) - area).abs() < 1e-12, "{name}");
    }
}

#[test]
fn names_that_the_file_does_not_define_are_warned_of_once() {
    let model =
        r#"{"halfspaces": [[1, 0, 0, 1], [0, 1, 0, 1]],\n "materials": ["snow",\n "snow"]}"#.replace("\\n", "\n");
    let import = read(&file(&model)).expect("read");
    let warnings: Vec<String> = import.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings, ["line 2: the file defines no material `snow`; its colour is made up"]);
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["snow"]);
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let refused = |model: &str, path: &str, found: &str, expected: &str| {
        let error = read(&file(model)).expect_err(model).to_string();
        assert_eq!(error, format!("m.json:1: {path}: found {found}, expected {expected}"));
    };
    let two = |list: &str| format!(r#"{{"halfspaces": [[1, 0, 0, 1], [0, 1, 0, 1]], "materials": {list}}}"#);
    let place = "$.model.materials";
    refused(&two("[null]"), place, "a list of 1 materials", "as many as half-spaces, 2");
    refused(&two(r#"["a", "b", "c"]"#), place, "a list of 3 materials", "as many as half-spaces, 2");
    refused(&two("[]"), place, "a list of 0 materials", "as many as half-spaces, 2");
    refused(&two(r#""a""#), place, "the text \"a\"", "a list of names of materials, or null");
    refused(&two(r#"{"a": 1}"#), place, "an object with a", "a list of names of materials, or null");
    refused(&two("null"), place, "null", "a list of names of materials, or null");
    refused(&two("[null, 7]"), "$.model.materials[1]", "7", "the name of a material, or null");
    refused(&two(r#"[["a"], null]"#), "$.model.materials[0]", "a list of 1 value", "the name of a material, or null");
    let cube = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "materials": [null]}"#;
    refused(cube, place, "the key `materials` beside `box`", "it beside `halfspaces` alone");
    let mesh = r#"{"mesh": "l.obj", "materials": [null]}"#;
    refused(mesh, place, "the key `materials` beside `mesh`", "it beside `halfspaces` alone");
    let with = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "with": {}}"#;
    refused(with, "$.model.with", "the key `with` beside `box`", "it beside `use` alone");
}
