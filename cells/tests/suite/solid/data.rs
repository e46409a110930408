//! Cells that another program made: a packing of 216 Voronoi cells in a box.

use glam::DVec3;
use planecut_cells::Solid;
use planecut_check::check_topology;
use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
use planecut_testkit::data::data;
use planecut_testkit::scene::half_space;

planecut_testkit::tests_on_data!(a_packing_of_voronoi_cells_fills_its_box, the_skin_of_a_packing_is_that_of_its_box);

/// Volume and half-spaces of each cell.
fn packing() -> (f64, Vec<(f64, Brush)>) {
    let text = std::fs::read_to_string(data("cells/pack_six_cube.cells.json")).expect("a text");
    let number = |text: &str, key: &str| {
        let rest = text.split(key).nth(1).expect("the key").trim_start_matches([':', ' ', '"']);
        let end = rest.find([',', '}']).expect("an end");
        rest[..end].trim().parse::<f64>().expect("a number")
    };
    let cells = text.split("\"site\"").skip(1).map(|cell| {
        let rows = cell.split("\"halfspaces\": [").nth(1).expect("half-spaces").split('[').skip(1);
        let planes = rows.map(|row| {
            let numbers = row.split(']').next().expect("a row").split(',');
            let row: Vec<f64> = numbers.map(|v| v.trim().parse().expect("a number")).collect();
            half_space(DVec3::new(row[0], row[1], row[2]), row[3])
        });
        (number(cell, "\"volume"), Brush::from_half_spaces(planes, MaterialId(0)))
    });
    (number(&text, "\"box_volume"), cells.collect())
}

fn a_packing_of_voronoi_cells_fills_its_box() {
    let (whole, cells) = packing();
    assert_eq!((cells.len(), whole), (216, 216.0));
    for (volume, brush) in &cells {
        let found = Solid::from(brush.clone()).volume().expect("a bounded cell");
        assert!((found - volume).abs() <= 1e-12 * volume, "{found} {volume}");
    }
    let tree = Tree::union_of(cells.into_iter().map(|(_, brush)| brush).collect());
    let solid = Solid::from_tree(&tree);
    let volume = solid.volume().expect("a bounded solid");
    assert!((volume - whole).abs() <= 1e-12 * whole, "{volume}");
    let mut joined = Solid::empty();
    for brush in tree.brushes() {
        joined |= &Solid::from(brush.clone());
    }
    assert!((joined.volume().expect("a bounded solid") - whole).abs() <= 1e-12 * whole);
    assert!((&joined ^ &solid).volume().expect("a bounded solid") < 1e-12 * whole);
    let area = solid.area().expect("a skin");
    assert!((area - 216.0).abs() <= 1e-12 * whole, "walls are left: {area}");
}

/// Where more than three walls of the decimal planes meet, hair-thin gaps are left between cells; nobody wants to see them.
fn the_skin_of_a_packing_is_that_of_its_box() {
    let (_, cells) = packing();
    let tree = Tree::union_of(cells.into_iter().map(|(_, brush)| brush).collect());
    let (mesh, _) = Solid::from_tree(&tree).mesh(&[Material::default()]).expect("a mesh");
    assert_eq!(mesh.faces.len(), 6);
    let topology = check_topology(&mesh.positions, &mesh.triangles);
    assert!(topology.watertight && topology.manifold);
    let skin = evaluate(&Model { materials: vec![Material::default()], tree }).expect("a skin");
    assert_eq!(skin.mesh.faces.len(), 6);
}
