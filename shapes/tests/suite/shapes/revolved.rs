//! Torus and revolutions against the theorem for steps: with the angle `α` of a step, a region sweeps the volume
//! `sin α · ∫ x dA` in it.

use glam::{DMat2, DVec2, DVec3};
use planecut_csg::{MaterialId, Transform, Tree};
use planecut_kernel::HalfSpace;
use planecut_shapes::Outline;
use planecut_shapes::primitives::{Extrusion, cone, extrude, revolve, revolve_in_steps, torus};

use super::judge::{assert_near, contains, figures, sweep};
use super::polygon;
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

/// Volume and area of loops revolved in `steps` steps of `alpha` radians.
fn swept(loops: &[Vec<DVec2>], steps: u32, alpha: f64, is_whole: bool) -> [f64; 2] {
    let volume = f64::from(steps) * alpha.sin() * polygon::first_moment(loops);
    let (sine, cosine) = (0.5 * alpha).sin_cos();
    let side = |(p, q): (DVec2, DVec2)| (p.x + q.x) * sine * ((q.x - p.x) * cosine).hypot(q.y - p.y);
    let sides: f64 = loops.iter().flat_map(|corners| polygon::edges(corners)).map(side).sum();
    let ends = if is_whole { 0.0 } else { 2.0 * polygon::area(loops) };
    [volume, f64::from(steps) * sides + ends]
}

fn corners(loops: &[Vec<DVec2>]) -> usize {
    loops.iter().map(Vec::len).sum()
}

/// A region at x > 0 whose sides are in general position.
fn region(rng: &mut Rng) -> Vec<Vec<DVec2>> {
    let center = DVec2::new(rng.float(2.5, 6.0), rng.float(-3.0, 3.0));
    polygon::random_region(rng, 12, center)
}

fn circle(n: u32, center: DVec2, radius: f64) -> Vec<DVec2> {
    let corner = |k| center + DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(n)) * radius;
    (0..n).map(corner).collect()
}

#[test]
fn tori_are_rings_of_quads() {
    sweep(40, |rng| {
        let (n, m) = (3 + rng.below(30) as u32, 3 + rng.below(20) as u32);
        let radius = rng.float(1.0, 4.0);
        let tube = radius * rng.float(0.1, 0.95);
        let found = figures(&torus(radius, tube, n, m, M).expect("a torus"));
        let profile = [circle(m, DVec2::new(radius, 0.0), tube)];
        let [volume, area] = swept(&profile, n, std::f64::consts::TAU / f64::from(n), true);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area, 1e-12, "area");
        // with sides straight on top and below, the quads there are one annulus each
        let flat = if m % 4 == 2 { 2 * (n as usize - 1) } else { 0 };
        let count = (n * m) as usize;
        assert_eq!((found.faces, found.corners, found.genus), (count - flat, count, 1), "{n} × {m}");
    });
    assert_eq!(figures(&torus(2.0, 1.0, 4, 4, M).expect("a torus")).volume, 16.0, "all numbers are short");
}

/// Two planes meet a third in one line where it is a multiple of their difference.
#[test]
fn steps_of_a_torus_share_their_edges_to_the_last_bit() {
    sweep(40, |rng| {
        let (n, m) = (3 + rng.below(30) as u32, 3 + rng.below(20) as u32);
        let radius = rng.float(1.0, 4.0);
        let steps = torus(radius, radius * rng.float(0.1, 0.95), n, m, M).expect("a torus");
        let steps: Vec<_> = steps.brushes().iter().map(|brush| &brush.faces).collect();
        assert_eq!(steps.len(), n as usize);
        for (k, faces) in steps.iter().enumerate() {
            let next = steps[(k + 1) % steps.len()];
            let walls: Vec<DVec3> = faces.iter().map(|face| face.half_space.normal()).filter(|n| n.z == 0.0).collect();
            let mut shared = 0;
            for face in faces
                .iter()
                .map(|face| &face.half_space)
                .filter(|plane| plane.normal().truncate() != DVec2::ZERO && plane.normal().z != 0.0)
            {
                let same = |other: &&HalfSpace| (other.normal().z, other.offset()) == (face.normal().z, face.offset());
                let planes = next.iter().map(|face| &face.half_space);
                for other in planes.filter(same).filter(|other| other.normal().dot(face.normal()) > 0.0) {
                    let difference = other.normal() - face.normal();
                    assert!(walls.iter().any(|wall| *wall == difference || *wall == -difference), "{difference}");
                    shared += 1;
                }
            }
            assert!(shared > 0, "of {n} × {m}");
        }
    });
}

