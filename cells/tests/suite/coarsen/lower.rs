//! Polytopes with fewer planes, against volumes over all triples of planes, in rationals.

use dashu_ratio::RBig;
use glam::DVec3;
use planecut_cells::coarsen::{CoarsenError, lower};
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::{HalfSpace, IncrementalPolytope, hull};
use planecut_testkit::random::Rng;

use super::judge::assert_holds_points;

type Vector = [RBig; 3];

fn rational(v: f64) -> RBig {
    RBig::try_from(v).expect("a finite number")
}

fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

/// The volume of planes `n·x ≤ d`; `None` where they are unbounded: then some `±n₁×n₂` is a direction without end.
fn volume(planes: &[(Vector, RBig)]) -> Option<RBig> {
    let mut corners: Vec<Vector> = Vec::new();
    for (i, (a, d)) in planes.iter().enumerate() {
        for (j, (b, e)) in planes.iter().enumerate().skip(i + 1) {
            let along = cross(a, b);
            if along.iter().all(|v| *v == RBig::ZERO) {
                continue;
            }
            let is_endless = |side: i32| planes.iter().all(|(n, _)| dot(n, &along) * RBig::from(side) <= RBig::ZERO);
            if is_endless(1) || is_endless(-1) {
                return None;
            }
            for (c, f) in &planes[j + 1..] {
                let determinant = dot(&along, c);
                if determinant == RBig::ZERO {
                    continue;
                }
                let (bc, ca) = (cross(b, c), cross(c, a));
                let corner = [0, 1, 2].map(|k| (&bc[k] * d + &ca[k] * e + &along[k] * f) / &determinant);
                if planes.iter().all(|(n, d)| dot(n, &corner) <= *d) && !corners.contains(&corner) {
                    corners.push(corner);
                }
            }
        }
    }
    let mut six = RBig::ZERO;
    for (number, (n, d)) in planes.iter().enumerate() {
        if planes[..number].iter().any(|(m, e)| {
            cross(m, n).iter().all(|v| *v == RBig::ZERO) && dot(m, n) > RBig::ZERO && e * dot(n, n) == d * dot(m, n)
        }) {
            continue;
        }
        let on: Vec<&Vector> = corners.iter().filter(|corner| dot(n, corner) == *d).collect();
        // each edge of the face: a pair with all others on its left
        for p in &on {
            for q in &on {
                let side = cross(n, &minus(q, p));
                let is_edge = p != q && on.iter().all(|r| dot(&side, &minus(r, p)) >= RBig::ZERO);
                let along = minus(q, p);
                let is_whole = on.iter().all(|r| {
                    let to = minus(r, p);
                    dot(&side, &to) != RBig::ZERO
                        || (dot(&along, &to) >= RBig::ZERO && dot(&to, &to) <= dot(&along, &along))
                });
                if is_edge && is_whole {
                    let [a, b, c] = [on[0], *p, *q].map(|r| minus(r, &corners[0]));
                    six += dot(&a, &cross(&b, &c));
                }
            }
        }
    }
    Some(six / RBig::from(6))
}

fn exactly(polytope: &IncrementalPolytope) -> Vec<(Vector, RBig)> {
    polytope.planes().map(|(_, plane)| (plane.normal().to_array().map(rational), rational(plane.offset()))).collect()
}

/// Planes around the origin: of any direction, or through points of a coarse lattice.
fn random_body(rng: &mut Rng, is_lattice: bool) -> Option<IncrementalPolytope> {
    if is_lattice {
        let points: Vec<DVec3> = (0..9).map(|_| DVec3::from_array(rng.lattice(2))).collect();
        return hull(&points).ok();
    }
    let mut body = IncrementalPolytope::new();
    for _ in 0..11 {
        let plane = HalfSpace::new(rng.direction(), rng.float(0.8, 1.0)).expect("in range");
        body.add_plane(plane);
    }
    body.is_bounded().then_some(body)
}

