//! What is easily forgotten: empty, unbounded, deep and wide.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{
    Brush, EvaluateError, Evaluation, Material, MaterialId, Model, Transform, Tree, UnboundedBrushes, evaluate,
};
use planecut_kernel::HalfSpace;

use planecut_testkit::soundness::evaluate_soundly_with;

fn block(min: f64, max: f64) -> Tree {
    Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)))
}

fn below(normal: DVec3, offset: f64) -> Tree {
    let half_space = HalfSpace::new(normal, offset).expect("a plane");
    Tree::from(Brush::from_half_spaces([half_space], MaterialId(0)))
}

fn model(tree: Tree) -> Model {
    Model { materials: vec![Material::named("a"), Material::named("b")], tree }
}

fn sound(tree: Tree) -> Evaluation {
    evaluate_soundly_with(&model(tree), UnboundedBrushes::Keep).expect("a sound mesh")
}

#[test]
fn an_empty_result_is_a_result() {
    for tree in [
        Tree::empty(),
        block(0.0, 1.0) - block(0.0, 1.0),
        block(0.0, 1.0) & block(1.0, 2.0),
        block(0.0, 1.0) - Tree::everything(),
        !Tree::everything(),
        block(0.0, 1.0) - below(DVec3::Z, 4.0),
        Tree::difference([]),
        Tree::xor([]),
    ] {
        let evaluation = sound(tree);
        assert_eq!((evaluation.mesh.triangles.len(), evaluation.solid.volume), (0, 0.0));
    }
}

/// A unit cube, turned so that no plane is exact.
fn turned(min: [f64; 3], max: [f64; 3]) -> Tree {
    let turn = Transform::rotation(DVec3::new(1.0, 2.0, 3.0), 33.0).expect("a rotation");
    Tree::from(Brush::cuboid(min, max, MaterialId(0))).transformed(&turn).expect("in range")
}

#[test]
fn tools_without_end_cut_what_they_cut_and_bodies_far_away_change_nothing() {
    for reach in [1e3, 1e9, 1e12, 1e15] {
        let cube = || turned([0.0; 3], [1.0; 3]);
        let below = || turned([-reach; 3], [reach, reach, 0.25]);
        let above = || turned([-reach, -reach, 0.75], [reach; 3]);
        let slab = || turned([-reach, -reach, 0.25], [reach, reach, 0.75]);
        let shift = Transform::translation(DVec3::new(reach, 0.0, 0.0)).expect("a shift");
        let plate = || turned([0.0; 3], [1.0, 1.0, 1e-3]);
        for (tree, volume) in [
            (cube() - below(), 0.75),
            (cube() - below() - above(), 0.5),
            (cube() - slab(), 0.5),
            (cube() & slab(), 0.5),
            (plate() - below(), 0.0),
            (plate() - above(), 1e-3),
        ] {
            let found = sound(tree.clone()).solid.volume;
            assert!((found - volume).abs() < 1e-12, "{reach:e}: {found}, expected {volume}");
            // a body far away, from which the rest is cut again
            let far = cube().transformed(&shift).expect("in range");
            let found = sound((tree | far) & turned([-2.0; 3], [2.0; 3])).solid.volume;
            assert!((found - volume).abs() < 1e-12, "{reach:e}, beside a body far away: {found}, expected {volume}");
        }
    }
}

#[test]
fn only_an_unbounded_result_is_refused() {
    for tree in [
        Tree::everything(),
        !block(0.0, 1.0),
        below(DVec3::X, 0.0),
        below(DVec3::X, 0.0) - block(0.0, 1.0),
        below(DVec3::new(0.3, -0.7, 0.1), 1e-9) & below(DVec3::new(-0.3, 0.7, 0.1), 2.0),
        block(0.0, 1.0) | below(-DVec3::Y, -1e12),
        Tree::xor([block(0.0, 1.0), Tree::everything()]),
        !Tree::empty(),
    ] {
        assert_eq!(evaluate(&model(tree)).err(), Some(EvaluateError::Unbounded));
    }
    let wedge = below(DVec3::ONE, 3.0) & !below(DVec3::X, 0.0) & !below(DVec3::Y, 0.0) & !below(DVec3::Z, 0.0);
    assert_eq!(sound(wedge).solid.volume, 4.5);
    let hollow = !(!block(0.0, 3.0) | block(1.0, 2.0));
    assert_eq!(sound(hollow).solid.volume, 26.0);
}

