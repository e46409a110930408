//! From a tree to a mesh, cells and edits: no stage may ask for a clock or for threads.

use std::collections::HashSet;

use planecut_cells::Solid;
use planecut_cells::coarsen::{CoarsenOptions, coarsen};
use planecut_csg::{Brush, Evaluation, LiveModel, Material, MaterialId, Model, Tree, evaluate};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_shapes::primitives;

const STONE: MaterialId = MaterialId(0);

pub(crate) fn check() {
    booleans_have_their_volumes();
    a_grid_of_touching_cubes_is_one_block();
    a_drilled_block_is_closed();
    cells_are_made_and_coarsened();
    an_edit_is_what_a_fresh_evaluation_is();
}

/// The cube from `min` to `max` in each coordinate.
fn cube(min: f64, max: f64) -> Brush {
    Brush::cuboid(DVec3::splat(min), DVec3::splat(max), STONE)
}

fn model(tree: Tree) -> Model {
    Model { materials: vec![Material::named("stone")], tree }
}

fn mesh_of(tree: Tree) -> Evaluation {
    evaluate(&model(tree)).expect("the tree has a mesh")
}

fn booleans_have_their_volumes() {
    let pair = || (Tree::from(cube(0.0, 2.0)), Tree::from(cube(1.0, 3.0)));
    let (a, b) = pair();
    assert_eq!(mesh_of(a | b).solid.volume, 15.0);
    let (a, b) = pair();
    assert_eq!(mesh_of(a - b).solid.volume, 7.0);
    let (a, b) = pair();
    assert_eq!(mesh_of(a & b).solid.volume, 1.0);
}

fn a_grid_of_touching_cubes_is_one_block() {
    let corners = (0..27).map(|k| DVec3::from_array([k % 3, k / 3 % 3, k / 9].map(f64::from)));
    let cubes = corners.map(|corner| Tree::from(Brush::cuboid(corner, corner + 1.0, STONE)));
    let block = mesh_of(cubes.reduce(|union, cube| union | cube).expect("there are cubes"));
    assert_eq!((block.solid.volume, block.mesh.faces.len(), block.mesh.positions.len()), (27.0, 6, 8));
}

fn a_drilled_block_is_closed() {
    let drill = || Tree::from(primitives::prism(3.0, 0.5, 32, STONE).expect("it has an interior"));
    let hole = mesh_of(drill() & cube(-1.0, 1.0).into()).solid.volume;
    let drilled = mesh_of(Tree::from(cube(-1.0, 1.0)) - drill());
    assert!((drilled.solid.volume + hole - 8.0).abs() < 1e-12);
    let triangles = &drilled.mesh.triangles;
    let edges: HashSet<[u32; 2]> = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
    assert!(edges.len() == 3 * triangles.len() && edges.iter().all(|[a, b]| edges.contains(&[*b, *a])));
}

fn cells_are_made_and_coarsened() {
    let shell = || Tree::from(cube(0.0, 3.0)) - cube(1.0, 2.0).into();
    let solid = Solid::from_tree(&shell());
    assert_eq!(solid.volume(), Some(26.0));
    let coarse = coarsen(&shell(), &[], &CoarsenOptions::default()).expect("it has cells");
    assert!(coarse.cells.len() <= coarse.cells_in && coarse.volume_out >= 26.0 - 1e-9);
}

fn an_edit_is_what_a_fresh_evaluation_is() {
    let mut live = LiveModel::from_model(model(Tree::from(cube(0.0, 2.0)))).expect("the brush has a mesh");
    let brush = live.brushes().next().expect("there is a brush");
    let before = live.mesh().expect("it closes");
    let half_space = HalfSpace::new([1.0, 1.0, 1.0], 5.0).expect("it is accepted");
    let (plane, _) = live.add_plane(brush, half_space, STONE).expect("the plane cuts a corner off");
    let fresh = evaluate(&live.to_model()).expect("the model has a mesh");
    assert_eq!(live.mesh().expect("it closes").positions.len(), fresh.mesh.positions.len());
    live.remove_plane(brush, plane).expect("the plane is there");
    assert_eq!(live.mesh().expect("it closes").positions.len(), before.positions.len());
}
