//! Unions of many meshes, and differences of many, leave out what cannot be seen: against the same without that.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{
    CombinedMeshes, Mesh, MeshBody, Model, Operation, SolidMeasures, Tree, combine_meshes, evaluate, unite_meshes,
};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::flat_faces::{cubes, fan_prism, star};
use super::soup::Soup;

/// A torus of rectangles, each cut into two triangles.
fn torus(around: u32, across: u32, radius: f64) -> Soup {
    let corner = |i: u32, j: u32| {
        let (s, t) = (TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(across));
        let ring = 1.0 + radius * t.cos();
        DVec3::new(ring * s.cos(), ring * s.sin(), radius * t.sin())
    };
    let number = |i: u32, j: u32| (i % around) * across + j % across;
    let all = || (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let triangles = all().flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Soup { positions: all().map(|(i, j)| corner(i, j)).collect(), triangles: triangles.collect() }
}

/// A long bar.
fn bar(length: f64) -> Soup {
    let corner =
        |k: u32| DVec3::new(f64::from(k & 1) - 0.5, f64::from(k >> 1 & 1) - 0.5, length * (f64::from(k >> 2) - 0.5));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Soup { positions: (0..8).map(corner).collect(), triangles }
}

/// Turned and moved anyhow, within a cube.
fn anywhere(rng: &mut Rng, mut soup: Soup, space: f64) -> Soup {
    let axis = DVec3::new(rng.float(-1.0, 1.0), rng.float(-1.0, 1.0), rng.float(0.1, 1.0)).normalize();
    let turn = DMat3::from_axis_angle(axis, rng.float(0.0, TAU));
    let shift = space * DVec3::new(rng.float(0.0, 1.0), rng.float(0.0, 1.0), rng.float(0.0, 1.0));
    soup.positions.iter_mut().for_each(|position| *position = turn * *position + shift);
    soup
}

/// Moved along a grid.
fn on_grid(rng: &mut Rng, mut soup: Soup, size: usize) -> Soup {
    let shift = DVec3::new(rng.below(size) as f64, rng.below(size) as f64, rng.below(size) as f64);
    soup.positions.iter_mut().for_each(|position| *position += shift);
    soup
}

/// Makes sure that a mesh is closed and bounds the same solid as another one.
fn assert_alike(what: &str, soups: &[Soup], [one, other]: [(&Mesh, &SolidMeasures); 2]) {
    let report = check_mesh(&one.0.positions, &one.0.triangles, &CheckOptions::default());
    assert!(one.0.triangles.is_empty() || report.is_sound(), "{what}: {report:?} {soups:?}");
    let (found, expected) = (one.1, other.1);
    let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
    let is_alike = is_near(found.volume, expected.volume)
        && is_near(found.area, expected.area)
        && (found.min, found.max) == (expected.min, expected.max)
        && (0..3).all(|axis| one.0.triangles.is_empty() || is_near(found.centroid[axis], expected.centroid[axis]));
    assert!(is_alike, "{what}: {found:?}, expected {expected:?}, {soups:?}");
}

/// Unites meshes, and takes all but the first from the first.
fn assert_same_as_all(seed: u64, soups: &[Soup]) {
    let meshes: Vec<MeshBody> = soups.iter().map(Soup::mesh).collect();
    let parts = |combined: &CombinedMeshes| (combined.mesh.clone(), combined.solid);
    let united = parts(&unite_meshes(&meshes, Vec::new()).expect("closed meshes"));
    let all =
        parts(&combine_meshes(&meshes, Vec::new(), |inside| inside.all().next().is_some()).expect("closed meshes"));
    assert_alike(&format!("seed {seed}, union"), soups, [(&united.0, &united.1), (&all.0, &all.1)]);
    let tree = Tree::combine(Operation::Difference, meshes.iter().map(|mesh| mesh.clone().into()));
    let model = Model { materials: vec![planecut_csg::Material::named("any")], tree };
    let difference = evaluate(&model).expect("a bounded solid");
    let only_first = |inside: &planecut_csg::Inside<'_>| inside.all().eq([0]);
    let all = parts(&combine_meshes(&meshes, Vec::new(), only_first).expect("closed meshes"));
    assert_alike(&format!("seed {seed}, difference"), soups, [(&difference.mesh, &difference.solid), (&all.0, &all.1)]);
}

#[test]
fn soups_on_a_grid() {
    for seed in 0..scaled(200) {
        let rng = &mut Rng::new(seed);
        let soups: Vec<Soup> = (0..3 + rng.below(8)).map(|_| Soup::random(rng, 4)).collect();
        assert_same_as_all(seed, &soups);
    }
}

#[test]
fn boxes_and_prisms_on_a_grid() {
    for seed in 0..scaled(120) {
        let rng = &mut Rng::new(seed);
        let one = |rng: &mut Rng| match rng.below(3) {
            0 => cubes(rng, 2),
            1 => {
                let outline = star(rng, 2);
                let low = rng.below(2) as f64;
                fan_prism(&outline, [low, low + 1.0 + rng.below(3) as f64], rng.below(3))
            }
            _ => bar(1.0 + 2.0 * rng.below(3) as f64),
        };
        let soups: Vec<Soup> = (0..3 + rng.below(8))
            .map(|_| {
                let soup = one(rng);
                on_grid(rng, soup, 4)
            })
            .collect();
        assert_same_as_all(seed, &soups);
    }
}

#[test]
fn tori_and_bars_anywhere() {
    for seed in 0..scaled(40) {
        let rng = &mut Rng::new(seed);
        let soups: Vec<Soup> = (0..4 + rng.below(24))
            .map(|_| {
                let soup = if rng.chance(0.5) {
                    torus(8 + u32::try_from(rng.below(8)).expect("few"), 6, rng.float(0.2, 0.6))
                } else {
                    bar(rng.float(1.0, 8.0))
                };
                anywhere(rng, soup, 3.0)
            })
            .collect();
        assert_same_as_all(seed, &soups);
    }
}