#[test]
fn a_needle_far_beyond_its_planes_is_bounded() {
    // two planes that meet the floor 1e9 away, and are met there
    let slope = |sign: f64| below(DVec3::new(1e-9, 0.0, sign), 1.0);
    let sides = below(DVec3::Y, 1.0) & below(-DVec3::Y, 1.0) & below(-DVec3::X, 0.0);
    let volume = sound(slope(1.0) & slope(-1.0) & sides).solid.volume;
    assert!((volume - 2e9).abs() < 1e-3, "{volume}");
}

#[test]
fn a_chain_of_ten_thousand_operations_needs_no_deep_stack() {
    let mut tree = block(0.0, 1.0);
    let count = 10_000;
    for k in 1..count {
        let at = DVec3::new(f64::from(k / 100), f64::from(k % 100), 0.0);
        let cube = Tree::from(Brush::cuboid(at, at + 1.0, MaterialId(0)));
        // every other one is taken away again from what was added so far
        tree = if k % 2 == 0 { tree | cube } else { Tree::difference([tree, cube]) };
    }
    let volume = sound(tree).solid.volume;
    assert_eq!(volume, f64::from(count / 2));
}

#[test]
fn a_deep_right_leaning_tree_is_evaluated() {
    // a0 − (a1 − (a2 − …)) of nested boxes: every other shell
    let mut tree = block(-1.0, 1.0);
    for k in 2..300 {
        tree = block(f64::from(-k), f64::from(k)) - tree;
    }
    let expected: f64 =
        (1..300).map(|k| if k % 2 == 1 { 8.0 * f64::from(k).powi(3) } else { -8.0 * f64::from(k).powi(3) }).sum();
    assert_eq!(sound(tree).solid.volume, expected.abs());
}

#[test]
fn tools_that_only_touch_leave_the_material_alone() {
    let tool = |min: DVec3, max: DVec3| Tree::from(Brush::cuboid(min, max, MaterialId(1)));
    let touching = block(0.0, 2.0) - tool(DVec3::new(0.0, 0.0, 2.0), DVec3::new(2.0, 2.0, 3.0));
    assert!(sound(touching).mesh.faces.iter().all(|face| face.material == MaterialId(0)));
    let cutting = block(0.0, 2.0) - tool(DVec3::new(0.0, 0.0, 1.0), DVec3::new(2.0, 2.0, 3.0));
    let faces = sound(cutting).mesh.faces;
    let top: Vec<_> = faces.iter().filter(|face| face.normal == DVec3::Z).collect();
    assert_eq!(top.len(), 1);
    assert_eq!(top[0].material, MaterialId(1), "a cut face is of the tool's material");
}

#[test]
fn unknown_materials_are_refused() {
    let tree = block(0.0, 1.0).with_material(MaterialId(2));
    let expected = EvaluateError::UnknownMaterial { material: MaterialId(2), count: 2 };
    assert_eq!(evaluate(&model(tree)).err(), Some(expected));
}

/// Where an exclusive or alternates around a line, faces cross there that are the same on both sides of it.
#[test]
fn faces_that_cross_in_a_line_are_cut_there() {
    let slabs = [DVec3::Y, DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, -1.0, 1.0)].map(|normal| below(normal, 0.0));
    let tree = Tree::xor(slabs) & block(-1.0, 1.0);
    let evaluation = sound(tree);
    assert_eq!(evaluation.solid.volume, 4.0);
    let report = check_mesh(&evaluation.mesh.positions, &evaluation.mesh.triangles, &CheckOptions::default());
    assert_eq!(report.first_problem(), None);
}
