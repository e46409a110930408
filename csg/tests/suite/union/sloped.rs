//! Bodies with small integer planes that are not axis-aligned: coincidences of every kind.

use planecut_csg::Model;

use super::measure::{check_membership, check_volume};
use planecut_testkit::generate::{placed, sloped_scene};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::sweep;
use planecut_testkit::soundness::evaluate_soundly;

fn judge(model: &Model) -> Result<(), String> {
    let evaluation = evaluate_soundly(model)?;
    check_volume(model, &evaluation)?;
    check_membership(model, &evaluation, 30)
}

#[test]
fn sloped_bodies_match_their_oracles() {
    sweep(1200, sloped_scene, judge);
}

#[test]
fn sloped_bodies_far_away_match_their_oracles() {
    let generate = |rng: &mut Rng| placed(sloped_scene(rng), 1.0, glam::DVec3::new(1e6, -1e6, 3e5));
    sweep(200, generate, judge);
}

#[test]
fn sloped_bodies_at_thirds_match_their_oracles() {
    let generate = |rng: &mut Rng| placed(sloped_scene(rng), 1.0 / 3.0, glam::DVec3::splat(0.1));
    sweep(200, generate, judge);
}
