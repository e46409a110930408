//! Cases that once went wrong, as the random tests print them.

use planecut_csg::Operation::Xor;
use planecut_csg::UnboundedBrushes;
use planecut_csg::check::{CheckOptions, check_mesh};

use crate::random::{leaf, node};
use crate::scene::Scene;
use crate::soundness::evaluate_soundly_with;
use crate::volume::check_volume;

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