#[test]
fn revolutions() {
    sweep(60, |rng| {
        let loops = region(rng);
        let (segments, is_whole) = (3 + rng.below(20) as u32, rng.chance(0.5));
        let angle = if is_whole { 360.0 } else { rng.float(10.0, 359.0) };
        let outline = Outline::from_loops(&loops).expect("an outline");
        let found = figures(&revolve(&outline, angle, segments, M).expect("a revolution"));
        let steps = (f64::from(segments) * angle / 360.0).ceil() as u32;
        let [volume, area] = swept(&loops, steps, angle.to_radians() / f64::from(steps), is_whole);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area, 1e-11, "area");
        let (rings, ends) = if is_whole { (steps, 0) } else { (steps + 1, 2) };
        let count = corners(&loops);
        assert_eq!((found.faces, found.corners), (steps as usize * count + ends, rings as usize * count));
        let holes = loops.len() as i64 - 1;
        // inside a ring each hole is a torus of its own; cut open, each is a handle
        let topology = if is_whole { (1 + holes, 1 + holes as usize) } else { (holes, 1) };
        assert_eq!((found.genus, found.components), topology);
    });
}

#[test]
fn points_of_a_revolution() {
    sweep(20, |rng| {
        let loops = region(rng);
        let (segments, angle) = (3 + rng.below(12) as u32, rng.float(10.0, 360.0));
        let outline = Outline::from_loops(&loops).expect("an outline");
        let tree = revolve(&outline, angle, segments, M).expect("a revolution");
        let steps = (f64::from(segments) * angle / 360.0).ceil();
        let alpha = angle.to_radians() / steps;
        let mut inside = 0;
        for _ in 0..2000 {
            let point = rng.point(-8.0, 8.0).with_z(rng.float(-5.0, 5.0));
            let step = (point.y.atan2(point.x).rem_euclid(std::f64::consts::TAU) / alpha).floor();
            let middle = DVec2::from_angle((step + 0.5) * alpha);
            let flat = DVec2::new(point.truncate().dot(middle) / (0.5 * alpha).cos(), point.z);
            let expected = step < steps && polygon::contains(&loops, flat);
            inside += usize::from(expected);
            if let Some(found) = contains(&tree, point, 1e-9) {
                assert_eq!(found, expected, "{point}");
            }
        }
        assert!(inside > 5 || angle < 60.0, "points inside were asked for: {inside}");
    });
}

#[test]
fn an_outline_may_touch_the_axis() {
    let triangle = vec![DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 3.0)];
    for n in [3, 4, 5, 16, 33] {
        let outline = Outline::from_loops(std::slice::from_ref(&triangle)).expect("a triangle");
        let found = figures(&revolve(&outline, 360.0, n, M).expect("a cone"));
        let expected = figures(&cone(3.0, 2.0, n, M).expect("a cone").into());
        assert_near(found.volume, expected.volume, 1e-13, "volume");
        assert_eq!((found.faces, found.corners, found.genus), (expected.faces, expected.corners, 0));
    }
    // a side on the axis, reflex corners and a corner that touches the axis in a point
    let loops = [[[0.0, 0.0], [2.0, 0.0], [2.0, 0.5], [1.0, 0.5], [1.0, 2.0], [0.0, 3.0]].map(DVec2::from).to_vec()];
    let found = figures(&revolve(&Outline::from_loops(&loops).expect("a profile"), 360.0, 32, M).expect("a body"));
    let [volume, area] = swept(&loops, 32, std::f64::consts::TAU / 32.0, true);
    assert_near(found.volume, volume, 1e-13, "volume");
    assert_near(found.area, area, 1e-13, "area");
    assert_eq!((found.faces, found.corners), (2 + 3 * 32, 4 * 32 + 1));
    let spindle = [[[0.0, 0.0], [2.0, 1.0], [1.0, 3.0], [0.0, 2.0], [1.0, 1.0]].map(DVec2::from).to_vec()];
    let found = figures(&revolve(&Outline::from_loops(&spindle).expect("a profile"), 360.0, 8, M).expect("a body"));
    let [volume, _] = swept(&spindle, 8, std::f64::consts::TAU / 8.0, true);
    assert_near(found.volume, volume, 1e-13, "volume");
}

