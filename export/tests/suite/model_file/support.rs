//! Models to write, the reader to read them back, and a second opinion on what a tree holds.

use planecut_csg::{Brush, BrushFace, Material, MaterialId, Model, Operation, Tree, TreeNode};
use planecut_export::write_model;
use planecut_import::model::{ModelOptions, read_model};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_testkit::random::Rng;

/// Names with all that JSON has to escape, and none at all.
pub(crate) const NAMES: [&str; 6] = ["stone", "old oak", "größe \"é\"", "tab\there\\ \u{1}\u{2028}", "", "default"];

/// The text of a model.
pub(crate) fn written(model: &Model, scale: f64) -> String {
    let mut text = Vec::new();
    write_model(model, scale, &mut text).expect("written");
    String::from_utf8(text).expect("UTF-8")
}

/// What the reader makes of a text, which it has to take without a warning; without the lines, which are those of the text.
#[track_caller]
pub(crate) fn read(text: &str) -> Model {
    let import = read_model(text.as_bytes(), "written.json", &ModelOptions::default());
    let import = import.unwrap_or_else(|error| panic!("{error}\n{}", text.chars().take(4000).collect::<String>()));
    assert_eq!(import.warnings, []);
    Model { tree: import.model.tree.without_source_lines(), ..import.model }
}

/// A model after it was written and read.
#[track_caller]
pub(crate) fn back(model: &Model) -> Model {
    read(&written(model, 1.0))
}

/// What a tree holds, worked out from what its leaves hold.
pub(crate) fn holds(tree: &Tree, leaves: &[bool]) -> bool {
    let mut leaves = leaves.iter().copied();
    let mut values: Vec<bool> = Vec::new();
    for node in tree.nodes() {
        let value = match *node {
            TreeNode::Leaf => leaves.next().expect("a value for each leaf"),
            TreeNode::Operation { operation, operands } => {
                let own: Vec<bool> = values.drain(values.len() - operands as usize..).collect();
                let count = own.iter().filter(|value| **value).count();
                match operation {
                    Operation::Union => count > 0,
                    Operation::Intersection => count == own.len(),
                    Operation::Difference => count == 1 && own[0],
                    Operation::Xor => count & 1 == 1,
                    Operation::Complement => count == 0,
                }
            }
        };
        values.push(value);
    }
    assert!(values.len() == 1 && leaves.next().is_none(), "a tree");
    values[0]
}

/// Whether a point is in a brush of half-spaces.
fn is_within(brush: &Brush, point: DVec3) -> bool {
    brush.half_spaces().all(|half_space| half_space.normal().dot(point) <= half_space.offset())
}

/// Whether a point is in the solid of a tree of half-spaces.
pub(crate) fn holds_point(tree: &Tree, point: DVec3) -> bool {
    holds(tree, &tree.brushes().iter().map(|brush| is_within(brush, point)).collect::<Vec<_>>())
}

/// Fails the test unless two models are made of the same brushes and materials, to the bit.
#[track_caller]
pub(crate) fn assert_same_leaves(found: &Model, expected: &Model, context: &str) {
    assert_eq!(found.materials, expected.materials, "{context}");
    let (found, expected) = (found.tree.brushes(), expected.tree.brushes());
    assert_eq!(found.len(), expected.len(), "{context}");
    for (number, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found, expected, "{context}, brush {number}");
        let bits = |brush: &Brush| -> Vec<[u64; 4]> {
            brush.half_spaces().map(|half_space| half_space.to_array().map(f64::to_bits)).collect()
        };
        // of numbers that are equal zero has two
        assert_eq!(bits(found), bits(expected), "{context}, brush {number}");
    }
}

/// Fails the test unless two trees over the same leaves hold the same, whatever these hold.
#[track_caller]
pub(crate) fn assert_same_tree(found: &Tree, expected: &Tree, random: &mut Rng, context: &str) {
    let leaves = expected.brushes().len();
    for round in 0..64 {
        // all, none, then any
        let values: Vec<bool> = (0..leaves).map(|_| round == 0 || round > 1 && random.chance(0.5)).collect();
        assert_eq!(holds(found, &values), holds(expected, &values), "{context}: {values:?}");
    }
}

/// Materials with looks of all kinds.
pub(crate) fn materials(random: &mut Rng) -> Vec<Material> {
    let share = |random: &mut Rng| random.chance(0.7).then(|| random.float(0.0, 1.0) as f32);
    let look = |name: &&str| Material {
        name: (*name).to_owned(),
        color: random.chance(0.7).then(|| [(); 3].map(|()| random.float(0.0, 1.0) as f32)),
        metallic: share(random),
        roughness: share(random),
    };
    NAMES.iter().map(look).collect()
}

/// A half-space of numbers of all kinds.
fn half_space(random: &mut Rng) -> HalfSpace {
    loop {
        let power = random.integer(-390, 390) as i32;
        let number = |random: &mut Rng| match random.below(6) {
            0 => 0.0,
            1 => -0.0,
            2 => random.whole(-9, 9),
            3 => random.float(-1.0, 1.0) * 2f64.powi(power),
            4 => random.float(-1.0, 1.0) * 2f64.powi(power + random.integer(-190, 0) as i32),
            _ => f64::from_bits(random.bits()),
        };
        let [x, y, z, offset] = [(); 4].map(|()| number(random));
        if let Ok(half_space) = HalfSpace::new(DVec3::new(x, y, z), offset) {
            return half_space;
        }
    }
}

/// A brush of any planes, in any materials, with a name or none.
pub(crate) fn any_brush(random: &mut Rng) -> Brush {
    let is_uniform = random.chance(0.5);
    let first = random.below(NAMES.len()) as u32;
    let faces = (0..1 + random.below(9))
        .map(|_| {
            let material = if is_uniform { first } else { random.below(NAMES.len()) as u32 };
            BrushFace { half_space: half_space(random), material: MaterialId(material) }
        })
        .collect();
    Brush { faces, name: random.chance(0.4).then(|| random.pick(&NAMES).to_owned()), mesh: None }
}

/// A tree of brushes, operations within operations to some depth.
pub(crate) fn any_tree(random: &mut Rng, depth: usize, brush: &mut dyn FnMut(&mut Rng) -> Brush) -> Tree {
    if depth == 0 || random.chance(0.2) {
        return brush(random).into();
    }
    let kinds =
        [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];
    let kind = random.pick(&kinds);
    // mostly two or three, at times one or none
    let count = [0, 1, 2, 2, 2, 3, 3, 5][random.below(8)];
    let operands: Vec<Tree> = (0..count).map(|_| any_tree(random, depth - 1, brush)).collect();
    Tree::combine(kind, operands)
}
