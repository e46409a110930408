//! What is empty, or all of space, has a form, too.

use planecut_csg::{Brush, ClosedMesh, Material, MaterialId, MeshBody, Model, Operation, Tree, evaluate};
use planecut_kernel::DVec3;
use planecut_testkit::random::Rng;

use super::support::{back, holds_point};

fn model(tree: Tree) -> Model {
    Model { materials: vec![Material::named("stone")], tree }
}

fn cube() -> Tree {
    Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)).into()
}

#[test]
fn an_empty_model_comes_back_empty() {
    for model in [Model::default(), model(Tree::empty())] {
        let after = back(&model);
        assert_eq!((after.tree.brushes(), &after.materials), (&[][..], &model.materials));
        assert!(!holds_point(&after.tree, DVec3::splat(0.5)));
        assert_eq!(evaluate(&after).expect("nothing").mesh.triangles.len(), 0);
    }
}

#[test]
fn operations_without_operands_hold_what_they_held() {
    let of_none = |kind| Tree::combine(kind, []);
    let kinds =
        [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];
    for kind in kinds {
        for tree in [
            of_none(kind),
            !of_none(kind),
            of_none(kind) - cube(),
            cube() - of_none(kind),
            of_none(kind) | cube(),
            cube() & of_none(kind),
            cube() ^ of_none(kind),
            Tree::combine(kind, [of_none(kind)]),
            Tree::combine(kind, [of_none(kind), of_none(kind), cube()]),
        ] {
            let after = back(&model(tree.clone()));
            assert_eq!(after.tree.brushes(), tree.brushes(), "{kind:?}");
            for point in [DVec3::splat(0.5), DVec3::splat(2.0)] {
                assert_eq!(holds_point(&after.tree, point), holds_point(&tree, point), "{kind:?} at {point}: {tree:?}");
            }
        }
    }
}

/// A brush without planes is all of space, a mesh without triangles nothing: no list of the format says so.
#[test]
fn brushes_of_nothing_become_operations_of_nothing() {
    let all = Tree::from(Brush { name: Some("all".to_owned()), ..Brush::default() });
    let none = Tree::from(MeshBody::new(ClosedMesh::default(), Vec::new()));
    let mut random = Rng::new(3);
    for (tree, expected) in [(cube() & all.clone(), cube()), (cube() - none, cube()), (all - cube(), !cube())] {
        let after = back(&model(tree));
        assert_eq!(after.tree.brushes(), cube().brushes());
        for _ in 0..50 {
            let point = random.point(-1.0, 2.0);
            assert_eq!(holds_point(&after.tree, point), holds_point(&expected, point), "{point}");
        }
    }
}
