//! What is written is what `docs/model.schema.json` describes.

use std::path::Path;

use jsonschema::Validator;
use planecut_csg::{ClosedMesh, MaterialId, MeshBody, Model, Transform, Tree};
use planecut_kernel::DVec3;
use planecut_testkit::random::Rng;
use serde_json::Value;

use super::support::{any_brush, any_tree, materials, written};

fn validator() -> Validator {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/model.schema.json");
    let schema = serde_json::from_slice(&std::fs::read(path).expect("the schema")).expect("JSON");
    jsonschema::draft202012::options().build(&schema).expect("a schema of draft 2020-12")
}

/// A tetrahedron, each side of a material.
fn mesh() -> Tree {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let closed = ClosedMesh::new(&positions, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], |k| k as u32);
    let body = MeshBody::new(closed.expect("closed"), [0, 1, 1, 2].map(MaterialId).to_vec());
    let moved =
        body.with_rule(planecut_csg::WindingRule::Odd).transformed(&Transform::scale(DVec3::splat(2.0)).unwrap());
    moved.expect("in range").into()
}

#[test]
fn what_is_written_fits_the_schema() {
    let validator = validator();
    for seed in 0..60 {
        let mut random = Rng::new(seed);
        let materials = materials(&mut random);
        let tree = any_tree(&mut random, 4, &mut any_brush) - mesh();
        let text = written(&Model { materials, tree }, 1.0);
        let value: Value = serde_json::from_str(&text).expect("JSON");
        if let Err(error) = validator.validate(&value) {
            panic!("seed {seed}: {error} at {}", error.instance_path());
        }
    }
    let empty: Value = serde_json::from_str(&written(&Model::default(), 1.0)).expect("JSON");
    assert!(validator.is_valid(&empty));
}
