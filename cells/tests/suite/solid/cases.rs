//! What is easily forgotten: empty, unbounded, deep and wide.

use glam::DVec3;
use planecut_cells::Solid;
use planecut_csg::{Brush, EvaluateError, Material, MaterialId, Operation, Tree};

use planecut_testkit::scene::half_space;
use planecut_testkit::shape::{ensure_membership, ensure_sound, leaf, node};

fn block(min: f64, max: f64) -> Tree {
    Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)))
}

fn below(normal: DVec3, offset: f64) -> Tree {
    Tree::from(Brush::from_half_spaces([half_space(normal, offset)], MaterialId(0)))
}

#[test]
fn nothing_is_a_solid() {
    for tree in [
        Tree::empty(),
        !Tree::everything(),
        block(0.0, 1.0) - block(0.0, 1.0),
        block(0.0, 1.0) & block(1.0, 2.0),
        block(1.0, 0.0),
        block(0.0, 1.0) - Tree::everything(),
        Tree::difference([]),
        Tree::xor([]),
        Tree::xor([block(0.0, 1.0), block(0.0, 1.0)]),
    ] {
        let solid = Solid::from_tree(&tree);
        assert!(solid.is_empty() && solid.is_bounded(), "{tree:?}");
        assert_eq!((solid.volume(), solid.centroid(), solid.bounding_box()), (Some(0.0), Some(DVec3::ZERO), None));
        assert_eq!(solid.area(), Ok(0.0));
        assert!(solid.mesh(&[]).expect("an empty mesh").0.triangles.is_empty());
        assert!(solid.connected_components().is_empty() && solid.ray_cast(DVec3::ZERO, DVec3::X).is_none());
        assert!((&Solid::everything() ^ &!&solid).is_empty());
    }
}

#[test]
fn all_of_space_is_a_solid() {
    for tree in [
        Tree::everything(),
        !Tree::empty(),
        !block(0.0, 1.0) | block(-1.0, 2.0),
        block(0.0, 1.0) ^ !block(0.0, 1.0),
        Tree::from(Brush::default()),
        !block(1.0, 0.0),
        below(DVec3::X, 1.0) | below(-DVec3::X, 0.0),
    ] {
        let solid = Solid::from_tree(&tree);
        assert!(!solid.is_bounded() && (!&solid).is_empty(), "{tree:?}");
        assert_eq!((solid.volume(), solid.centroid(), solid.inertia()), (None, None, None));
        assert_eq!(solid.area(), Err(EvaluateError::Unbounded));
        assert_eq!(solid.ray_cast(DVec3::ZERO, DVec3::X), None);
        assert_eq!(solid.bounding_box().map(|bounds| bounds.max), Some(DVec3::INFINITY));
    }
}

#[test]
fn a_chain_of_ten_thousand_operations_needs_no_deep_stack() {
    let mut tree = block(0.0, 1.0);
    let count = 10_000;
    for k in 1..count {
        let at = DVec3::new(f64::from(k / 100), f64::from(k % 100), 0.0);
        let cube = Tree::from(Brush::cuboid(at, at + 1.0, MaterialId(0)));
        tree = if k % 2 == 0 { tree | cube } else { Tree::difference([tree, cube]) };
    }
    assert_eq!(Solid::from_tree(&tree).volume(), Some(f64::from(count / 2)));
}

#[test]
fn a_tree_that_leans_to_the_right_is_carved() {
    // a0 − (a1 − (a2 − …)) of nested boxes: every other shell
    let mut tree = block(-1.0, 1.0);
    for k in 2..200 {
        tree = block(f64::from(-k), f64::from(k)) - tree;
    }
    let size = |k: i32| 8.0 * f64::from(k).powi(3);
    let expected: f64 = (1..200).map(|k| if k % 2 == 1 { size(k) } else { -size(k) }).sum();
    assert_eq!(Solid::from_tree(&tree).volume(), Some(expected.abs()));
}

