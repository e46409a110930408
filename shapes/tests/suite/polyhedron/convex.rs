//! Convex bodies stay whole.

use glam::{DQuat, DVec3};
use planecut_kernel::hull;
use planecut_shapes::polyhedron::Precision;

use super::judge::{Given, prism};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

/// The facets of a hull of random points, as the kernel finds them.
fn random_hull(rng: &mut Rng) -> Given {
    let points: Vec<DVec3> = (0..4 + rng.below(60)).map(|_| rng.unit() * rng.float(0.7, 1.0)).collect();
    let (points, facets) = hull(&points).expect("points that span space").to_mesh();
    let facet = |facet: &Vec<usize>| facet.iter().map(|v| *v as u32).collect();
    Given { points, facets: facets.iter().map(facet).collect() }
}

fn turned_prism(sides: u32, rng: &mut Rng) -> Given {
    let angle = |k: u32| f64::from(k) / f64::from(sides) * std::f64::consts::TAU;
    let outline: Vec<[f64; 2]> = (0..sides).map(|k| [10.0 * angle(k).cos(), 10.0 * angle(k).sin()]).collect();
    let (turn, shift) = (rng.rotation(), rng.point(-20.0, 20.0));
    prism(&outline, 25.0).moved(|p| turn * p + shift)
}

/// Each facet as a fan.
fn in_triangles(given: &Given) -> Given {
    let fan = |facet: &Vec<u32>| -> Vec<Vec<u32>> {
        facet[1..].windows(2).map(|pair| vec![facet[0], pair[0], pair[1]]).collect()
    };
    Given { points: given.points.clone(), facets: given.facets.iter().flat_map(fan).collect() }
}

#[test]
fn hulls_of_random_points_are_one_cell() {
    for seed in 0..scaled(60) {
        let given = random_hull(&mut Rng::spread(seed));
        let solid = given.cells(Precision::Double).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        assert_eq!(solid.cells.len(), 1, "seed {seed}");
        assert_eq!(solid.cells[0].faces.len(), given.facets.len(), "seed {seed}");
    }
}

#[test]
fn rounded_prisms_are_one_cell_with_a_plane_for_each_side() {
    let single = |v: f64| f64::from(v as f32);
    let six = |v: f64| format!("{v:.5e}").parse::<f64>().expect("a number");
    let places = |v: f64| (v * 1e6).round() / 1e6;
    type Case = (Precision, fn(f64) -> f64);
    let cases: [Case; 3] = [(Precision::Single, single), (Precision::Digits(6), six), (Precision::Places(6), places)];
    for seed in 0..scaled(20) {
        let mut rng = Rng::spread(seed);
        let sides = 3 + rng.below(90) as u32;
        let given = in_triangles(&turned_prism(sides, &mut rng));
        for (precision, round) in cases {
            let given = given.moved(|p| DVec3::from_array(p.to_array().map(round)));
            let solid = given.cells(precision).unwrap_or_else(|error| panic!("seed {seed} {precision:?}: {error}"));
            assert_eq!(solid.cells.len(), 1, "seed {seed} {precision:?}, {sides} sides");
            assert_eq!(solid.cells[0].faces.len(), sides as usize + 2, "seed {seed} {precision:?}");
        }
    }
}

#[test]
fn a_rounded_gear_has_a_cell_for_each_notch_at_most() {
    // 200 teeth, turned and rounded to single precision: two reflex edges for each notch
    let teeth = 200;
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(4 * teeth) * std::f64::consts::TAU;
        let radius = if k % 4 < 2 { 10.0 } else { 9.0 };
        [radius * angle.cos(), radius * angle.sin()]
    };
    let outline: Vec<[f64; 2]> = (0..4 * teeth).map(corner).collect();
    let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 1.1);
    let given = in_triangles(&prism(&outline, 3.0)).moved(|p| (turn * p).as_vec3().as_dvec3());
    let solid = given.cells(Precision::Single).expect("a closed surface");
    assert!(solid.cells.len() <= 2 * teeth as usize + 1, "{} cells", solid.cells.len());
    assert!((solid.volume - given.volume()).abs() < 1e-6 * given.volume());
}
