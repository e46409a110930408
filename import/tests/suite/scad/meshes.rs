//! Polyhedra and imports that are not convex: one closed mesh each, cells only where convex bodies are needed.

use std::path::Path;

use planecut_csg::{Brush, evaluate};
use planecut_import::scad::{ScadOptions, read_scad};

use super::{assert_volume, read};

/// An L of 2 × 2 less 1 × 1, one unit high.
const L: &str = "polyhedron(points = [[0,0,0],[2,0,0],[2,1,0],[1,1,0],[1,2,0],[0,2,0],[0,0,1],[2,0,1],[2,1,1],[1,1,1],[1,2,1],[0,2,1]], \
    faces = [[0,1,2,3,4,5],[11,10,9,8,7,6],[6,7,1,0],[7,8,2,1],[8,9,3,2],[9,10,4,3],[10,11,5,4],[11,6,0,5]]);";

/// Two cubes of 2 in one polyhedron, a corner of each within the other.
fn crossing() -> String {
    let corner = |k: u32, by: u32| format!("[{},{},{}]", (k & 1) * 2 + by, (k >> 1 & 1) * 2 + by, (k >> 2) * 2 + by);
    let points: Vec<String> = [0, 1].iter().flat_map(|by| (0..8).map(|k| corner(k, *by))).collect();
    let sides = [[1, 3, 2, 0], [6, 7, 5, 4], [4, 5, 1, 0], [3, 7, 6, 2], [2, 6, 4, 0], [5, 7, 3, 1]];
    let faces: Vec<String> =
        [0, 8].iter().flat_map(|first| sides.map(|side| format!("{:?}", side.map(|corner| corner + first)))).collect();
    format!("polyhedron(points = [{}], faces = [{}]);", points.join(","), faces.join(","))
}

#[test]
fn a_polyhedron_that_is_not_convex_is_one_mesh() {
    let import = read(L);
    let [leaf] = import.model.tree.brushes() else { panic!("one leaf") };
    assert!(leaf.is_mesh() && import.warnings.is_empty());
    assert_eq!(import.model.tree.source_line(0).map(u32::from), Some(1));
    assert_volume(L, 3.0);
    assert_volume(&format!("difference() {{ {L} cube([1, 1, 1]); }}"), 2.0);
    assert_volume(&format!("multmatrix([[-1,0,0,5],[0,1,0,0],[0,0,2,0],[0,0,0,1]]) {{ {L} }}"), 6.0);
    assert_volume(&format!("resize(newsize = [4, 4, 1]) {{ {L} }}"), 12.0);
}

#[test]
fn what_a_crossing_surface_winds_around_is_kept() {
    assert_volume(&crossing(), 15.0);
    assert_volume(&format!("intersection() {{ {} cube([3, 3, 1]); }}", crossing()), 4.0);
}

#[test]
fn sums_hulls_and_shadows_are_those_of_the_solid() {
    // arms twice as wide and high, one corner of 1 × 1 × 2 not filled
    assert_volume(&format!("minkowski() {{ {L} cube([1, 1, 1]); }}"), 16.0);
    assert!(read(&format!("minkowski() {{ {L} cube([1, 1, 1]); }}")).model.tree.brushes().iter().all(|b| !b.is_mesh()));
    assert_volume(&format!("hull() {{ {L} }}"), 3.5);
    assert_volume(&format!("linear_extrude(height = 2) projection(cut = false) {{ {L} }}"), 6.0);
    assert_volume(&format!("linear_extrude(height = 2) projection(cut = true) {{ {L} }}"), 6.0);
}

#[test]
fn an_import_is_a_mesh_in_the_colour_of_its_node() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let options = ScadOptions { folder, ..ScadOptions::default() };
    let text = br#"color([1, 0, 0]) { import(file = "l.obj"); } import(file = "open.obj");"#;
    let import = read_scad(text, "test.csg", &options).unwrap_or_else(|error| panic!("{error}"));
    let meshes: Vec<&Brush> = import.model.tree.brushes().iter().filter(|brush| brush.is_mesh()).collect();
    assert_eq!(meshes.len(), 1);
    assert!(meshes[0].materials().all(|material| import.model.materials[material.0 as usize].name == "#ff0000"));
    assert_eq!(evaluate(&import.model).expect("a solid").solid.volume, 3.0);
    let [warning] = &import.warnings[..] else { panic!("{:?}", import.warnings) };
    assert_eq!(warning.left_out, 1);
    assert!(warning.message.contains("found 4 open edges"), "{warning}");
}

/// The volume of a field of heights is the sum of the means of its cells, over the bottom.
#[test]
fn a_surface_is_a_closed_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("hill.dat"), "# heights\n0 1 2\n\n1 2 3\n2 3 10\n").expect("a file");
    std::fs::write(folder.path().join("torn.dat"), "0 1\n1 high\n").expect("a file");
    let options = ScadOptions { folder: folder.path().to_owned(), ..ScadOptions::default() };
    let solid = |text: &str| {
        let import = read_scad(text.as_bytes(), "test.csg", &options).expect("a tree");
        (evaluate(&import.model).expect("a mesh").solid, import.warnings)
    };
    let means = [[0.0, 1.0, 1.0, 2.0], [1.0, 2.0, 2.0, 3.0], [1.0, 2.0, 2.0, 3.0], [2.0, 3.0, 3.0, 10.0]];
    let volume: f64 = means.iter().map(|corners| corners.iter().sum::<f64>() / 4.0).sum::<f64>() + 4.0;
    let (hill, warnings) = solid("surface(file = \"hill.dat\", center = true, invert = false);");
    assert!((hill.volume - volume).abs() < 1e-12 && warnings.is_empty(), "{} {warnings:?}", hill.volume);
    assert_eq!((hill.min.to_array(), hill.max.to_array()), ([-1.0, -1.0, -1.0], [1.0, 1.0, 10.0]));
    let (cut, _) = solid("difference() { surface(file = \"hill.dat\"); cube([9, 9, 20]); }");
    assert_eq!(cut.volume, 4.0, "what lies below 0");
    for (file, why) in [("torn.dat", "`torn.dat`:2: found `high`"), ("gone.dat", "cannot be read")] {
        let (nothing, warnings) = solid(&format!("surface(file = \"{file}\"); cube(1);"));
        assert_eq!(nothing.volume, 1.0);
        assert!(warnings.iter().any(|warning| warning.message.contains(why)), "{warnings:?}");
    }
}
