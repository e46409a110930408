//! Random models come back.

use planecut_csg::{Brush, MaterialId, Model, Tree, evaluate};
use planecut_kernel::DVec3;
use planecut_testkit::random::Rng;

use super::support::{any_brush, any_tree, assert_same_leaves, assert_same_tree, back, materials, read, written};

#[test]
fn random_models_come_back_bit_for_bit() {
    let mut leaves = 0;
    for seed in 0..1500 {
        let mut random = Rng::new(seed);
        let materials = materials(&mut random);
        let tree = any_tree(&mut random, seed as usize % 7, &mut any_brush);
        let model = Model { materials, tree };
        let after = back(&model);
        let context = format!("seed {seed}");
        assert_same_leaves(&after, &model, &context);
        assert_same_tree(&after.tree, &model.tree, &mut random, &context);
        // what was read says itself in the same words
        let text = written(&after, 1.0);
        assert!(text == written(&model, 1.0), "{context}");
        assert!(read(&text) == after, "{context}");
        leaves += model.tree.brushes().len();
    }
    assert!(leaves > 10_000, "{leaves}");
}

/// Without any operation to join, the reader gives the same entries, in the same order.
#[test]
fn trees_without_joined_operations_keep_their_entries() {
    let leaf = || Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)));
    for tree in [
        leaf(),
        leaf() - (leaf() | leaf()),
        (leaf() & leaf()) | (leaf() - leaf()) | !leaf(),
        leaf() - (leaf() - (leaf() - leaf())),
        leaf() ^ Tree::union([leaf()]),
        !!leaf(),
    ] {
        let model = Model { materials: vec![planecut_csg::Material::named("m")], tree };
        assert_eq!(back(&model), model);
    }
}

fn whole_box(random: &mut Rng) -> Brush {
    let min = DVec3::from(random.lattice(4));
    let size = DVec3::from([(); 3].map(|()| random.whole(1, 5)));
    Brush::cuboid(min, min + size, MaterialId(random.below(3) as u32))
}

/// The solid of what comes back is that of what was written, also where operations were joined.
#[test]
fn volumes_are_kept_and_grow_with_the_scale() {
    let mut compared = 0;
    for seed in 0..200 {
        let mut random = Rng::new(seed);
        let materials = materials(&mut random);
        let world = Brush::cuboid(DVec3::splat(-7.0), DVec3::splat(7.0), MaterialId(0));
        let tree = Tree::from(world) & any_tree(&mut random, 4, &mut whole_box);
        let model = Model { materials, tree };
        let volume = |model: &Model| evaluate(model).expect("bounded").solid.volume;
        let expected = volume(&model);
        assert_eq!(volume(&back(&model)), expected, "seed {seed}");
        let scale = [0.5, 4.0, 10.0, 0.0254][seed as usize % 4];
        let scaled = volume(&read(&written(&model, scale))) / scale.powi(3);
        assert!((scaled - expected).abs() <= 1e-9 * expected.max(1.0), "seed {seed}: {scaled}, expected {expected}");
        compared += usize::from(expected > 0.0);
    }
    assert!(compared > 100, "{compared}");
}
