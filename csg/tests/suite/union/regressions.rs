//! Scenes that once failed, as printed.

use super::invariance::same;
use planecut_testkit::scene::{model_of, with_brushes};
use planecut_testkit::soundness::evaluate_soundly;

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

/// On the shared top, a spike stands on the line of a longer edge: three corners are collinear and the spike's
/// tip lies beyond. Its ear must be cut although the diagonal runs along that line. All corners are small integers.
#[test]
fn a_spike_on_a_straight_side_does_not_fold() {
    let model = model_of(&[
        &[
            ([1.0, 1.0, 1.0], 11.0, 0),
            ([-1.0, 1.0, 1.0], 5.0, 0),
            ([1.0, -1.0, 1.0], 9.0, 0),
            ([-1.0, -1.0, 1.0], 3.0, 0),
            ([0.0, 0.0, 1.0], 3.0, 0),
            ([0.0, 0.0, -1.0], 5.0, 0),
        ],
        &[
            ([1.0, 0.0, 0.0], 6.0, 0),
            ([-1.0, 0.0, 0.0], -1.0, 0),
            ([0.0, 1.0, 0.0], 4.0, 0),
            ([0.0, -1.0, 0.0], 2.0, 0),
            ([0.0, 0.0, 1.0], 3.0, 0),
            ([0.0, 0.0, -1.0], 3.0, 0),
        ],
    ]);
    evaluate_soundly(&model).expect("a sound mesh");
}

/// A notch whose corners nearly lie on the edge of a slope, 5e-17 from its end: triangles of the slope must not fold over.
#[test]
fn a_notch_that_ends_on_an_edge_does_not_fold() {
    let model = model_of(&[
        &[
            ([-1.0, -1.0, -1.0], 0.3666666666666666, 0),
            ([1.0, 0.0, 0.0], 1.1, 0),
            ([-1.0, -0.0, -0.0], 0.2333333333333333, 0),
            ([0.0, 1.0, 0.0], 1.1, 0),
            ([0.0, 0.0, 1.0], 0.7666666666666666, 0),
            ([-0.0, -0.0, -1.0], 0.5666666666666667, 0),
        ],
        &[
            ([1.0, -0.0, -0.0], 0.1, 0),
            ([0.0, -1.0, -0.0], -0.1, 0),
            ([0.0, -0.0, -1.0], 0.5666666666666667, 0),
            ([-1.0, 1.0, 1.0], 0.1, 0),
        ],
    ]);
    evaluate_soundly(&model).expect("a sound mesh");
}

/// The same with noise: points that were one lie 1e-15 apart.
#[test]
fn noisy_slopes_do_not_fold() {
    let model = model_of(&[
        &[
            ([-1.0000000000000004, 0.9999999999999992, 0.9999999999999991], 5.0, 0),
            ([0.9999999999999998, 5.554368783946576e-16, -7.987581779954163e-16], 6.999999999999995, 0),
            ([-0.9999999999999993, -4.4017430576346863e-16, 5.554235912969017e-16], 0.9999999999999991, 0),
            ([2.874497169123245e-16, -1.0, -2.853794976231483e-17], 3.0000000000000018, 0),
            ([-5.021711143124874e-16, -9.990112600735045e-16, -0.9999999999999993], 5.0, 0),
        ],
        &[
            ([-0.9999999999999999, 0.999999999999999, 0.9999999999999997], 6.0000000000000036, 0),
            ([0.9999999999999991, -1.0000000000000007, 1.0000000000000009], 1.9999999999999998, 0),
            ([1.0000000000000009, 0.9999999999999999, -1.0000000000000004], -2.0, 0),
            ([-1.0000000000000002, 0.9999999999999998, -1.0000000000000004], -8.850042741450926e-16, 0),
            ([-0.9999999999999996, -1.0, -0.9999999999999997], -2.0000000000000018, 0),
        ],
    ]);
    evaluate_soundly(&model).expect("a sound mesh");
}

