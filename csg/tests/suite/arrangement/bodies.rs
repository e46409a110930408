//! Trees of convex bodies and closed meshes: the same solid as with convex bodies alone.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{
    Brush, ClosedMesh, EvaluateError, Evaluation, Material, MaterialId, MeshBody, Model, Operation, Transform, Tree,
    evaluate,
};
use planecut_testkit::meshes::box_mesh;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{cuboid, half_space, scaled};

fn box_leaf(low: DVec3, high: DVec3) -> Brush {
    let mesh = box_mesh(low, high, "stone");
    let closed = ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect("a box is closed");
    Brush::of_mesh(MeshBody::new(closed, vec![MaterialId(0)]))
}

fn solid(tree: Tree) -> Evaluation {
    let evaluation = evaluate(&Model { materials: vec![Material::named("stone")], tree }).expect("a mesh");
    let report = check_mesh(&evaluation.mesh.positions, &evaluation.mesh.triangles, &CheckOptions::default());
    assert!(report.is_sound(), "{report:?}");
    evaluation
}

fn assert_same(one: &Evaluation, other: &Evaluation, seed: u64) {
    let (p, q) = (one.solid, other.solid);
    let slack = 1e-9 * (1.0 + q.volume + q.area);
    assert!((p.volume - q.volume).abs() < slack, "seed {seed}: volume {}, expected {}", p.volume, q.volume);
    assert!((p.area - q.area).abs() < slack, "seed {seed}: area {}, expected {}", p.area, q.area);
}

/// A nested tree over leaves, the same for the same numbers drawn.
fn tree_of(leaves: Vec<Brush>, rng: &mut Rng) -> Tree {
    let operations = [Operation::Union, Operation::Difference, Operation::Intersection, Operation::Xor];
    let mut trees: Vec<Tree> = leaves.into_iter().map(Tree::from).collect();
    while trees.len() > 1 {
        let count = (2 + rng.below(2)).min(trees.len());
        let operands: Vec<Tree> = trees.drain(..count).collect();
        trees.push(Tree::combine(operations[rng.below(4)], operands));
    }
    trees.pop().expect("a tree")
}

/// Boxes on a small grid, some of them as meshes, some turned and stretched by whole numbers (3-4-5), so that nothing is rounded.
#[test]
fn boxes_are_the_same_as_brushes_and_as_meshes() {
    for seed in 0..scaled(400) {
        let mut rng = Rng::spread(seed + 50_000);
        let turn =
            Transform::from_columns([[4.0, 3.0, 0.0], [-3.0, 4.0, 0.0], [0.0, 0.0, 5.0], [0.0; 3]]).expect("a turn");
        let is_turned = rng.chance(0.5);
        let (mut brushes, mut mixed) = (Vec::new(), Vec::new());
        for k in 0..3 + rng.below(4) {
            let low = DVec3::from_array([0; 3].map(|_| rng.below(4) as f64));
            let high = low + DVec3::from_array([0; 3].map(|_| 1.0 + rng.below(3) as f64));
            let is_mesh = k == 0 || rng.chance(0.4);
            let [brush, leaf] = [cuboid(low, high), if is_mesh { box_leaf(low, high) } else { cuboid(low, high) }];
            let place = |leaf: Brush| if is_turned { leaf.transformed(&turn).expect("a turn") } else { leaf };
            brushes.push(place(brush));
            mixed.push(place(leaf));
        }
        let draw = rng.bits();
        let [expected, found] = [brushes, mixed].map(|leaves| solid(tree_of(leaves, &mut Rng::spread(draw))));
        assert_same(&found, &expected, seed);
    }
}

/// Bodies with corners that no numbers hold, which touch each other, beside a mesh that is far away.
#[test]
fn bodies_keep_their_exact_corners_beside_a_mesh() {
    for seed in 0..scaled(200) {
        let mut rng = Rng::spread(seed + 60_000);
        let count = 3 + rng.below(6);
        // cells around an axis, each between two planes through it
        let side = |k: usize| {
            let angle = std::f64::consts::TAU * (k % count) as f64 / count as f64;
            DVec3::new(-angle.sin(), angle.cos(), 0.0)
        };
        let slope = rng.float(-0.7, 0.7);
        let cells: Vec<Brush> = (0..count)
            .map(|k| {
                let middle = std::f64::consts::TAU * (k as f64 + 0.5) / count as f64;
                let out = DVec3::new(middle.cos(), middle.sin(), slope);
                planecut_testkit::scene::brush([
                    half_space(-side(k), 0.0),
                    half_space(side(k + 1), 0.0),
                    half_space(out, 2.0),
                    half_space(DVec3::Z, 1.0),
                    half_space(-DVec3::Z, 0.3),
                ])
            })
            .collect();
        let far = || Tree::from(box_leaf(DVec3::splat(50.0), DVec3::splat(51.0)));
        let cut = cuboid(DVec3::new(-0.5, -9.0, 0.1), DVec3::new(0.5, 9.0, 0.6));
        let all = Tree::union_of(cells) - cut.into();
        let alone = solid(all.clone());
        let mut beside = solid(Tree::union([all.clone(), far()]));
        beside.solid.volume -= 1.0;
        beside.solid.area -= 6.0;
        assert_same(&beside, &alone, seed);
        let nothing = solid(Tree::difference([all.clone(), all.clone()]) | far());
        assert_eq!((nothing.solid.volume, nothing.mesh.triangles.len()), (1.0, 12), "seed {seed}");
        let twice = solid(Tree::union([all.clone(), all, far()]));
        beside.solid.volume += 1.0;
        beside.solid.area += 6.0;
        assert_same(&twice, &beside, seed);
    }
}

#[test]
fn half_spaces_cut_meshes_and_do_not_end() {
    let cube = || Tree::from(box_leaf(DVec3::splat(-1.0), DVec3::ONE));
    let half = || Tree::from(planecut_testkit::scene::brush([half_space(DVec3::new(1.0, 2.0, 3.0), 0.0)]));
    assert!((solid(cube() - half()).solid.volume - 4.0).abs() < 1e-12);
    assert!((solid(cube() & half().complement()).solid.volume - 4.0).abs() < 1e-12);
    let model = |tree| Model { materials: vec![Material::named("stone")], tree };
    // all of space less six half-spaces is a cube
    let space = Tree::everything();
    let sides = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let outside = sides.map(|side| Tree::from(planecut_testkit::scene::brush([half_space(-side, -2.0)])));
    let block = Tree::difference(std::iter::once(space).chain(outside));
    assert!((solid(block - cube()).solid.volume - 56.0).abs() < 1e-12);
    for tree in [cube() | half(), cube().complement(), half() - cube()] {
        assert!(matches!(evaluate(&model(tree)), Err(EvaluateError::Unbounded)));
    }
    let summary = evaluate(&model(cube() - half())).expect("a mesh").model;
    assert_eq!((summary.brushes, summary.unbounded, summary.empty), (2, vec![1], Vec::new()));
}
