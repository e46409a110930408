//! Source lines stay with their brushes.

use std::num::NonZeroU32;

use planecut_csg::{Brush, BrushId, LiveModel, Material, MaterialId, Model, Role, Transform, Tree};
use planecut_kernel::{DVec3, HalfSpace};

fn brush(at: f64) -> Brush {
    Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 2.0), MaterialId(0))
}

/// A block with a source line; 0 for none.
fn block(at: f64, line: u32) -> Tree {
    Tree::from(brush(at)).with_source_line(NonZeroU32::new(line))
}

fn lines(tree: &Tree) -> Vec<u32> {
    tree.source_lines().map(|line| line.map_or(0, NonZeroU32::get)).collect()
}

#[test]
fn combined_and_moved_trees_keep_them() {
    let part = block(0.0, 0) - block(1.0, 3);
    let tree = part.clone() | block(4.0, 0) | (block(8.0, 9) & block(9.0, 0)) | Tree::empty();
    assert_eq!(lines(&tree), [0, 3, 0, 9, 0]);
    assert_eq!((tree.source_line(3), tree.source_line(5)), (NonZeroU32::new(9), None));
    let moved = tree.clone().transformed(&Transform::translation(DVec3::X).unwrap()).unwrap();
    assert_eq!(lines(&moved.complement()), [0, 3, 0, 9, 0]);
    let cut = Model { materials: vec![Material::default()], tree: !tree.clone() };
    let cut = cut.cut_open(&HalfSpace::new(DVec3::X, 1.0).unwrap());
    assert_eq!(lines(&cut.model.tree), [0, 3, 0, 9, 0, 0]);
    assert_eq!(lines(&tree.clone().with_source_line(NonZeroU32::new(7))), [7, 3, 7, 9, 7]);
    let plain = tree.without_source_lines();
    assert_eq!(plain, plain.clone().with_source_lines(vec![None; 5]));
    assert_ne!(plain.clone(), plain.with_source_line(NonZeroU32::new(1)));
}

#[test]
fn named_parts_keep_them() {
    let tree = Tree::union([block(0.0, 4), block(3.0, 0).with_name("a"), block(6.0, 5).with_name("b"), block(9.0, 6)]);
    let parts: Vec<Vec<u32>> = tree.into_named_parts().iter().map(|(_, part)| lines(part)).collect();
    assert_eq!(parts, [vec![4, 6], vec![0], vec![5]]);
    // a part without lines is the tree that never had any
    let (_, part) = (block(0.0, 4) | block(3.0, 0).with_name("a")).into_named_parts().pop().unwrap();
    assert_eq!(part, block(3.0, 0).with_name("a"));
}

#[test]
fn live_brushes_keep_them_until_they_are_replaced() {
    let tree = block(0.0, 2) | block(3.0, 5) | block(6.0, 8);
    let mut live = LiveModel::from_model(Model { materials: vec![Material::default()], tree }).unwrap();
    let lines_of = |live: &LiveModel| lines(&live.to_model().tree);
    live.transform_brush(BrushId(1), &Transform::translation(DVec3::X).unwrap()).unwrap();
    live.add_brush(brush(9.0), Role::Add).unwrap();
    live.remove_brush(BrushId(0)).unwrap();
    assert_eq!(lines_of(&live), [5, 8, 0]);
    live.replace_brush(BrushId(2), brush(6.5)).unwrap();
    assert_eq!(lines_of(&live), [5, 0, 0]);
    live.undo().unwrap();
    assert_eq!(lines_of(&live), [5, 8, 0]);
}