#[test]
fn moved_and_mirrored_revolutions_keep_their_figures() {
    sweep(10, |rng| {
        let loops = region(rng);
        let outline = Outline::from_loops(&loops).expect("an outline");
        let tree = revolve(&outline, 360.0, 12, M).expect("a revolution");
        let turn = Transform::rotation(rng.unit(), rng.float(0.0, 360.0)).expect("a turn");
        let mirror = Transform::mirror(rng.unit()).expect("a mirror");
        let shift = Transform::translation(rng.point(-10.0, 10.0)).expect("a shift");
        let motion = turn.then(&mirror).and_then(|map| map.then(&shift)).expect("a motion");
        let (before, after) = (figures(&tree), figures(&tree.transformed(&motion).expect("in range")));
        assert_near(after.volume, before.volume, 1e-11, "volume");
        assert_near(after.area, before.area, 1e-11, "area");
        assert_eq!((after.faces, after.genus, after.components), (before.faces, before.genus, before.components));
    });
}

#[test]
fn a_revolution_by_one_step_is_cut_from_a_straight_extrusion() {
    // the cell is the upright prism over the outline, laid along y, between two half-planes
    let outline = Outline::circle(1.0, 8)
        .and_then(|circle| circle.transformed(DMat2::IDENTITY, DVec2::new(3.0, 0.0)))
        .expect("an outline");
    let found = figures(&revolve(&outline, 45.0, 8, M).expect("one step"));
    let long = extrude(&outline, &Extrusion { center: true, ..Extrusion::straight(20.0) }, M).expect("a prism");
    // x stretched to the middle of the chord, y up, z along
    let (sine, cosine) = 22.5_f64.to_radians().sin_cos();
    let lay = glam::DMat3::from_cols(DVec3::X * cosine, DVec3::Z, -DVec3::Y);
    let laid = long.transformed(&Transform::new(lay, DVec3::ZERO).expect("a map")).expect("in range");
    let walls = [(DVec3::new(-sine, cosine, 0.0), 0.0), (DVec3::new(-sine, -cosine, 0.0), 0.0)];
    let wedge = planecut_shapes::primitives::body_of_half_spaces(&walls, M).expect("a wedge");
    let expected = figures(&Tree::intersection([laid, wedge.into()]));
    assert_near(found.volume, expected.volume, 1e-13, "volume");
    assert_near(found.area, expected.area, 1e-13, "area");
    assert_eq!(found.faces, expected.faces);
}

#[test]
fn a_given_number_of_steps() {
    sweep(30, |rng| {
        let loops = region(rng);
        let outline = Outline::from_loops(&loops).expect("an outline");
        let (angle, steps) = (rng.float(5.0, 300.0), 2 + rng.below(9) as u32);
        let found = figures(&revolve_in_steps(&outline, angle, steps, M).expect("a revolution"));
        let [volume, area] = swept(&loops, steps, angle.to_radians() / f64::from(steps), false);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area, 1e-11, "area");
    });
    let ring = Outline::rectangle(DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0)).expect("a rectangle");
    for (angle, steps) in [(360.0, 2), (180.0, 1), (200.0, 1), (90.0, 0), (0.0, 3), (361.0, 9)] {
        let error = revolve_in_steps(&ring, angle, steps, M).expect_err("refused");
        assert!(matches!(error.parameter(), Some("steps" | "angle")), "{angle} in {steps}: {error}");
    }
    assert_near(
        figures(&revolve_in_steps(&ring, 360.0, 3, M).expect("a ring")).volume,
        3.0 * 0.75_f64.sqrt() * 1.5,
        1e-13,
        "volume",
    );
}

#[test]
fn a_whole_turn_of_a_convex_outline_is_one_brush_and_one_for_the_side_that_faces_the_axis() {
    let shapes = [
        (vec![[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [0.0, 2.0]], 1),
        (vec![[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], 2),
        (vec![[1.0, 0.0], [2.0, 1.0], [1.0, 2.0]], 2),
        // the side that faces the axis is all that bounds it above and below
        (vec![[2.0, 0.0], [2.0, 2.0], [1.0, 1.0]], 1 + 2),
    ];
    for (corners, brushes) in shapes {
        let loops = [corners.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>()];
        let tree = revolve(&Outline::from_loops(&loops).expect("an outline"), 360.0, 24, M).expect("a revolution");
        let steps = if brushes > 2 { 24 } else { brushes };
        assert_eq!(tree.brushes().len(), steps, "{corners:?}");
        let found = figures(&tree);
        let [volume, area] = swept(&loops, 24, std::f64::consts::TAU / 24.0, true);
        assert_near(found.volume, volume, 1e-13, "volume");
        assert_near(found.area, area, 1e-13, "area");
    }
}
