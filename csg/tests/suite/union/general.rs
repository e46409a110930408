//! Bodies in general position, with shared planes, with noise, thin, far away and of mixed size.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::Model;

use super::measure::{check_membership, check_volume};
use planecut_testkit::generate::{general_scene, kindred_scene, placed, sloped_scene, split, turned_box, with_noise};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{ensure, half_space, model, sweep};
use planecut_testkit::soundness::evaluate_soundly;

fn judge(model: &Model) -> Result<(), String> {
    let evaluation = evaluate_soundly(model)?;
    check_volume(model, &evaluation)?;
    check_membership(model, &evaluation, 30)
}

#[test]
fn general_bodies_match_their_oracles() {
    sweep(400, general_scene, judge);
}

#[test]
fn bodies_with_shared_planes_match_their_oracles() {
    sweep(400, kindred_scene, judge);
}

#[test]
fn far_and_small_and_large_bodies_match_their_oracles() {
    let generate = |rng: &mut Rng| {
        let scene = if rng.chance(0.5) { general_scene(rng) } else { kindred_scene(rng) };
        let shift = rng.pick(&[DVec3::ZERO, DVec3::new(1e6, -1e6, 1e6), DVec3::new(0.0, 1e6, 1e3)]);
        placed(scene, rng.pick(&[1.0, 1e-3, 1e3]), shift)
    };
    sweep(300, generate, judge);
}

/// Split bodies whose planes went through noise: walls nearly meet, four planes nearly meet in a point.
fn noisy_scene(rng: &mut Rng) -> Model {
    let scene = match rng.integer(0, 2) {
        0 => sloped_scene(rng),
        1 => kindred_scene(rng),
        _ => {
            let at = rng.point(-1.0, 1.0);
            let mut brushes = vec![turned_box(rng, at, DVec3::ONE)];
            split(&mut brushes, 4, || {
                let normal = rng.unit();
                half_space(normal, normal.dot(at + rng.point(-0.3, 0.3)))
            });
            model(brushes)
        }
    };
    let relative = 10_f64.powi(-rng.integer(9, 16) as i32);
    with_noise(rng, scene, relative)
}

#[test]
fn noisy_bodies_match_their_oracles() {
    sweep(500, noisy_scene, judge);
}

#[test]
fn meshes_do_not_cross_themselves() {
    let generate = |rng: &mut Rng| match rng.integer(0, 2) {
        0 => general_scene(rng),
        1 => kindred_scene(rng),
        _ => sloped_scene(rng),
    };
    sweep(200, generate, |model| {
        let mesh = evaluate_soundly(model)?.mesh;
        // Far less than the thinnest slab, far more than rounding.
        let options = CheckOptions { tolerance: 1e-12, ..CheckOptions::default() };
        let report = check_mesh(&mesh.positions, &mesh.triangles, &options);
        ensure!(mesh.triangles.is_empty() || report.is_sound(), "{report}");
        Ok(())
    });
}
