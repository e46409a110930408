//! The text itself: a brush a line, indented by depth.

use planecut_csg::{Brush, ClosedMesh, Material, MaterialId, MeshBody, Model, Transform, Tree};
use planecut_kernel::{DVec3, HalfSpace};

use super::support::written;

#[test]
fn people_can_read_it() {
    let materials = vec![
        Material { color: Some([0.56, 0.25, 1.0]), metallic: Some(1.0), ..Material::named("steel") },
        Material::named("wood"),
    ];
    let half_space = |normal: [f64; 3], offset| HalfSpace::new(normal, offset).expect("in range");
    let mut wedge =
        Brush::from_half_spaces([half_space([1.0, 0.5, 0.0], 2.25), half_space([0.0, 0.0, -1.0], 1e-7)], MaterialId(0));
    wedge.faces[1].material = MaterialId(1);
    wedge.name = Some("door \"é\"".to_owned());
    let half = Brush::from_half_spaces([half_space([0.0, -0.0, 3.0], -1e20)], MaterialId(1));
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let closed = ClosedMesh::new(&positions, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], |k| u32::from(k == 3));
    let mesh = MeshBody::new(closed.expect("closed"), vec![MaterialId(1), MaterialId(0)]);
    let moved = mesh.transformed(&Transform::translation(DVec3::new(0.5, 0.0, 9.0)).unwrap()).expect("in range");
    let tree = (Tree::from(wedge) - !Tree::from(half)) | moved.into();
    assert_eq!(
        written(&Model { materials, tree }, 1.0),
        r#"{
  "planecut": 1,
  "materials": {
    "steel": {"color": [0.56, 0.25, 1], "metallic": 1},
    "wood": {}
  },
  "model":
    {"union": [
      {"difference": [
        {"name": "door \"é\"", "halfspaces": [[1, 0.5, 0, 2.25], [0, 0, -1, 1e-7]], "materials": ["steel", "wood"]},
        {"complement":
          {"material": "wood", "halfspaces": [[0, -0.0, 3, -1e20]]}
        }
      ]},
      {"matrix": [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 9]], "mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "materials": ["wood", "wood", "wood", "steel"]}}
    ]}
}
"#
    );
}

/// Materials of one name are one in a file: those that look different get names of their own.
#[test]
fn materials_of_one_name_are_told_apart() {
    let red = Material { color: Some([1.0, 0.0, 0.0]), ..Material::named("paint") };
    let materials = vec![Material::named("paint"), red, Material::named("paint")];
    let face = |material| Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(material));
    let text = written(&Model { materials, tree: Tree::union_of((0..3).map(face).collect()) }, 1.0);
    let of_brushes: Vec<&str> =
        text.lines().filter_map(|line| line.split("\"material\": ").nth(1)?.split(',').next()).collect();
    assert_eq!(of_brushes, ["\"paint\"", "\"paint 2\"", "\"paint\""]);
    assert_eq!(text.matches("\"paint 2\": {\"color\": [1, 0, 0]}").count(), 1);
}
