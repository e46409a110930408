//! What cannot be written is refused, and the message says what it is.

use std::io;

use planecut_csg::{Brush, ClosedMesh, Material, MaterialId, MeshBody, Model, Tree};
use planecut_export::{ExportError, write_model};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_testkit::random::Rng;

use crate::full_disk::Full;

use super::support::{any_brush, any_tree, materials};

fn cube() -> Brush {
    Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0))
}

/// The error of writing a model, which is one line.
#[track_caller]
fn error(model: &Model, scale: f64) -> ExportError {
    let error = write_model(model, scale, &mut Vec::new()).expect_err("refused");
    assert!(!error.to_string().contains('\n'), "{error}");
    error
}

#[test]
fn scales_out_of_range_are_refused() {
    let model = Model { materials: vec![Material::named("t")], tree: cube().into() };
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-40, 1e40] {
        assert!(matches!(error(&model, scale), ExportError::Scale(_)));
    }
}

#[test]
fn unknown_materials_are_named() {
    let mut brush = cube();
    brush.faces[4].material = MaterialId(1);
    let model = Model { materials: vec![Material::named("t")], tree: Tree::union_of(vec![cube(), brush]) };
    let error = error(&model, 1.0);
    assert!(matches!(error, ExportError::UnknownMaterial { brush: 1, material: 1, count: 1 }), "{error}");
}

#[test]
fn planes_that_leave_the_range_are_named() {
    let far = HalfSpace::new(DVec3::X, 2f64.powi(199)).expect("in range");
    let far = Brush::from_half_spaces([far], MaterialId(0));
    let model = Model { materials: vec![Material::named("t")], tree: Tree::union_of(vec![cube(), far]) };
    write_model(&model, 1.0, &mut Vec::new()).expect("in range as it is");
    let error = error(&model, 1e3);
    assert!(matches!(error, ExportError::ModelRange { brush: 1, .. }), "{error}");
    assert!(error.to_string().starts_with("brush 1 (counted from 0) is beyond the range of model files"), "{error}");
}

/// Vertices that the reader would refuse.
#[test]
fn meshes_that_leave_the_range_are_named() {
    let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    for (far, scale) in [(1e30, 2.0), (1.3e30, 1.0), (1e300, 1e10), (1e-300, 1e-20), (5e-324, 1.0)] {
        let closed = ClosedMesh::new(&[DVec3::ZERO, DVec3::X * far, DVec3::Y, DVec3::Z], &triangles, |_| 0);
        let mesh = MeshBody::new(closed.expect("closed"), vec![MaterialId(0)]);
        let model = Model { materials: vec![Material::named("t")], tree: Tree::from(cube()) - mesh.into() };
        let error = error(&model, scale);
        assert!(matches!(error, ExportError::ModelRange { brush: 1, .. }), "{error}");
        assert!(error.to_string().contains("found a vertex at ["), "{error}");
    }
}

#[test]
fn looks_that_no_file_can_hold_are_named() {
    for value in [1.5, -0.25, f32::NAN, f32::INFINITY] {
        let plain = Material::named("shiny \"\n");
        for material in [
            Material { color: Some([0.0, value, 1.0]), ..plain.clone() },
            Material { metallic: Some(value), ..plain.clone() },
            Material { roughness: Some(value), ..plain.clone() },
        ] {
            let error = error(&Model { materials: vec![material], tree: cube().into() }, 1.0).to_string();
            let expected = format!(
                "material \"shiny \\\"\\n\": found a colour, metalness or roughness of {value}, expected a number from 0 to 1"
            );
            assert_eq!(error, expected);
        }
    }
}

#[test]
fn errors_of_the_output_are_passed_on() {
    let mut random = Rng::new(8);
    let materials = materials(&mut random);
    let trees: Vec<Tree> = (0..300).map(|_| any_tree(&mut random, 3, &mut any_brush)).collect();
    let model = Model { materials, tree: Tree::xor(trees) };
    let mut text = Vec::new();
    write_model(&model, 1.0, &mut text).expect("written");
    assert!(text.len() > 200_000, "several pieces: {}", text.len());
    for room in (0..text.len()).step_by(997).chain([text.len() - 1]) {
        let error = write_model(&model, 1.0, &mut Full(room)).expect_err("full");
        assert!(matches!(&error, ExportError::Io(source) if source.kind() == io::ErrorKind::StorageFull), "{error}");
        assert!(error.to_string().starts_with("cannot write: "), "{error}");
    }
    write_model(&model, 1.0, &mut Full(text.len())).expect("as much room as it takes");
}