/// One plane at scales 1, −10⁵ and 0.1, rounded each time: which of them stands for all must not depend on their order.
#[test]
fn snapped_planes_do_not_depend_on_the_order() {
    let model = model_of(&[
        &[
            ([0.7185495983214873, 0.3232692603340515, 0.615778742792494], 0.9142313663117957, 0),
            ([0.4701583081805607, -0.10996627782216375, -0.8757046208572453], 0.3747196313796648, 0),
            ([-0.3330975077436709, -0.9245902137100424, -0.18487559884033894], -0.5290455744476994, 0),
            ([-0.8049808415979006, 0.38995422437386695, -0.4471482389021695], 0.38864090578784527, 0),
        ],
        &[
            ([-0.788598442979628, -0.6112650160054179, -0.0668399277228992], 0.5255247951584545, 0),
            ([0.5084157440201066, -0.7093020825116072, 0.48826630743599153], -0.21382471091848193, 0),
            ([-0.5084157440201066, 0.7093020825116072, -0.48826630743599153], 0.21382473091848192, 0),
            ([0.13127670544273423, 0.0457161998232435, -0.03293355351505489], 0.13211187098215238, 0),
        ],
        &[
            ([-0.6431459690071739, -0.7645800365260009, 0.04219751527901203], 1.1951913149009716, 0),
            ([-50841.57440201066, 70930.20825116072, -48826.630743599155], 21382.471091848194, 0),
            ([13127.670544273424, 4571.61998232435, -3293.355351505489], 13211.187098215238, 0),
            ([2.155648794964462, 0.9698077810021546, 1.8473362283774821], 2.742694098935387, 0),
        ],
    ]);
    let expected = evaluate_soundly(&model).expect("a sound mesh");
    for k in 1..model.tree.brushes().len() {
        let other = with_brushes(&model, |brushes| brushes.rotate_left(k));
        same(&evaluate_soundly(&other).expect("a sound mesh"), &expected, "rotated").unwrap();
    }
}

/// Two holes of noise width side by side: the second's bridge has to leave the corner at which the first's ends on the side
/// that looks towards it.
#[test]
fn bridges_that_share_a_corner_leave_it_on_their_own_sides() {
    let model = model_of(&[
        &[
            ([1.0, 0.0, 0.0], -0.5666666666666667, 0),
            ([0.0, -1.0, 0.0], 0.2333333333333333, 0),
            ([0.0, 0.0, 1.0], 0.43333333333333335, 0),
            ([-1.0, 1.0, -1.0], 0.5666666666666667, 0),
        ],
        &[
            ([1.0, 0.0, 0.0], -0.2333333333333333, 0),
            ([-1.0, 0.0, 0.0], 0.9, 0),
            ([0.0, 1.0, 0.0], 0.43333333333333335, 0),
            ([0.0, -1.0, 0.0], 0.5666666666666667, 0),
            ([0.0, 0.0, 1.0], 0.1, 0),
            ([0.0, 0.0, -1.0], 0.9, 0),
        ],
        &[
            ([-1.0, 0.0, 0.0], 1.5666666666666664, 0),
            ([0.0, -1.0, 0.0], 1.9, 0),
            ([0.0, 0.0, 1.0], 0.7666666666666666, 0),
            ([0.0, 1.0, -1.0], -0.6666666666666666, 0),
            ([1.0, -1.0, -1.0], 1.9, 0),
        ],
    ]);
    evaluate_soundly(&model).expect("a sound mesh");
}

