//! Meshes whose triangles the model lists itself.

use planecut_csg::{MaterialId, MeshBody, Transform, Tree, WindingRule};
use planecut_import::model::{MAX_PLANES, ModelOptions, read_model};
use planecut_kernel::DVec3;

use crate::measures::area_of;

use super::support::{assert_close, file, model, read, volume};

/// A corner of the unit cube, cut off: a sixth.
const VERTICES: &str = "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]";
const TRIANGLES: &str = "[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]";

/// A mesh with more keys.
fn mesh(more: &str) -> String {
    format!(r#"{{"mesh": {{"vertices": {VERTICES}, "triangles": {TRIANGLES}{more}}}}}"#)
}

fn body(tree: &Tree) -> &MeshBody {
    let [brush] = tree.brushes() else { panic!("one leaf") };
    assert!(brush.faces.is_empty());
    brush.mesh.as_ref().expect("a mesh")
}

#[test]
fn triangles_are_a_leaf_as_they_stand() {
    let text = r#"{"mesh": {"vertices": [[-0.0, 0, 1e-300], [0.1, 0, 0], ["=1/3", 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [0, "=2+1", 2], [1, 2, 3]]}}"#;
    let import = model(text);
    let body = body(&import.model.tree);
    let bits = |x: f64, y: f64, z: f64| [x, y, z].map(f64::to_bits);
    let found: Vec<[u64; 3]> = body.mesh().positions().iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    assert_eq!(found, [bits(-0.0, 0.0, 1e-300), bits(0.1, 0.0, 0.0), bits(1.0 / 3.0, 1.0, 0.0), bits(0.0, 0.0, 1.0)]);
    assert_eq!(body.mesh().triangles(), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    assert_eq!((body.transform(), body.rule()), (&Transform::identity(), WindingRule::Positive));
}

#[test]
fn it_is_an_operand_like_any_other() {
    assert_close(volume(&file(&mesh(""))), 1.0 / 6.0, "a tetrahedron");
    let cube = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;
    assert_close(volume(&file(&format!(r#"{{"difference": [{cube}, {}]}}"#, mesh("")))), 5.0 / 6.0, "a corner off");
    assert_close(volume(&file(&format!(r#"{{"hull": [{}, {cube}]}}"#, mesh("")))), 1.0, "a hull");
    let moved = mesh("").replace("}}", r#"}, "transform": [{"scale": 2}, {"mirror": [1, 1, 0]}]}"#);
    assert_close(volume(&file(&moved)), 8.0 / 6.0, "moved");
    // copies share the mesh
    let ring = model(&format!(r#"{{"ring": {{"of": {}, "count": 4}}}}"#, mesh("")));
    let meshes: Vec<_> =
        ring.model.tree.brushes().iter().map(|brush| brush.mesh.as_ref().expect("a mesh").mesh()).collect();
    assert!(meshes.iter().all(|mesh| std::sync::Arc::ptr_eq(mesh, meshes[0])));
    assert_close(
        volume(&file(&format!(r#"{{"ring": {{"of": {}, "count": 4}}}}"#, mesh("")))),
        4.0 / 6.0,
        "four corners",
    );
}

#[test]
fn the_rule_says_what_is_inside() {
    // turned inside out: the winding number within is -1
    let inverted = |rule: &str| {
        file(&format!(
            r#"{{"mesh": {{"vertices": {VERTICES}, "triangles": [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], "rule": "{rule}"}}}}"#
        ))
    };
    for (rule, expected) in [("positive", 0.0), ("nonzero", 1.0 / 6.0), ("odd", 1.0 / 6.0)] {
        assert_close(volume(&inverted(rule)), expected, rule);
    }
}

#[test]
fn triangles_have_their_own_materials_or_that_of_the_node() {
    let node = mesh(r#", "materials": ["stone", null, "snow", "stone"]"#);
    let text = format!(
        r#"{{"planecut": 1, "materials": {{"stone": {{}}, "snow": {{}}, "moss": {{}}}}, "model": {{"union": [{node}], "material": "moss"}}}}"#
    );
    let import = read(&text).expect("read");
    let found: Vec<MaterialId> = (0..4).map(|triangle| body(&import.model.tree).material(triangle)).collect();
    assert_eq!(found, [0, 2, 1, 0].map(MaterialId));
    assert_eq!(body(&import.model.tree).materials().len(), 3, "each material once");
    assert_close(area_of(&import.model, MaterialId(0)), 0.5 + 0.75_f64.sqrt(), "stone");
    let import = model(&mesh(""));
    assert_eq!(import.model.materials[0].name, "default");
    let warned = model(&mesh(r#", "materials": ["mud", "mud", null, "mud"]"#));
    assert_eq!(warned.warnings.len(), 1);
    assert!(warned.warnings[0].message.contains("no material `mud`"), "{:?}", warned.warnings);
}

/// Vertices at one place are one where the mesh is not closed otherwise.
#[test]
fn vertices_at_one_place_close_a_mesh() {
    let corner = |k: usize| ["[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"][k];
    let apart: Vec<&str> =
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].as_flattened().iter().map(|k| corner(*k)).collect();
    let triangles: Vec<String> = (0..4).map(|k| format!("[{}, {}, {}]", 3 * k, 3 * k + 1, 3 * k + 2)).collect();
    let text =
        format!(r#"{{"mesh": {{"vertices": [{}], "triangles": [{}]}}}}"#, apart.join(", "), triangles.join(", "));
    assert_close(volume(&file(&text)), 1.0 / 6.0, "joined");
    assert_eq!(body(&model(&text).model.tree).mesh().positions(), [DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::Z]);
}

#[track_caller]
fn refused(value: &str, path: &str, found: &str, expected: &str) {
    let error = read(&file(&format!(r#"{{"mesh": {value}}}"#))).expect_err(value).to_string();
    assert_eq!(error, format!("m.json:1: $.model.mesh{path}: found {found}, expected {expected}"));
}

#[test]
fn meshes_that_are_none_are_refused() {
    let of = |triangles: &str| format!(r#"{{"vertices": {VERTICES}, "triangles": {triangles}}}"#);
    let is_number = "a whole number from 0 to 3";
    refused(&of("[[0, 2, 4]]"), ".triangles[0][2]", "4", is_number);
    refused(&of("[[0, 2, 1], [0, -1, 3]]"), ".triangles[1][1]", "-1", is_number);
    refused(&of("[[0, 1.5, 2]]"), ".triangles[0][1]", "1.5", is_number);
    refused(&of(r#"[[0, "=9/2", 2]]"#), ".triangles[0][1]", "4.5 from \"=9/2\"", is_number);
    refused(&of("[[0, 1e300, 2]]"), ".triangles[0][1]", "1e300", is_number);
    refused(&of("[[0, true, 2]]"), ".triangles[0][1]", "true", "a number or an expression");
    refused(&of("[[0, 1]]"), ".triangles[0]", "a list of 2 values", "a list of 3 numbers");
    refused(&of("[]"), ".triangles", "an empty list", "a list of one or more lists of 3 numbers");
    refused(
        &of("[[0, 2, 1], [0, 1, 3], [0, 3, 2]]"),
        ".triangles[0]",
        "3 open edges, the first one from [0, 1, 0] to [1, 0, 0]",
        "a closed mesh",
    );
    let range = "0, or a magnitude of at least 2^-1022 and at most 2^100";
    for far in ["1.3e30", "-1e300", "1e-310"] {
        let value = format!(r#"{{"vertices": [[0, 0, 0], [0, {far}, 0]], "triangles": {TRIANGLES}}}"#);
        refused(&value, ".vertices[1][1]", far, range);
    }
    let flat = r#"{"vertices": [[0, 0], [1, 0]], "triangles": [[0, 1, 2]]}"#;
    refused(flat, ".vertices[0]", "a list of 2 values", "a list of 3 numbers");
    refused(
        r#"{"vertices": [], "triangles": [[0, 0, 0]]}"#,
        ".vertices",
        "an empty list",
        "a list of one or more lists of 3 numbers",
    );
}

#[test]
fn keys_of_one_form_are_not_those_of_the_other() {
    let inline = "one of vertices, triangles, materials, rule";
    refused(&format!(r#"{{"vertices": {VERTICES}}}"#), "", "an object with vertices", "the key `triangles` as well");
    refused(&format!(r#"{{"triangles": {TRIANGLES}}}"#), "", "an object with triangles", "the key `vertices` as well");
    for key in ["scale", "close"] {
        let value = format!(r#"{{"vertices": {VERTICES}, "triangles": {TRIANGLES}, "{key}": 1}}"#);
        refused(&value, &format!(".{key}"), &format!("the key `{key}`"), inline);
    }
    let file_form = "one of file, scale, rule, close";
    let value = format!(r#"{{"file": "l.obj", "vertices": {VERTICES}}}"#);
    refused(&value, ".vertices", "the key `vertices`", file_form);
    refused(r#"{"file": "l.obj", "materials": ["a"]}"#, ".materials", "the key `materials`", file_form);
    let whole = |more: &str| format!(r#"{{"vertices": {VERTICES}, "triangles": {TRIANGLES}, {more}}}"#);
    refused(&whole(r#""rule": "even""#), ".rule", "the text \"even\"", "one of positive, nonzero, odd");
    refused(&whole(r#""materials": ["a"]"#), ".materials", "a list of 1 materials", "as many as triangles, 4");
    refused(&whole(r#""materials": "a""#), ".materials", "the text \"a\"", "a list of names of materials, or null");
    refused(&whole(r#""materials": [1, null, null, null]"#), ".materials[0]", "1", "the name of a material, or null");
}

#[test]
fn triangles_count_as_planes_before_any_is_made() {
    // a mesh of 2 triangles on each other is closed, and copies of it are refused before they are made
    let sheet = r#"{"mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2], [0, 2, 1]]}}"#;
    let count = MAX_PLANES / 2 / 16 + 1;
    let pair = format!(r#"{{"array": {{"of": {sheet}, "count": [16, 1, 1], "step": [2, 0, 0]}}}}"#);
    let all = format!(r#"{{"array": {{"of": {pair}, "count": [{count}, 1, 1], "step": [0, 2, 0]}}}}"#);
    let error = read(&file(&all)).expect_err("too many").to_string();
    assert!(error.contains("brushes in all, expected at most"), "{error}");
    let options = ModelOptions { max_pieces: 3, ..ModelOptions::default() };
    let four = format!(r#"{{"union": [{sheet}, {sheet}, {sheet}, {sheet}]}}"#);
    let error = read_model(file(&four).as_bytes(), "m.json", &options).expect_err("too many").to_string();
    assert!(error.contains("found 4 or more brushes in all, expected at most 3 (--max-pieces)"), "{error}");
}
