//! Parts that are alike share a mesh.

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_export::{ExportOptions, Part};

use super::support::written;
use planecut_testkit::meshes::{box_mesh, cube_with_hole};

fn moved(mesh: &Mesh, by: DVec3) -> Mesh {
    Mesh { positions: mesh.positions.iter().map(|position| *position + by).collect(), ..mesh.clone() }
}

#[test]
fn copies_are_where_they_belong() {
    let one = cube_with_hole();
    // no multiple of anything: the copies' own coordinates are rounded
    let places = [DVec3::ZERO, DVec3::new(10.1, -3.3, 0.7), DVec3::new(1e3 / 3.0, 7.7, -900.3)];
    let copies = places.map(|place| moved(&one, place));
    let other = box_mesh(DVec3::splat(50.0), DVec3::splat(51.0), "outside");
    let parts: Vec<Part<'_>> = copies.iter().chain([&other]).map(|mesh| Part::new("m", mesh)).collect();
    let file = written(&parts, &ExportOptions::default());
    assert_eq!(file.json["meshes"].as_array().map(Vec::len), Some(2));
    assert_eq!(file.json["nodes"].as_array().map(Vec::len), Some(5));
    for (part, mesh) in file.parts.iter().zip(copies.iter().chain([&other])) {
        let found: Vec<DVec3> = part.iter().flat_map(|p| &p.vertices).map(|vertex| vertex.position).collect();
        for position in &mesh.positions {
            assert!(found.iter().any(|other| other.abs_diff_eq(*position, 1e-6)), "{position}");
        }
    }
}

#[test]
fn what_looks_different_is_no_copy() {
    let one = box_mesh(DVec3::ZERO, DVec3::ONE, "red");
    let painted = box_mesh(DVec3::splat(3.0), DVec3::splat(4.0), "blue");
    let larger = box_mesh(DVec3::splat(6.0), DVec3::splat(6.0) + DVec3::new(1.0, 1.0, 1.0001), "red");
    let parts = [&one, &painted, &larger].map(|mesh| Part::new("m", mesh));
    assert_eq!(written(&parts, &ExportOptions::default()).json["meshes"].as_array().map(Vec::len), Some(3));
}