/// A ring of one ulp on a shared plane: its area is mere rounding, its turns are not.
#[test]
fn a_loop_of_the_size_of_rounding_keeps_its_sense() {
    let model = model_of(&[
        &[
            ([-1.0, 0.8692867378162271, 0.0057895993698219034], 1.2528243981217555, 0),
            ([-1.0, -0.8390996311772803, -0.005703932910557909], 1.2266815969056775, 0),
            ([1.0, -0.3639702342662024, -0.00464988871190877], 1.0, 0),
            ([1.0, -0.383864035035416, 0.004680331748653524], 1.012787488644023, 0),
            ([0.0, 0.0, 1.0], 1.3333333333333333, 0),
            ([0.0, 0.0, -1.0], 0.0, 0),
        ],
        &[
            ([0.0, 0.0, -1.0], -1.3333333333333333, 0),
            ([-1.0, 0.9004040442978402, 0.005879696608597642], 1.2801603372553716, 0),
            ([-1.0, -0.8097840331950072, -0.00562245231496094], 1.2016618657088736, 0),
            ([-0.21255656167002224, -1.0, 0.004467082582197607], 0.9725981331437374, 0),
            ([1.0, -0.4040262258351569, 0.004712621006647926], 1.026058128306415, 0),
            ([0.0, 0.0, 1.0], 2.0, 0),
        ],
    ]);
    evaluate_soundly(&model).expect("a sound mesh");
}

/// On the top of a cube one body covers all on one side of a line, and another a part beside it, on either side, by another plane through the line: what
/// the first leaves of the face ends there, and so does what the second covers, under one name.
#[test]
fn bodies_that_end_on_one_line_of_a_face_by_different_planes() {
    let cuboid = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let planes = |(axis, [low, high]): ([f64; 3], [f64; 2])| [(axis, high, 0), (axis.map(|c| -c), -low, 0)];
        std::iter::zip(axes, [x, y, z]).flat_map(planes).collect::<Vec<_>>()
    };
    let cube = cuboid([-2.0, 2.0], [-2.0, 2.0], [-2.0, 2.0]);
    let half = cuboid([-3.0, 0.0], [-3.0, 3.0], [1.0, 3.0]);
    // to which side of the line, how the plane leans, and what is neither in the cube nor in the half: a block, wedges on the plane or below it, nothing
    for (side, lean, added) in [(1.0, -1.0, 2.0), (1.0, 1.0, 1.0), (-1.0, -1.0, 1.0), (-1.0, 1.0, 0.0)] {
        let mut beside = cuboid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 3.0]);
        beside.push(([-side, 0.0, lean], 2.0 * lean, 0));
        let volume = 64.0 + (36.0 - 8.0) + added;
        let bodies = [&cube[..], &beside, &half];
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let model = model_of(&order.map(|k| bodies[k]));
            let evaluation = evaluate_soundly(&model).expect("a sound mesh");
            let off = evaluation.solid.volume - volume;
            assert!(off.abs() < 1e-12 * volume, "{order:?}, side {side}, lean {lean}: off by {off}");
        }
    }
}

/// A needle along x = 1.1, one ulp thick: contraction takes it out of the mesh, the measures of the exact boundary reach
/// to its end, and it is reported as noise.
#[test]
fn a_needle_thinner_than_rounding_is_reported_as_noise() {
    let model = model_of(&[
        &[
            ([0.0, 1.0, 0.0], 0.43333333333333335, 0),
            ([0.0, -1.0, 0.0], 0.2333333333333333, 0),
            ([0.0, 0.0, -1.0], -0.7666666666666666, 0),
            ([-1.0, 0.0, 1.0], -0.3333333333333333, 0),
            ([1.0, 0.0, 0.0], 1.1, 0),
        ],
        &[
            ([1.0, 0.0, 0.0], -0.2333333333333333, 0),
            ([-1.0, 0.0, 0.0], 0.9, 0),
            ([0.0, 1.0, 0.0], 0.43333333333333335, 0),
            ([0.0, -1.0, 0.0], 0.5666666666666667, 0),
            ([0.0, 0.0, 1.0], 0.43333333333333335, 0),
            ([0.0, 0.0, -1.0], 0.9, 0),
        ],
    ]);
    let found = evaluate_soundly(&model).expect("a sound mesh");
    let reach = found.mesh.positions.iter().fold(f64::NEG_INFINITY, |reach, at| reach.max(at.x));
    assert_eq!((reach, found.solid.max.x), (-0.2333333333333333, 1.1));
    assert!(found.noise.collapsed > 0 && found.noise.thickest < 1e-15, "{:?}", found.noise);
}
