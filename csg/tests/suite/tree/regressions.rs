//! Cases that once went wrong, as the random tests print them.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::Operation::{Intersection, Union, Xor};
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

/// Planes of any directions that nearly meet in points: two triangles of a face lay folded on each other, which only its area showed.
#[test]
fn a_face_is_not_folded() {
    let shape = node(
        Intersection,
        vec![
            leaf(&[
                ([1.0, 0.0, 0.0], 3.0),
                ([-1.0, -0.0, -0.0], 3.0),
                ([0.0, 1.0, 0.0], 3.0),
                ([-0.0, -1.0, -0.0], 3.0),
                ([0.0, 0.0, 1.0], 3.0),
                ([-0.0, -0.0, -1.0], 3.0),
            ]),
            node(
                Union,
                vec![
                    node(
                        Xor,
                        vec![
                            leaf(&[
                                ([-3.4096065144704326, -1.5390985326415123, -0.0758888878659274], 1.6090593796801431),
                                ([-3.0851485877379003, -2.912299559441063, 0.019221541515327623], 1.9179065951708179),
                            ]),
                            leaf(&[
                                ([1.4148131795354684, -2.523661783946116, 0.7933693132852092], 0.13500619552154192),
                                ([2.235719587987576, 2.789448085919208, 1.1047792991590342], -1.9135258848005627),
                                ([-1.4482629784608876, -0.5453693354371001, -2.9334462042424594], 1.443683996009168),
                            ]),
                            leaf(&[(
                                [2.2642421792857927, -2.4008103104242617, -0.3306315273891526],
                                0.13062548515128686,
                            )]),
                            leaf(&[
                                ([-0.6085027466977129, -1.3961637041902752, 2.9462605652526777], -0.16507959922862248),
                                ([2.6221499049437442, -0.7049802178405956, 1.9045557929493526], -1.1392174908887482),
                                ([-0.1573945793726912, 1.1734234345372903, -3.5494090197753767], 0.6477678346884301),
                            ]),
                        ],
                    ),
                    leaf(&[([-0.8828787986757438, -3.191882592905071, -1.0160760502828883], 1.5830709019009648)]),
                ],
            ),
        ],
    );
    let evaluation = evaluate_soundly_with(&shape.model(), UnboundedBrushes::Keep).expect("a sound mesh");
    check_volume(&shape, &evaluation).unwrap();
}
