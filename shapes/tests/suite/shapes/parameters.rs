//! What is not accepted: a typed error that names the parameter, and never a panic.

use glam::{DVec2, DVec3};
use planecut_csg::{MaterialId, Model, Tree, summarize};
use planecut_shapes::Outline;
use planecut_shapes::outline::Join;
use planecut_shapes::primitives::{
    Extrusion, MAX_LENGTH, MAX_SEGMENTS, RegularSolid, ShapeError, body_of_half_spaces, capsule, cone, cuboid,
    cylinder, extrude, hull_of_points, prism, pyramid, regular, revolve, sphere, torus, wedge,
};

use super::judge::sweep;
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);
const LENGTHS: [f64; 16] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    -1.0,
    -0.0,
    0.0,
    0.99e-25,
    1.01e25,
    1e-25,
    1e25,
    1.0,
    2.5,
    3.0,
];
const COUNTS: [u32; 8] = [0, 1, 2, 3, 4, 7, MAX_SEGMENTS + 1, u32::MAX];

fn is_length(v: f64) -> bool {
    (MAX_LENGTH.recip()..=MAX_LENGTH).contains(&v)
}

fn is_coordinate(v: f64) -> bool {
    v.abs() <= MAX_LENGTH
}

/// What is too small counts as 0.
fn is_below(min: DVec3, max: DVec3) -> bool {
    let seen = |v: f64| if v.abs() < MAX_LENGTH.recip() { 0.0 } else { v };
    (0..3).all(|k| seen(min[k]) < seen(max[k]))
}

fn is_count(n: u32) -> bool {
    (3..=MAX_SEGMENTS).contains(&n)
}

/// A shape is made where its parameters are accepted; where they are not, the error blames one of the names.
#[track_caller]
fn check<T: Into<Tree>>(result: Result<T, ShapeError>, is_accepted: bool, names: &[&str], is_extreme: bool) {
    match result {
        Ok(shape) => {
            assert!(is_accepted, "made of parameters that are not accepted");
            let tree = shape.into();
            let summary = summarize(&Model { materials: Vec::new(), tree });
            assert!(is_extreme || summary.unbounded.is_empty());
        }
        Err(error) => {
            let text = error.to_string();
            assert!(!is_accepted, "refused: {text}");
            let parameter = error.parameter().expect("a parameter is to blame");
            assert!(names.contains(&parameter) && text.starts_with(parameter), "{text}");
            assert!(text.contains("found ") && text.contains(", expected "), "{text}");
        }
    }
}

#[test]
fn bodies_of_random_bad_values() {
    sweep(3000, |rng| {
        let length = |rng: &mut Rng| rng.pick(&LENGTHS);
        let (a, b, c) = (length(rng), length(rng), length(rng));
        let (n, m) = (rng.pick(&COUNTS), rng.pick(&COUNTS));
        // what is thinner than the tolerance within which planes are one has no inside, or no end
        let sizes = [a, b, c].map(f64::abs).into_iter().filter(|v| *v > 0.0);
        let extreme = sizes.clone().fold(0.0, f64::max) > 1e9 * sizes.fold(f64::INFINITY, f64::min);
        check(sphere(a, n, M), is_length(a) && is_count(n), &["radius", "segments"], extreme);
        check(
            capsule(a, b, n, M),
            (a == 0.0 || is_length(a)) && is_length(b) && is_count(n),
            &["height", "radius", "segments"],
            extreme,
        );
        let radii = (b == 0.0 || is_length(b)) && (c == 0.0 || is_length(c)) && b.max(c) > 0.0;
        check(
            cylinder(a, b, c, n, M),
            is_length(a) && radii && is_count(n),
            &["height", "radius", "top_radius", "segments"],
            extreme,
        );
        check(
            cone(a, b, n, M),
            is_length(a) && is_length(b) && is_count(n),
            &["height", "radius", "segments"],
            extreme,
        );
        check(prism(a, b, n, M), is_length(a) && is_length(b) && is_count(n), &["height", "radius", "sides"], extreme);
        check(
            pyramid(a, b, n, M),
            is_length(a) && is_length(b) && is_count(n),
            &["height", "radius", "sides"],
            extreme,
        );
        check(wedge(DVec3::new(a, b, c), M), [a, b, c].into_iter().all(is_length), &["size"], extreme);
        check(regular(RegularSolid::Icosahedron, a, M), is_length(a), &["radius"], extreme);
        let tube = is_length(a) && is_length(b) && b < a;
        check(
            torus(a, b, n, m, M),
            tube && is_count(n) && is_count(m),
            &["radius", "tube", "segments", "tube_segments"],
            extreme,
        );
    });
}

#[test]
fn boxes_of_random_bad_values() {
    sweep(2000, |rng| {
        let mut point = || DVec3::new(rng.pick(&LENGTHS), rng.pick(&LENGTHS), rng.pick(&LENGTHS));
        let (min, max) = (point(), point());
        let is_accepted = min.to_array().into_iter().chain(max.to_array()).all(is_coordinate) && is_below(min, max);
        check(cuboid(min, max, M), is_accepted, &["min", "max"], false);
        let (low, high) = (min.truncate(), max.truncate());
        let is_accepted = low.to_array().into_iter().chain(high.to_array()).all(is_coordinate)
            && is_below(low.extend(0.0), high.extend(1.0));
        let rectangle = Outline::rectangle(low, high);
        assert_eq!(rectangle.is_ok(), is_accepted, "{low} {high}: {rectangle:?}");
    });
}

