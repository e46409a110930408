//! Crossings against a brute force in rational arithmetic, and on surfaces whose answer is known.

use std::collections::BTreeSet;

use dashu_ratio::RBig;
use glam::DVec3;
use planecut_check::{CheckOptions, ContactKind, CrossingReport, TOLERANCE_F32, check_mesh};
use planecut_testkit::random::Rng;

type Point = [RBig; 3];
type Triangles = Vec<[u32; 3]>;

fn rational(p: DVec3) -> Point {
    p.to_array().map(|v| RBig::try_from(v).expect("test coordinates are finite"))
}

fn minus(a: &Point, b: &Point) -> Point {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn cross(a: &Point, b: &Point) -> Point {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: &Point, b: &Point) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn normal(t: &[Point; 3]) -> Point {
    cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]))
}

/// The inward half-spaces of a triangle within its plane, as functions of a point: positive inside.
fn inside(t: &[Point; 3], p: &Point) -> [RBig; 3] {
    let n = normal(t);
    [0, 1, 2].map(|k| {
        let (a, b) = (&t[k], &t[(k + 1) % 3]);
        dot(&cross(&n, &minus(b, a)), &minus(p, a))
    })
}

/// Whether an open segment runs through the interior of a triangle with area, in one point of its plane or along it.
fn segment_meets_interior(ends: [&Point; 2], t: &[Point; 3]) -> bool {
    // Each inside function is linear along the segment: keep the open range of parameters where all are positive.
    let (mut low, mut high) = (RBig::ZERO, RBig::ONE);
    for (at_start, at_end) in inside(t, ends[0]).into_iter().zip(inside(t, ends[1])) {
        let slope = &at_end - &at_start;
        if slope == RBig::ZERO {
            if at_start <= RBig::ZERO {
                return false;
            }
            continue;
        }
        let root = -at_start / &slope;
        if slope > RBig::ZERO { low = low.max(root) } else { high = high.min(root) }
    }
    low < high
}

/// Whether the interiors of two triangles with area cross: one is cut by the plane of the other, and the cut, an open
/// segment, meets the interior of the other.
fn crosses(a: &[Point; 3], b: &[Point; 3]) -> bool {
    let n = normal(b);
    let heights = [0, 1, 2].map(|k| dot(&n, &minus(&a[k], &b[0])));
    if !heights.iter().any(|h| *h > RBig::ZERO) || !heights.iter().any(|h| *h < RBig::ZERO) {
        return false;
    }
    let mut cut = BTreeSet::new();
    for k in 0..3 {
        let (h, g) = (&heights[k], &heights[(k + 1) % 3]);
        if *h == RBig::ZERO {
            cut.insert(a[k].clone());
        } else if (*h > RBig::ZERO) != (*g > RBig::ZERO) && *g != RBig::ZERO {
            let s = h / (h - g);
            let d = minus(&a[(k + 1) % 3], &a[k]);
            cut.insert([0, 1, 2].map(|i| &a[k][i] + &d[i] * &s));
        }
    }
    let ends: Vec<&Point> = cut.iter().collect();
    segment_meets_interior([ends[0], ends[1]], b)
}

/// Whether two triangles with area lie in one plane and share area: clip one by the sides of the other.
fn overlaps(a: &[Point; 3], b: &[Point; 3]) -> bool {
    let n = normal(b);
    if a.iter().any(|p| dot(&n, &minus(p, &b[0])) != RBig::ZERO) {
        return false;
    }
    let mut polygon = a.to_vec();
    for side in 0..3 {
        let mut kept = Vec::new();
        for (k, p) in polygon.iter().enumerate() {
            let q = &polygon[(k + 1) % polygon.len()];
            let (hp, hq) = (inside(b, p)[side].clone(), inside(b, q)[side].clone());
            if hp >= RBig::ZERO {
                kept.push(p.clone());
            }
            if (hp > RBig::ZERO && hq < RBig::ZERO) || (hp < RBig::ZERO && hq > RBig::ZERO) {
                let s = &hp / (&hp - &hq);
                let d = minus(q, p);
                kept.push([0, 1, 2].map(|i| &p[i] + &d[i] * &s));
            }
        }
        polygon = kept;
    }
    polygon
        .windows(2)
        .skip(1)
        .any(|pair| normal(&[polygon[0].clone(), pair[0].clone(), pair[1].clone()]) != rational(DVec3::ZERO))
}

fn crossings(positions: &[DVec3], triangles: &[[u32; 3]], tolerance: f64) -> CrossingReport {
    let options = CheckOptions { tolerance, ..CheckOptions::default() };
    check_mesh(positions, triangles, &options).crossings.expect("the data is usable")
}

