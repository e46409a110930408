//! What one edit asks for does not grow with the model.

use planecut_csg::{BrushId, LiveModel, Transform};
use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;
use planecut_testkit::edited::capsule_grid;

/// The signs for which capsules everywhere in a grid ask when they move and move back, all in all, and how many moves that are.
fn signs_of_moves(side: u32) -> (u64, u64) {
    const MOVED: u32 = 16;
    let mut live = LiveModel::from_model(capsule_grid(side)).unwrap();
    // signs are counted by thread
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let start = Counts::now();
        for k in 0..MOVED {
            let moved = BrushId(1 + u64::from(k * 7919 % side.pow(3)));
            for sign in [1.0, -1.0] {
                let by = Transform::translation(sign * DVec3::new(0.1, 0.05, 0.03)).unwrap();
                assert_eq!(live.transform_brush(moved, &by).unwrap().added.len(), 60);
            }
        }
        (Counts::since(start).total, u64::from(2 * MOVED))
    })
}

#[test]
fn an_edit_asks_for_as_many_signs_in_a_large_grid_as_in_a_small_one() {
    let (small, moves) = signs_of_moves(4);
    assert!(small > 60 * moves, "{small}");
    for side in [6, 8, 10] {
        let (signs, _) = signs_of_moves(side);
        assert!(signs < small + small / 10, "{signs} signs among {side}³ capsules, {small} among 4³");
    }
}
