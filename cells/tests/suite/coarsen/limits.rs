//! Caps, regions kept clear, materials and thickness.

use glam::DVec3;
use planecut_cells::Solid;
use planecut_cells::coarsen::{CoarsenError, CoarsenOptions, coarsen};
use planecut_csg::{Brush, Evaluation, Material, MaterialId, Model, Tree, evaluate};
use planecut_shapes::primitives;

use super::cases::{at_most, block};
use super::judge::assert_sound;

fn mesh_of(cell: &Brush) -> Evaluation {
    let materials = vec![Material::named("any"); 2];
    evaluate(&Model { materials, tree: cell.clone().into() }).expect("a bounded cell")
}

/// A wall with a door and a window.
fn wall() -> (Tree, Tree) {
    let openings = block([1.0, -1.0, 0.0], [2.0, 2.0, 2.0]) | block([4.0, -1.0, 1.0], [5.0, 2.0, 2.0]);
    (block([0.0; 3], [7.0, 1.0, 3.0]) - openings.clone(), openings)
}

#[test]
fn nothing_grows_into_an_opening() {
    let (wall, openings) = wall();
    let closed = coarsen(&wall, &[], &at_most(1)).expect("coarsened");
    assert!((closed.volume_out - 21.0).abs() < 1e-12);
    for cells in [1, 3, 5, 6] {
        let options = CoarsenOptions { keep_clear: Some(openings.clone()), ..at_most(cells) };
        let open = coarsen(&wall, &[], &options).expect("coarsened");
        let reach = Solid::from_tree(&(Tree::union_of(open.cells.clone()) & openings.clone()));
        assert!(reach.is_empty(), "{cells}: {:?} of the openings is filled", reach.volume());
        assert_sound(&wall, &open);
    }
}

#[test]
fn what_lies_apart_from_a_region_may_be_filled() {
    let steps = Tree::union((0..4).map(f64::from).map(|k| block([k, 0.0, 0.0], [k + 1.0, 1.0, k + 1.0])));
    // above the second step: it lies within the ramp, and the others may be merged still
    let bird = block([1.25, 0.25, 2.05], [1.5, 0.75, 2.25]);
    let options = CoarsenOptions { keep_clear: Some(bird.clone()), ..at_most(1) };
    let kept = coarsen(&steps, &[], &options).expect("coarsened");
    assert!(kept.cells.len() < 4, "{}", kept.cells.len());
    assert!(Solid::from_tree(&(Tree::union_of(kept.cells.clone()) & bird)).is_empty());
    assert_sound(&steps, &kept);
}

#[test]
fn a_region_that_the_solid_fills_already_is_no_hindrance() {
    let steps = block([0.0; 3], [1.0; 3]) | block([1.0, 0.0, 0.0], [2.0, 1.0, 2.0]);
    let inside = block([0.25; 3], [0.5; 3]);
    let options = CoarsenOptions { keep_clear: Some(inside), ..at_most(1) };
    assert_eq!(coarsen(&steps, &[], &options).expect("coarsened").cells.len(), 1);
}

#[test]
fn materials_stay_apart_where_that_is_asked() {
    let part = |k: u32| {
        let corner = [f64::from(k), 0.0, 0.0];
        block(corner, [f64::from(k) + 1.0, 1.0, 1.0]).with_material(MaterialId(k / 3))
    };
    let bar = Tree::union((0..6).map(part));
    let one = coarsen(&bar, &[], &CoarsenOptions::default()).expect("coarsened");
    assert_eq!(one.cells.len(), 1);
    for options in [CoarsenOptions::default(), at_most(1)] {
        let two = coarsen(&bar, &[], &CoarsenOptions { by_material: true, ..options }).expect("coarsened");
        let materials = two.cells.iter().map(|cell| cell.faces[0].material.0).collect::<Vec<_>>();
        assert_eq!((two.cells.len(), two.excess()), (2, 0.0));
        assert!(materials.contains(&0) && materials.contains(&1));
    }
}

#[test]
fn cells_have_no_more_faces_and_vertices_than_asked() {
    let balls = |k: f64| {
        Tree::from(primitives::sphere(1.0, 24, MaterialId(0)).expect("a sphere"))
            .transformed(&planecut_csg::Transform::translation(DVec3::new(1.7 * k, 0.0, 0.3 * k)).expect("a shift"))
            .expect("in range")
    };
    let tree = Tree::union((0..3).map(f64::from).map(balls));
    let limits = [(Some(6), None), (Some(20), None), (None, Some(8)), (None, Some(32)), (Some(40), Some(30))];
    for (max_faces, max_vertices) in limits {
        for cells in [3, 1] {
            let options = CoarsenOptions { max_faces, max_vertices, ..at_most(cells) };
            let capped = coarsen(&tree, &[], &options).expect("coarsened");
            for cell in &capped.cells {
                let mesh = mesh_of(cell).mesh;
                assert!(mesh.faces.len() <= max_faces.unwrap_or(usize::MAX), "{} faces", mesh.faces.len());
                assert!(
                    mesh.positions.len() <= max_vertices.unwrap_or(usize::MAX),
                    "{} vertices",
                    mesh.positions.len()
                );
            }
            assert_sound(&tree, &capped);
        }
    }
}

#[test]
fn a_cap_that_a_region_does_not_allow_is_refused() {
    let ball = Tree::from(primitives::sphere(1.0, 24, MaterialId(0)).expect("a sphere"));
    // all around it
    let around = block([-3.0; 3], [3.0; 3]) - ball.clone();
    let options = CoarsenOptions { max_faces: Some(20), keep_clear: Some(around), ..CoarsenOptions::default() };
    assert!(matches!(coarsen(&ball, &[], &options), Err(CoarsenError::Blocked { .. })));
}

#[test]
fn thin_cells_grow_to_the_thickness_asked() {
    let plate = block([0.0; 3], [4.0, 3.0, 0.125]);
    let options = CoarsenOptions { min_thickness: Some(0.5), ..CoarsenOptions::default() };
    let thick = coarsen(&plate, &[], &options).expect("coarsened");
    let found = mesh_of(&thick.cells[0]).solid;
    assert!((found.volume - 6.0).abs() < 1e-9, "{}", found.volume);
    // on both sides alike
    assert!((found.centroid - DVec3::new(2.0, 1.5, 0.0625)).length() < 1e-9);
    assert_sound(&plate, &thick);
    // a floor below that is to stay clear
    let floor = block([-1.0, -1.0, -1.0], [5.0, 4.0, 0.0]);
    let options = CoarsenOptions { keep_clear: Some(floor), ..options };
    let above = mesh_of(&coarsen(&plate, &[], &options).expect("coarsened").cells[0]).solid;
    assert!((above.volume - 6.0).abs() < 1e-9 && above.min.z == 0.0, "{above:?}");
    // a needle is thin in two directions
    let needle = block([0.0; 3], [4.0, 0.125, 0.125]);
    let options = CoarsenOptions { min_thickness: Some(0.5), ..CoarsenOptions::default() };
    let grown = mesh_of(&coarsen(&needle, &[], &options).expect("coarsened").cells[0]).solid;
    assert!(grown.volume >= 4.0 * 0.25 - 1e-9, "{}", grown.volume);
}
