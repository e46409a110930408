//! Cells as files hold them, judged by exact rationals: closed, convex, around the cell, without doubled corners.

use std::collections::HashMap;

use dashu_ratio::RBig;
use glam::DVec3;
use planecut_cells::coarsen::{Writing, written_meshes};
use planecut_csg::{Brush, Material, MaterialId, Mesh};
use planecut_shapes::primitives;
use planecut_testkit::random::Rng;

const CASES: u64 = 60;

type Exact = [RBig; 3];

fn exact(point: DVec3) -> Exact {
    point.to_array().map(|v| RBig::try_from(v).expect("a finite number"))
}

/// Positive where the last point is outside of the plane of the others, which are counter-clockwise seen from there.
fn side([a, b, c]: [&Exact; 3], point: &Exact) -> RBig {
    let minus = |p: &Exact| [0, 1, 2].map(|k| &p[k] - &a[k]);
    let ([u, v, w], [x, y, z], [p, q, r]) = (minus(b), minus(c), minus(point));
    (&v * &z - &w * &y) * p + (&w * &x - &u * &z) * q + (&u * &y - &v * &x) * r
}

/// Fails where the mesh is not the closed surface of a convex body that holds the points.
#[track_caller]
fn assert_is_convex_around(mesh: &Mesh, points: &[DVec3], case: &str) {
    let corners: Vec<Exact> = mesh.positions.iter().copied().map(exact).collect();
    let points: Vec<Exact> = points.iter().copied().map(exact).collect();
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    assert!(!mesh.triangles.is_empty(), "{case}: nothing is written");
    for [a, b, c] in &mesh.triangles {
        [(*a, *b), (*b, *c), (*c, *a)].into_iter().for_each(|edge| *edges.entry(edge).or_default() += 1);
        let plane = [a, b, c].map(|corner| &corners[*corner as usize]);
        let sides: Vec<RBig> = corners.iter().map(|corner| side(plane, corner)).collect();
        assert!(sides.iter().all(|side| *side <= RBig::ZERO), "{case}: a corner is outside of a facet");
        assert!(sides.iter().any(|side| *side < RBig::ZERO), "{case}: a facet without an area, or a flat body");
        assert!(points.iter().all(|point| side(plane, point) <= RBig::ZERO), "{case}: a point is outside");
    }
    assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.contains_key(&(*b, *a))), "{case}: not closed");
}

fn size(points: &[DVec3]) -> f64 {
    let low = points.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = points.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    (high - low).max_element()
}

