//! Scenes that once failed, as printed.

use crate::scene::model_of;
use crate::soundness::evaluate_soundly;

/// The wall at offset 5 is given at two scales; all coefficients happen to be multiples of one power of two, and still they
/// are noise. Not snapped, the wall stays between the boxes.
#[test]
fn a_wall_given_at_two_scales_dissolves() {
    let model = model_of(&[
        &[
            ([-7.031793213723065, 1.325247436117429, -6.985528142703485], 6.0, 0),
            ([21.095379641169195, -3.9757423083522867, 20.956584428110453], -12.0, 0),
            ([0.7658427389035841, -0.7808065376849501, -0.9190442734208775], 0.8571428571428571, 0),
            ([-1.6082697516975266, 1.6396937291383953, 1.9299929741838426], -1.5, 0),
            ([-4670614.977024159, -8268641.703313653, 3132877.2907057586], 6000000.0, 0),
            ([4.67061497702416e-5, 8.268641703313654e-5, -3.132877290705759e-5], -2e-5, 0),
        ],
        &[
            ([-7.031793213723065, 1.325247436117429, -6.985528142703485], 6.0, 0),
            ([21.095379641169195, -3.9757423083522867, 20.956584428110453], -12.0, 0),
            ([0.7658427389035841, -0.7808065376849501, -0.9190442734208775], 0.7142857142857142, 0),
            ([-1.6082697516975266, 1.6396937291383953, 1.9299929741838426], -0.6, 0),
            ([-4670614.977024159, -8268641.703313653, 3132877.2907057586], 4000000.0, 0),
            ([4.67061497702416e-5, 8.268641703313654e-5, -3.132877290705759e-5], -0.0, 0),
        ],
    ]);
    // Two boxes that share part of a side, each reaching beyond the other in one direction: an S of 10 faces.
    assert_eq!(evaluate_soundly(&model).expect("a sound mesh").mesh.faces.len(), 10);
}
