//! Blocks of a lattice that come and go in rows: lines on which many edges lie, one after the other, of which most are next to where something changes and not
//! touched by it.

use planecut_csg::Role;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::drags::cuboid;
use super::edits::{Edit, Faces, Planes, Tally, check};

const SEEDS: u64 = 24;

/// How long rows are.
const LENGTH: usize = 14;

/// Blocks of one to four units along a row and of one or a half across, mostly with ends where others end.
fn any_block(rng: &mut Rng) -> Planes {
    let halves = if rng.below(4) == 0 { 0.5 } else { 0.0 };
    let start = rng.below(LENGTH) as f64 + halves;
    let end = start + [1, 1, 1, 2, 4][rng.below(5)] as f64 - if rng.below(6) == 0 { 0.5 } else { 0.0 };
    let across = |rng: &mut Rng| {
        let low = rng.below(2) as f64;
        [low, low + if rng.below(5) == 0 { 0.5 } else { 1.0 }]
    };
    let (y, z) = (across(rng), across(rng));
    cuboid([start, y[0], z[0]], [end, y[1], z[1]])
}

fn edits(rng: &mut Rng) -> Vec<Edit> {
    // a full row at first, so that lines have many edges
    let unit = |k: usize| cuboid([k as f64, 0.0, 0.0], [k as f64 + 1.0, 1.0, 1.0]);
    let mut edits: Vec<Edit> = (0..LENGTH).map(|k| Edit::Add(unit(k), (k % 5 / 4) as u32, Role::Add)).collect();
    for _ in 0..36 {
        edits.push(match rng.below(10) {
            0..4 => {
                let role = if rng.below(3) == 0 { Role::Subtract } else { Role::Add };
                Edit::Add(any_block(rng), (rng.below(4) / 3) as u32, role)
            }
            4..7 => Edit::Remove(rng.below(1000)),
            7 => Edit::Replace(rng.below(1000), any_block(rng)),
            8 => Edit::Nudge(rng.below(1000), rng.below(6), [0.5, -0.5, 0.25][rng.below(3)]),
            _ => Edit::Undo,
        });
    }
    edits
}

#[test]
fn blocks_come_and_go_in_rows() {
    let of_seed = |seed: u64| check(seed, &edits(&mut Rng::spread(seed)), Faces::Same);
    let tally: Tally = (0..scaled(SEEDS)).map(of_seed).sum();
    assert!(tally.compared > 30 * scaled(SEEDS) as usize, "{tally:?}");
}