#[test]
fn extrusions_of_random_bad_values() {
    let square = Outline::rectangle(DVec2::ZERO, DVec2::ONE).expect("a square");
    sweep(2000, |rng| {
        let mut length = || rng.pick(&LENGTHS);
        let (height, twist, scale) = (length(), length(), DVec2::new(length(), length()));
        let slices = rng.chance(0.5).then(|| rng.pick(&[0, 1, 2, 5, MAX_SEGMENTS + 1]));
        let extrusion = Extrusion { height, twist, scale, slices, center: rng.chance(0.5), ..Extrusion::straight(1.0) };
        let factor = |v: f64| v == 0.0 || is_length(v);
        let counts = slices.map_or(twist.abs() <= 50_000.0, |k| (1..=MAX_SEGMENTS).contains(&k));
        let is_accepted = is_length(height) && twist.abs() <= 3.6e6 && factor(scale.x) && factor(scale.y) && counts;
        match extrude(&square, &extrusion, M) {
            Ok(_) => assert!(is_accepted, "{extrusion:?}"),
            Err(ShapeError::CrossingSides { .. }) => {
                assert!(is_accepted && (extrusion.scale != DVec2::ONE || twist != 0.0));
            }
            // extreme sizes can leave no plane in range
            Err(ShapeError::OutOfRange(_)) => {
                assert!(is_accepted && scale.max_element().max(height).max(height.recip()) > 1e20, "{extrusion:?}");
            }
            // or collapse a side
            Err(ShapeError::Parameter { parameter: "polygon", .. }) => {
                assert!(is_accepted && scale.max_element().max(height) > 1e20 * scale.min_element(), "{extrusion:?}");
            }
            Err(error) => {
                assert!(!is_accepted, "{extrusion:?}: {error}");
                assert!(["height", "twist", "scale", "slices"].contains(&error.parameter().expect("a parameter")));
            }
        }
    });
}

#[test]
fn outlines_of_random_bad_values() {
    sweep(1000, |rng| {
        let point = |rng: &mut Rng| DVec2::new(rng.pick(&LENGTHS), rng.pick(&LENGTHS));
        let corners: Vec<DVec2> = (0..rng.below(6)).map(|_| point(rng)).collect();
        let is_accepted = corners.len() >= 3 && corners.iter().all(|p| p.to_array().into_iter().all(is_coordinate));
        let found = Outline::from_loops(std::slice::from_ref(&corners));
        assert_eq!(found.is_ok(), is_accepted, "{corners:?}: {found:?}");
        if let Ok(outline) = found {
            let (by, n) = (rng.pick(&LENGTHS), rng.pick(&COUNTS));
            let grown = outline.offset(by, rng.pick(&[Join::Round, Join::Miter, Join::Bevel]), n);
            assert_eq!(grown.is_ok(), is_coordinate(by) && is_count(n), "{by} {n}: {grown:?}");
            let angle = rng.pick(&LENGTHS);
            let turned = revolve(&outline, angle, n, M);
            let right = outline.loops().flatten().all(|p| p.x >= 0.0);
            let expected = angle > 0.0 && angle <= 360.0 && right && is_count(n);
            let out_of_range = matches!(turned, Err(ShapeError::OutOfRange(_)));
            assert!(turned.is_ok() == expected || out_of_range, "{corners:?} by {angle} in {n}: {turned:?}");
        }
        let radius = rng.pick(&LENGTHS);
        let n = rng.pick(&COUNTS);
        assert_eq!(Outline::circle(radius, n).is_ok(), is_length(radius) && is_count(n));
    });
}

#[test]
fn messages_say_what_was_found_and_expected() {
    let message = |error: ShapeError| error.to_string();
    let found = message(sphere(-2.0, 8, M).expect_err("a negative radius"));
    assert_eq!(found, "radius: found -2, expected a number above 0");
    let found = message(torus(1.0, 1.0, 8, 8, M).expect_err("no hole"));
    assert_eq!(found, "tube: found 1, expected a number below the radius 1");
    let left = Outline::rectangle(DVec2::new(-1.0, 0.0), DVec2::ONE).expect("a rectangle");
    let found = message(revolve(&left, 360.0, 8, M).expect_err("left of the axis"));
    assert_eq!(found, "outline: found a corner at x = -1, expected no x below 0");
    let half_spaces = [(DVec3::X, 1.0), (DVec3::ZERO, 1.0)];
    let found = message(body_of_half_spaces(&half_spaces, M).expect_err("no normal"));
    assert!(found.starts_with("half-space 1: "), "{found}");
    let flat = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    assert!(matches!(hull_of_points(&flat, M), Err(ShapeError::Hull(_))));
    assert!(matches!(
        Outline::combine(planecut_csg::Operation::Complement, &[left]),
        Err(ShapeError::Parameter { .. })
    ));
}