#[test]
fn each_plane_that_goes_is_one_that_adds_least() {
    let mut steps = 0;
    for seed in 0..10 {
        let mut rng = Rng::spread(seed);
        let Some(mut body) = random_body(&mut rng, seed % 2 == 0) else { continue };
        lower(&mut body, None, None).expect("bounded");
        while body.planes().count() > 6 {
            let before = exactly(&body);
            let whole = volume(&before).expect("bounded");
            let without = |number: usize| {
                let mut others = before.clone();
                others.remove(number);
                others
            };
            let least = (0..before.len()).filter_map(|number| volume(&without(number))).min().expect("one may go");
            let added = lower(&mut body, Some(before.len() - 1), None).expect("one may go");
            let after = exactly(&body);
            assert!(after.len() == before.len() - 1 && after.iter().all(|plane| before.contains(plane)), "{seed}");
            let found = volume(&after).expect("bounded");
            let near = |a: &RBig, b: &RBig| (a - b).to_f64().value().abs() <= 1e-12 * whole.to_f64().value();
            assert!(near(&found, &least), "{seed}: {} {}", found.to_f64().value(), least.to_f64().value());
            assert!(near(&(&found - &whole), &rational(added)), "{seed}");
            steps += 1;
        }
    }
    assert!(steps > 20, "{steps}");
}

#[test]
fn costs_that_are_out_of_date_do_not_change_the_order() {
    for seed in 0..20 {
        let mut rng = Rng::spread(seed);
        let points: Vec<DVec3> = (0..200).map(|_| rng.unit() * DVec3::new(1.0, 0.8, 0.6)).collect();
        let mut at_once = hull(&points).expect("a hull");
        let mut one_by_one = at_once.clone();
        let most = 8 + rng.below(60);
        let added = lower(&mut at_once, Some(most), None).expect("bounded");
        let mut sum = 0.0;
        while one_by_one.planes().count() > most {
            let next = one_by_one.planes().count() - 1;
            sum += lower(&mut one_by_one, Some(next), None).expect("bounded");
        }
        let planes = |body: &IncrementalPolytope| body.planes().map(|(plane, _)| plane).collect::<Vec<_>>();
        assert_eq!(planes(&at_once), planes(&one_by_one), "{seed}");
        assert!((added - sum).abs() < 1e-12, "{seed}: {added} {sum}");
    }
}

/// Points around an axis at some heights.
fn rings(count: usize, heights: &[(f64, f64)]) -> Vec<DVec3> {
    let at = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    let ring = |(height, radius): &(f64, f64)| {
        let (height, radius) = (*height, *radius);
        (0..count).map(move |k| DVec3::new(radius * at(k).cos(), radius * at(k).sin(), height))
    };
    heights.iter().flat_map(ring).collect()
}

/// Bodies with many planes through one corner, with faces of many corners, thin ones and one with many coplanar points.
fn hard_bodies() -> Vec<(&'static str, Vec<DVec3>)> {
    let mut cone = rings(300, &[(0.0, 1.0)]);
    cone.push(DVec3::Z);
    let mut spindle = rings(64, &[(0.0, 1.0)]);
    spindle.extend([DVec3::Z, DVec3::NEG_Z]);
    let lattice = |keep: fn(i32) -> bool| {
        let point = |k: i32| DVec3::from_array([k % 9, k / 9 % 9, k / 81].map(|v| f64::from(v - 4)));
        (0..729).map(point).filter(|p| keep(p.length_squared() as i32)).collect::<Vec<_>>()
    };
    let chamfered = lattice(|_| true).into_iter().filter(|p| p.abs().element_sum() <= 10.0).collect();
    let mut rng = Rng::spread(1);
    let ball: Vec<DVec3> = (0..400).map(|_| rng.unit()).collect();
    let scaled = |by: DVec3| ball.iter().map(|p| *p * by).collect::<Vec<_>>();
    vec![
        ("prism", rings(300, &[(0.0, 1.0), (1.0, 1.0)])),
        ("flat prism", rings(300, &[(0.0, 1.0), (1e-6, 1.0)])),
        ("frustum", rings(300, &[(0.0, 1.0), (0.01, 0.5)])),
        ("cone", cone),
        ("spindle", spindle),
        ("cube", lattice(|_| true)),
        ("chamfered cube", chamfered),
        ("lattice ball", lattice(|r| r <= 16)),
        ("needle", scaled(DVec3::new(1.0, 1e-7, 1e-7))),
        ("plate", scaled(DVec3::new(1.0, 1.0, 1e-9))),
        ("far ball", ball.iter().map(|p| *p + DVec3::new(1e7, -3e7, 2e7)).collect()),
        ("small ball", scaled(DVec3::splat(1e-30))),
    ]
}