fn nearest_corners(positions: &[DVec3]) -> f64 {
    let pairs = (0..positions.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    pairs.map(|(a, b)| positions[a].distance(positions[b])).fold(f64::INFINITY, f64::min)
}

/// Points of a body that is flat or thin in random directions, some of its points nearly doubled.
fn sliver(rng: &mut Rng) -> Vec<DVec3> {
    let unit = |rng: &mut Rng| rng.integer(-1 << 30, 1 << 30) as f64 / (1_u64 << 30) as f64;
    let vector = |rng: &mut Rng| DVec3::new(unit(rng), unit(rng), unit(rng));
    let axes = [vector(rng), vector(rng), vector(rng)];
    let thin = [1.0, 1e-4, 1e-8, 1e-10, 1e-13];
    let factors = [1.0, thin[rng.below(2)], thin[rng.below(5)]];
    let mut points = Vec::new();
    for _ in 0..4 + rng.below(12) {
        let at = vector(rng) * DVec3::from_array(factors);
        points.push(axes[0] * at.x + axes[1] * at.y + axes[2] * at.z);
        if rng.below(4) == 0 {
            let near = points[points.len() - 1] + vector(rng) * 1e-10;
            points.push(near);
        }
    }
    points
}

/// Random bodies, slivers among them, near and far from the origin and of all sizes.
fn bodies(rng: &mut Rng) -> Vec<(Vec<DVec3>, Brush)> {
    let (far, scale) = ([0.0, 1.0, 1e6][rng.below(3)], [1e-6, 1.0, 1e3][rng.below(3)]);
    let mut bodies = Vec::new();
    while bodies.len() < 3 {
        let shift = DVec3::new(far, -0.5 * far, 0.25 * far);
        let points: Vec<DVec3> = sliver(rng).into_iter().map(|point| (point + shift) * scale).collect();
        if let Ok(brush) = primitives::hull_of_points(&points, MaterialId(0)) {
            bodies.push((points, brush));
        }
    }
    bodies
}

#[test]
fn written_cells_hold_their_points_in_every_precision() {
    let double = |positions: &[DVec3]| positions.to_vec();
    let single = |positions: &[DVec3]| positions.iter().map(|p| p.as_vec3().as_dvec3()).collect::<Vec<_>>();
    // a grid of some 12 bits
    let coarse = |positions: &[DVec3]| {
        let step = (size(positions).max(f64::MIN_POSITIVE) / 4096.0).log2().ceil().exp2();
        positions.iter().map(|p| (*p / step).round() * step).collect::<Vec<_>>()
    };
    type Stored<'a> = &'a (dyn Fn(&[DVec3]) -> Vec<DVec3> + Sync);
    let formats: [(&str, Stored<'_>); 3] = [("double", &double), ("single", &single), ("grid", &coarse)];
    let materials = [Material::named("any")];
    for seed in 0..CASES {
        let bodies = bodies(&mut Rng::spread(seed));
        let cells: Vec<Brush> = bodies.iter().map(|(_, brush)| brush.clone()).collect();
        for (name, stored) in formats {
            let writing = Writing { scale: 1.0, max_vertices: usize::MAX, encloses: true, is_separated: true, stored };
            let meshes = written_meshes(&cells, &materials, &writing).expect("in range");
            for ((points, _), mesh) in bodies.iter().zip(&meshes) {
                let case = format!("seed {seed}, {name}: {points:?}");
                assert_is_convex_around(mesh, points, &case);
                if name != "grid" {
                    assert_eq!(stored(&mesh.positions), mesh.positions, "{case}: not as stored");
                }
                let (nearest, size) = (nearest_corners(&mesh.positions), size(&mesh.positions));
                assert!(nearest >= 1e-9 * size, "{case}: corners {nearest} apart");
            }
        }
    }
}

#[test]
fn written_cells_hold_their_points_times_any_scale() {
    let double = |positions: &[DVec3]| positions.to_vec();
    for (seed, scale) in (1000..1000 + CASES).zip([0.0254, 1e-3, 39.37, 1.0 / 3.0].into_iter().cycle()) {
        let bodies = bodies(&mut Rng::spread(seed));
        let cells: Vec<Brush> = bodies.iter().map(|(_, brush)| brush.clone()).collect();
        let writing = Writing { scale, max_vertices: usize::MAX, encloses: true, is_separated: true, stored: &double };
        let meshes = written_meshes(&cells, &[Material::named("any")], &writing).expect("in range");
        for ((points, _), mesh) in bodies.iter().zip(&meshes) {
            // the points stay, and the mesh is divided: what is exact in rationals alone
            let factor = RBig::try_from(scale).expect("a finite number");
            let points: Vec<Exact> = points.iter().map(|point| exact(*point).map(|v| v * &factor)).collect();
            for corners in &mesh.triangles {
                let plane = corners.map(|corner| exact(mesh.positions[corner as usize]));
                let is_outside = |point: &Exact| side([&plane[0], &plane[1], &plane[2]], point) > RBig::ZERO;
                assert!(!points.iter().any(is_outside), "seed {seed}, scale {scale}");
            }
        }
    }
}

#[test]
fn a_written_cell_has_no_more_vertices_than_it_may_have() {
    let double = |positions: &[DVec3]| positions.to_vec();
    let mut few = 0;
    for seed in 2000..2000 + CASES {
        let bodies = bodies(&mut Rng::spread(seed));
        let cells: Vec<Brush> = bodies.iter().map(|(_, brush)| brush.clone()).collect();
        let writing = Writing { scale: 1.0, max_vertices: 8, encloses: true, is_separated: true, stored: &double };
        let meshes = written_meshes(&cells, &[Material::named("any")], &writing).expect("in range");
        for ((points, _), mesh) in bodies.iter().zip(&meshes) {
            assert_is_convex_around(mesh, points, &format!("seed {seed}"));
            assert!(mesh.positions.len() <= 8, "seed {seed}: {} vertices", mesh.positions.len());
            few += usize::from(points.len() > 8);
        }
    }
    assert!(few > 0, "no body had more points than are allowed");
}

#[test]
fn a_box_on_a_grid_is_written_as_it_is() {
    let single = |positions: &[DVec3]| positions.iter().map(|p| p.as_vec3().as_dvec3()).collect::<Vec<_>>();
    let cell = Brush::cuboid(DVec3::new(-1.0, 0.5, 3.0), DVec3::new(7.0, 2.25, 4.0), MaterialId(0));
    let writing = Writing { scale: 1.0, max_vertices: 8, encloses: true, is_separated: true, stored: &single };
    let meshes = written_meshes(&[cell], &[Material::named("any")], &writing).expect("in range");
    let mut corners: Vec<[f64; 3]> = meshes[0].positions.iter().map(|p| p.to_array()).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let expected: Vec<[f64; 3]> =
        (0..8).map(|k| [[-1.0, 7.0][k >> 2], [0.5, 2.25][k >> 1 & 1], [3.0, 4.0][k & 1]]).collect();
    assert_eq!((corners, meshes[0].faces.len()), (expected, 6));
}