#[test]
fn a_deep_tree_of_boxes_apart_leans_to_the_right() {
    let mut tree = Tree::empty();
    for k in 0..10_000_u32 {
        let at = DVec3::new(f64::from(2 * k), 0.0, 0.0);
        tree = Tree::from(Brush::cuboid(at, at + 1.0, MaterialId(0))) ^ Tree::union([Tree::empty(), tree]);
    }
    assert_eq!(Solid::from_tree(&tree).volume(), Some(10_000.0));
}

#[test]
fn thirty_thousand_boxes_apart_are_as_many_cells() {
    let at = |k: u32| DVec3::new(f64::from(k % 31), f64::from(k / 31 % 31), f64::from(k / 961)) * 2.0;
    let cubes = (0..30_000).map(|k| Brush::cuboid(at(k), at(k) + 1.0, MaterialId(0)));
    let solid = Solid::from_tree(&Tree::union_of(cubes.collect()));
    assert_eq!((solid.cells().count(), solid.volume()), (30_000, Some(30_000.0)));
}

#[test]
fn unbounded_operands_and_results() {
    let wedge = below(DVec3::ONE, 3.0) & !below(DVec3::X, 0.0) & !below(DVec3::Y, 0.0) & !below(DVec3::Z, 0.0);
    assert_eq!(Solid::from_tree(&wedge).volume(), Some(4.5));
    let hollow = Solid::from_tree(&!(!block(0.0, 3.0) | block(1.0, 2.0)));
    assert_eq!(hollow.volume(), Some(26.0));
    assert_eq!((!&!&hollow).volume(), Some(26.0));
    let slab = Solid::from_tree(&(below(DVec3::Z, 1.0) - below(DVec3::Z, 0.0) - block(-1.0, 1.0)));
    assert_eq!(slab.bounding_box().map(|bounds| (bounds.min.z, bounds.max.z)), Some((0.0, 1.0)));
    assert_eq!((&slab & &Solid::from_tree(&block(-2.0, 2.0))).volume(), Some(12.0));
    assert_eq!(slab.connected_components().len(), 1);
    assert_eq!(slab.distance(DVec3::new(0.0, 0.0, 0.5)), 1.0);
}

#[test]
fn faces_remember_their_brushes() {
    let paint = |tree: Tree, material: u32| tree.with_material(MaterialId(material));
    let tool = paint(block(1.0, 4.0), 1);
    let solid = &Solid::from_tree(&block(0.0, 3.0)) - &Solid::from_tree(&tool);
    let hit = solid.ray_cast(DVec3::splat(2.0), -DVec3::X).expect("the wall of the notch");
    assert_eq!((hit.face.brush_face, hit.face.material, hit.normal), (Some((1, 1)), MaterialId(1), DVec3::X));
    let materials = [Material::named("block"), Material::named("tool")];
    let (mesh, measures) = solid.mesh(&materials).expect("a mesh");
    assert_eq!((measures.volume, measures.area), (19.0, 54.0));
    assert_eq!(mesh.faces.iter().filter(|face| face.material == MaterialId(1)).count(), 3);
    let unknown = EvaluateError::UnknownMaterial { material: MaterialId(1), count: 1 };
    assert_eq!(solid.mesh(&materials[..1]).err(), Some(unknown));
}

/// An empty operand in the middle of operators, and solids that share a table.
#[test]
fn a_shape_of_plain_numbers_is_sound() {
    let cube =
        leaf(&[([1.0, 0.0, 0.0], 1.0), ([0.0, 1.0, 0.0], 1.0), ([0.0, 0.0, 1.0], 1.0), ([-1.0, -1.0, -1.0], 0.0)]);
    let shape = node(Operation::Difference, vec![cube.clone(), node(Operation::Union, vec![]), cube.clone()]);
    let solid = shape.by_operators();
    assert!(solid.is_empty());
    let rest = node(Operation::Xor, vec![cube, leaf(&[([1.0, 0.0, 0.0], 0.0)])]);
    let solid = rest.by_operators();
    assert_eq!(ensure_sound(&solid).and_then(|()| ensure_membership(&rest, &solid, 500)), Ok(()));
}