#[test]
fn random_triangles_agree_with_rationals() {
    let seed = 0x5eed_2001;
    let mut random = Rng::new(seed);
    let (mut clean, mut crossed, mut overlapped) = (0, 0, 0);
    for case in 0..800 {
        // Few grid values make shared corners, touching edges and common planes frequent; the steps are exact in no f32.
        let size = 2 + random.below(8);
        let step = [1.0, 0.1, 1e-3 / 3.0, 1e150][case % 4];
        let shift = [0.0, 0.0, 1e3, 0.0][case % 4];
        let mut coordinate = || random.below(size) as f64 * step + shift;
        let pool: Vec<DVec3> = (0..7).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).collect();
        // Triangles share positions but no indices: without matched edges there are no edge crossings, which the oracle does
        // not know.
        let mut positions: Vec<DVec3> = Vec::new();
        for _ in 0..8 {
            let t = [(); 3].map(|()| pool[random.below(7)]);
            // The oracle is for triangles with area; those without are tested elsewhere.
            if normal(&t.map(rational)) != rational(DVec3::ZERO) {
                positions.extend(t);
            }
        }
        let triangles: Triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let corners = |t: [u32; 3]| t.map(|v| rational(positions[v as usize]));
        let mut involved = BTreeSet::new();
        let mut first = None;
        for (i, &t) in triangles.iter().enumerate() {
            for (j, &u) in triangles.iter().enumerate().skip(i + 1) {
                let kind = if crosses(&corners(t), &corners(u)) {
                    ContactKind::Crossing
                } else if overlaps(&corners(t), &corners(u)) {
                    ContactKind::Overlap
                } else {
                    continue;
                };
                first = first.or(Some((kind, [i, j])));
                involved.extend([i, j]);
            }
        }
        let found = crossings(&positions, &triangles, 0.0);
        let context = format!("seed {seed:#x} case {case}: {positions:?}");
        assert_eq!(found.first.map(|c| (c.kind, c.triangles)), first, "{context}");
        assert_eq!(found.triangles, involved.len(), "{context}");
        match first {
            None => clean += 1,
            Some((ContactKind::Crossing, _)) => crossed += 1,
            Some(_) => overlapped += 1,
        }
    }
    assert!(clean > 50 && crossed > 50 && overlapped > 50, "{clean} clean, {crossed} crossed, {overlapped} overlapped");
}

