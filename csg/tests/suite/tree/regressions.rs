//! Cases that once went wrong, as the random tests print them.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::Operation::Xor;
use planecut_csg::{Brush, Material, MaterialId, Model, Transform, Tree, UnboundedBrushes};
use planecut_shapes::primitives::sphere;

use super::random::{leaf, node};
use super::volume::check_volume;
use planecut_testkit::scene::Scene;
use planecut_testkit::soundness::evaluate_soundly_with;

/// Three edges through one point of a face, the boundary alternating around it: each goes on beyond the point.
#[test]
fn edges_that_cross_in_a_face_do_not_fold_it() {
    let shape = node(
        Xor,
        vec![
            node(
                Xor,
                vec![
                    leaf(&[
                        ([-1.0, -2.0, 1.0], 0.0),
                        ([1.0, 0.0, 0.0], 6.0),
                        ([0.0, 1.0, 0.0], 2.0),
                        ([0.0, 0.0, -1.0], 7.0),
                    ]),
                    leaf(&[
                        ([1.0, 0.0, 0.0], 2.0),
                        ([-1.0, 0.0, 0.0], 1.0),
                        ([0.0, 1.0, 0.0], 0.0),
                        ([0.0, -1.0, 0.0], 1.0),
                        ([0.0, 0.0, 1.0], -1.0),
                        ([0.0, 0.0, -1.0], 3.0),
                    ]),
                ],
            ),
            leaf(&[
                ([-1.0, 1.0, 1.0], -2.0),
                ([1.0, -1.0, 1.0], 6.0),
                ([1.0, 1.0, -1.0], 4.0),
                ([-1.0, 1.0, -1.0], 2.0),
                ([-1.0, -1.0, -1.0], 8.0),
            ]),
            leaf(&[
                ([0.0, 0.0, -2.0], 5.0),
                ([1.0, 0.0, 0.0], 3.0),
                ([-1.0, 0.0, 0.0], 5.0),
                ([0.0, 1.0, 0.0], 1.0),
                ([0.0, -1.0, 0.0], 7.0),
                ([0.0, 0.0, 1.0], 3.0),
            ]),
        ],
    );
    let evaluation = evaluate_soundly_with(&shape.model(), UnboundedBrushes::Keep).expect("a sound mesh");
    check_volume(&shape, &evaluation).unwrap();
    let report = check_mesh(&evaluation.mesh.positions, &evaluation.mesh.triangles, &CheckOptions::default());
    assert_eq!(report.first_problem(), None);
}

/// Two bodies of the same rounded planes and a box: a face of mere noise is left with three corners on a line.
#[test]
fn no_triangle_without_height_is_left() {
    let material = MaterialId(0);
    let block = |min: DVec3, max: DVec3| Tree::from(Brush::cuboid(min, max, material));
    let to_place = Transform::translation(DVec3::new(2.0, 5.0, 5.0)).expect("a shift");
    let ball = || Tree::from(sphere(3.0, 6, material).expect("a ball")).transformed(&to_place).expect("in range");
    let tree = Tree::xor([
        block(DVec3::new(0.0, 4.0, 2.0), DVec3::new(4.0, 5.0, 6.0)),
        ball(),
        ball() | block(DVec3::new(2.0, 5.0, 2.0), DVec3::new(5.0, 9.0, 4.0)),
    ]);
    let model = Model { materials: vec![Material::named("m")], tree };
    let mesh = evaluate_soundly_with(&model, UnboundedBrushes::Keep).expect("a sound mesh").mesh;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        assert!((b - a).cross(c - a).length() > 1e-6, "{a} {b} {c}");
    }
}
