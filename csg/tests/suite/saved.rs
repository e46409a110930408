//! What is written comes back as it was, and what cannot have been written is refused (feature `serde`).

use std::num::NonZeroU32;

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, Model, TextureAxes, Transform, Tree, evaluate};
use planecut_testkit::saved::{refusal, through_data};
use serde_json::{Value, json, to_value};

/// A notched block, its offsets without short decimals, with a name and source lines.
fn model() -> Model {
    let block = |min: f64, max: f64, material| Brush::cuboid([min / 3.0; 3], [max / 3.0; 3], MaterialId(material));
    let turn = Transform::rotation([1.0, 2.0, 3.0], 40.0).expect("an axis");
    let notch = Tree::from(block(0.5, 2.0, 1)).transformed(&turn).expect("near the origin").with_name("notch");
    let tree =
        (Tree::from(block(-1.0, 1.0, 0)) - notch).with_source_line(NonZeroU32::new(3)) | block(4.0, 5.0, 0).into();
    Model {
        materials: vec![Material::named("steel"), Material { metallic: Some(0.1), ..Material::named("cut") }],
        tree,
    }
}

#[test]
fn models_and_meshes_come_back() {
    let model = model();
    let copy = through_data(&model);
    assert_eq!(copy, model);
    assert_eq!((copy.tree.source_line(0), copy.tree.source_line(2)), (NonZeroU32::new(3), None));
    let evaluation = evaluate(&model).expect("it is bounded");
    assert_eq!(through_data(&evaluation.mesh), evaluation.mesh);
    assert_eq!(through_data(&evaluation.solid), evaluation.solid);
    assert_eq!(evaluate(&copy).expect("it is bounded").mesh, evaluation.mesh);
}

#[test]
fn transforms_come_back_and_are_checked() {
    let turn =
        Transform::rotation([1.0, 2.0, 3.0], 40.0).and_then(|turn| turn.then(&Transform::translation([0.1; 3])?));
    let turn = turn.expect("an axis");
    assert_eq!(through_data(&turn), turn);
    let mut flat = to_value(turn).expect("it can be written");
    flat["linear"][1] = flat["linear"][0].clone();
    assert_eq!(refusal::<Transform>(flat), "the matrix is singular: it flattens what it is applied to");
}

#[test]
fn trees_that_are_not_well_formed_are_refused() {
    let data = to_value(model().tree).expect("it can be written");
    let changed = |path: &str, value: Value| {
        let mut data = data.clone();
        *data.pointer_mut(path).expect("it is there") = value;
        refusal::<Tree>(data)
    };
    let union = |operands: u32| json!({"Operation": {"operation": "Union", "operands": operands}});
    let last = data["nodes"].as_array().expect("nodes").len() - 1;
    let root = format!("/nodes/{last}");
    assert_eq!(changed(&root, union(3)), format!("node {last} of the tree takes 3 operands, found 2 before it"));
    assert_eq!(changed(&root, union(1)), "the nodes of the tree leave 2 results, expected one");
    assert_eq!(changed("/nodes", json!([])), "the nodes of the tree leave 0 results, expected one");
    assert_eq!(changed("/nodes", json!(["Leaf"])), "the tree has 1 leaves, but 3 brushes");
    assert_eq!(changed("/lines", json!([1])), "the tree has 1 source lines, but 3 brushes");
    assert!(changed("/lines", json!([0, 0, 0])).contains("nonzero"));
    assert!(changed("/brushes/0/faces/0/half_space", json!([0.0, 0.0, 0.0, 1.0])).contains("normal"));
}

#[test]
fn closed_meshes_come_back_and_are_checked() {
    use planecut_csg::{ClosedMesh, MeshBody, WindingRule};
    let mesh = planecut_testkit::meshes::box_mesh([0.1; 3].into(), [0.7; 3].into(), "steel");
    let closed = ClosedMesh::new(&mesh.positions, &mesh.triangles, |triangle| u32::from(triangle > 5)).expect("closed");
    let turn = Transform::rotation([1.0, 2.0, 3.0], 40.0).expect("an axis");
    let body = MeshBody::new(closed, vec![MaterialId(1), MaterialId(0)]).with_rule(WindingRule::Odd);
    let body = body.transformed(&turn).expect("near the origin");
    assert_eq!(through_data(&body), body);
    let mut model = model();
    model.tree = Tree::from(body.clone()).with_name("mesh") | model.tree;
    let copy = through_data(&model);
    assert_eq!(copy, model);
    assert_eq!(evaluate(&copy).expect("it is bounded").mesh, evaluate(&model).expect("it is bounded").mesh);
    let data = to_value(&body).expect("it can be written");
    let changed = |key: &str, value: Value| {
        let mut data = data.clone();
        data[key] = value;
        refusal::<MeshBody>(data)
    };
    assert_eq!(data.get("textures"), None, "nothing is known of any");
    assert_eq!(changed("surfaces", json!([0])), "the mesh has 1 surfaces, but 12 triangles");
    assert_eq!(changed("textures", json!([null])), "the mesh has 1 textures, but 2 materials");
    let corners = [[0.1, 0.1, 0.1], [0.7, 0.1, 0.1], [0.1, 0.7, 0.1]].map(DVec3::from);
    let texture = TextureAxes::of_triangle(corners, [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]].map(Into::into));
    let textured = body.with_textures([texture, None]);
    assert_eq!(through_data(&textured), textured);
    assert!(changed("materials", json!([0])).starts_with("a triangle has surface 1, expected a number below 1"));
    let mut triangles = data["triangles"].as_array().expect("triangles").clone();
    triangles[3] = triangles[2].clone();
    assert!(changed("triangles", json!(triangles)).contains("expected a closed mesh"));
}