/// A box on a unit grid, each unit square cut into two triangles; corners are shared.
fn grid_box(min: [i32; 3], max: [i32; 3]) -> (Vec<DVec3>, Triangles) {
    let mut positions = Vec::new();
    let mut triangles = Triangles::new();
    let mut vertex = |p: DVec3| {
        positions.iter().position(|&q| q == p).unwrap_or_else(|| {
            positions.push(p);
            positions.len() - 1
        }) as u32
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, outward) in [(min[axis], false), (max[axis], true)] {
            for i in min[u]..max[u] {
                for j in min[v]..max[v] {
                    let mut corner = |di: i32, dj: i32| {
                        let mut p = DVec3::ZERO;
                        (p[axis], p[u], p[v]) = (f64::from(side), f64::from(i + di), f64::from(j + dj));
                        vertex(p)
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    let quad = if outward { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                    triangles.extend(quad);
                }
            }
        }
    }
    (positions, triangles)
}

fn both(
    (mut positions, mut triangles): (Vec<DVec3>, Triangles),
    other: (Vec<DVec3>, Triangles),
) -> (Vec<DVec3>, Triangles) {
    let shift = positions.len() as u32;
    positions.extend(other.0);
    triangles.extend(other.1.iter().map(|t| t.map(|v| v + shift)));
    (positions, triangles)
}

/// A turn that leaves no coordinate exact, then rounding to `f32`.
fn turned_and_rounded(positions: &[DVec3]) -> Vec<DVec3> {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    positions.iter().map(|&p| (turn * p).as_vec3().as_dvec3()).collect()
}

#[test]
fn boxes_that_cross_along_grid_lines_are_found() {
    // Every line in which the two surfaces meet is an edge of both: no two triangle interiors cross.
    let mesh = both(grid_box([0, 0, 0], [3, 3, 3]), grid_box([1, 1, 1], [5, 5, 5]));
    let rounded = turned_and_rounded(&mesh.0);
    for (positions, tolerance) in [(&mesh.0, 0.0), (&mesh.0, 1e-9), (&rounded, TOLERANCE_F32)] {
        let report = check_mesh(positions, &mesh.1, &CheckOptions { tolerance, ..CheckOptions::default() });
        assert!(report.topology.manifold);
        let first = report.crossings.and_then(|c| c.first).expect("the boxes cross");
        assert_eq!(first.kind, ContactKind::EdgeCrossing);
    }
}

#[test]
fn a_bar_through_a_coarse_box_is_found_where_its_edges_lie_in_faces() {
    // The bar's long edges cross the box's face planes; its ring edges lie in the box's top face.
    let ring = [[1.0, 1.0], [2.0, 1.0], [2.0, 1.5], [1.0, 1.5]];
    let levels = [3.0, 4.0, 5.0];
    let mut bar: Vec<DVec3> = levels.iter().flat_map(|&z| ring.map(|[x, y]| DVec3::new(x, y, z))).collect();
    bar.extend([DVec3::new(1.5, 1.2, 2.0), DVec3::new(1.5, 1.2, 6.0)]);
    let mut triangles = Triangles::new();
    for k in 0..4u32 {
        let l = (k + 1) % 4;
        for level in [0, 4] {
            let [a, b, c, d] = [k + level, l + level, l + level + 4, k + level + 4];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.extend([[l, k, 12], [k + 8, l + 8, 13]]);
    }
    // One level lies in the top face z = 4 of a big box.
    let corners = (0..8).map(|i| {
        DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * DVec3::new(20.0, 9.0, 4.0)
            - DVec3::new(5.0, 2.0, 0.0)
    });
    let quads = [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let coarse = (corners.collect(), quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect());
    let mesh = both((bar, triangles), coarse);
    let report = check_mesh(&mesh.0, &mesh.1, &CheckOptions::default());
    assert!(report.topology.manifold, "{report}");
    assert_eq!(report.crossings.and_then(|c| c.first).map(|c| c.kind), Some(ContactKind::EdgeCrossing));
}

#[test]
fn boxes_that_touch_are_sound_and_doubled_walls_are_not() {
    let unit = || grid_box([0, 0, 0], [2, 2, 2]);
    let touching = [
        ("edge", grid_box([2, 2, 0], [4, 4, 2])),
        ("part of an edge", grid_box([2, 2, 1], [4, 4, 4])),
        ("corner", grid_box([2, 2, 2], [3, 3, 3])),
        ("nothing", grid_box([3, 0, 0], [4, 1, 1])),
    ];
    for (what, other) in touching {
        let (positions, triangles) = both(unit(), other);
        for (positions, tolerance) in
            [(&positions, 0.0), (&positions, 1e-9), (&turned_and_rounded(&positions), TOLERANCE_F32)]
        {
            let found = crossings(positions, &triangles, tolerance);
            assert_eq!(found.first, None, "boxes that share {what}, tolerance {tolerance}");
        }
    }
    let (positions, triangles) = both(unit(), grid_box([2, 1, 1], [4, 3, 3]));
    let rounded = turned_and_rounded(&positions);
    for (positions, tolerance) in [(&positions, 0.0), (&positions, 1e-9), (&rounded, 1e-9)] {
        let first = crossings(positions, &triangles, tolerance).first;
        assert_eq!(first.map(|c| c.kind), Some(ContactKind::Overlap), "tolerance {tolerance}");
    }
    // In single precision it may have been a gap.
    assert_eq!(crossings(&rounded, &triangles, TOLERANCE_F32).first, None);
}

/// A sphere of `2 · rows · columns` triangles, less two per column at the poles.
fn sphere(columns: u32, rows: u32, centre: DVec3) -> (Vec<DVec3>, Triangles) {
    let mut positions = vec![centre + DVec3::Z, centre - DVec3::Z];
    for i in 1..rows {
        let latitude = std::f64::consts::PI * f64::from(i) / f64::from(rows);
        for j in 0..columns {
            let longitude = std::f64::consts::TAU * f64::from(j) / f64::from(columns);
            let (s, c) = latitude.sin_cos();
            positions.push(centre + DVec3::new(s * longitude.cos(), s * longitude.sin(), c));
        }
    }
    let at = |i: u32, j: u32| match i {
        0 => 0,
        i if i == rows => 1,
        i => 2 + (i - 1) * columns + j % columns,
    };
    let quads =
        (0..rows).flat_map(|i| (0..columns).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let triangles =
        quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).filter(|[a, b, c]| a != b && b != c && c != a);
    (positions, triangles.collect())
}

#[test]
fn rounded_spheres_do_not_cross_themselves() {
    // Near the poles triangles are narrower than the rounding error: nothing may be reported.
    for centre in [DVec3::ZERO, DVec3::new(50.0, -3.0, 7.0)] {
        let (positions, triangles) = sphere(2000, 20, centre);
        let rounded: Vec<DVec3> = positions.iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let report =
            check_mesh(&rounded, &triangles, &CheckOptions { tolerance: TOLERANCE_F32, ..CheckOptions::default() });
        assert!(report.is_sound(), "{report}");
    }
}

#[test]
fn spheres_that_meet_cross_in_a_ring() {
    let (positions, triangles) = both(sphere(60, 30, DVec3::ZERO), sphere(60, 30, DVec3::new(0.9, 0.3, 0.2)));
    let report = check_mesh(&positions, &triangles, &CheckOptions::default());
    assert!(report.topology.manifold);
    let found = report.crossings.expect("the data is usable");
    assert_eq!(found.first.map(|c| c.kind), Some(ContactKind::Crossing));
    // The ring runs through triangles of both, but not through most of them.
    assert!(found.triangles > 100 && found.triangles < triangles.len() / 2, "{}", found.triangles);
}

#[cfg(feature = "parallel")]
#[test]
fn the_answer_does_not_depend_on_the_number_of_threads() {
    let (positions, triangles) = both(sphere(40, 20, DVec3::ZERO), sphere(40, 20, DVec3::new(0.7, 0.1, 0.0)));
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| crossings(&positions, &triangles, 1e-9))
    };
    assert_eq!(with_threads(1), with_threads(4));
}