#[test]
fn hard_bodies_are_enclosed_within_their_caps() {
    for (name, points) in hard_bodies() {
        for (max_faces, max_vertices) in
            [(Some(64), None), (Some(16), Some(12)), (Some(6), None), (None, Some(8)), (None, Some(40))]
        {
            let whole = hull(&points).expect("a hull");
            let mut body = whole.clone();
            let added = lower(&mut body, max_faces, max_vertices).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(body.is_bounded(), "{name}");
            let (corners, polygons) = body.to_mesh();
            assert!(polygons.len() <= max_faces.unwrap_or(usize::MAX), "{name}: {} faces", polygons.len());
            assert!(corners.len() <= max_vertices.unwrap_or(usize::MAX), "{name}: {} vertices", corners.len());
            let cell = Brush::from_half_spaces(body.planes().map(|(_, plane)| *plane), MaterialId(0));
            assert_holds_points(&[cell], &points);
            let [before, after] = [&whole, &body].map(|body| body.measures().expect("bounded").volume);
            // relative to the box, of which rounding far from the origin is a small part
            assert!((after - before - added).abs() <= 1e-6 * after, "{name}: {before} {after} {added}");
        }
    }
}

#[test]
fn no_more_planes_go_than_must() {
    for (name, points) in hard_bodies() {
        for most in [12, 40] {
            let mut body = hull(&points).expect("a hull");
            if body.faces().len() <= most || body.vertex_count() <= most {
                continue;
            }
            let mut by_vertices = body.clone();
            lower(&mut body, Some(most), None).expect("bounded");
            assert_eq!(body.planes().count(), most, "{name}");
            // with one plane more there would be more vertices
            lower(&mut by_vertices, None, Some(most)).expect("bounded");
            let mut before = hull(&points).expect("a hull");
            lower(&mut before, Some(by_vertices.planes().count() + 1), None).expect("bounded");
            assert!(before.vertex_count() > most, "{name}: {} of {most}", before.vertex_count());
        }
    }
}

#[test]
fn many_faces_become_few() {
    let mut rng = Rng::spread(3);
    let points: Vec<DVec3> = (0..5000).map(|_| rng.unit() * DVec3::new(3.0, 2.0, 1.0)).collect();
    let mut body = hull(&points).expect("a hull");
    lower(&mut body, Some(64), None).expect("bounded");
    assert_eq!(body.planes().count(), 64);
    let cell = Brush::from_half_spaces(body.planes().map(|(_, plane)| *plane), MaterialId(0));
    assert_holds_points(&[cell], &points);
}

#[test]
fn what_has_no_fewer_planes_is_refused() {
    let mut octant = IncrementalPolytope::new();
    for axis in DVec3::AXES {
        octant.add_plane(HalfSpace::new(-axis, 0.0).expect("in range"));
    }
    assert_eq!(lower(&mut octant, Some(6), None), Err(CoarsenError::Unbounded));
    let mut cube = hull(&rings(4, &[(0.0, 1.0), (1.0, 1.0)])).expect("a hull");
    assert!(matches!(lower(&mut cube, Some(5), None), Err(CoarsenError::Option { option: "max_faces", .. })));
    assert!(matches!(lower(&mut cube, None, Some(7)), Err(CoarsenError::Option { option: "max_vertices", .. })));
    assert_eq!(lower(&mut cube, Some(6), Some(8)), Ok(0.0));
    cube.add_plane(HalfSpace::new(DVec3::Z, -1.0).expect("in range"));
    assert_eq!(lower(&mut cube, Some(6), None), Err(CoarsenError::Empty));
}
