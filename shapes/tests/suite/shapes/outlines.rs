//! Outlines: set operations by lattice counts and areas, offsets by formulas and distances.

use std::collections::HashSet;

use glam::{DMat2, DVec2};
use planecut_csg::Operation;
use planecut_shapes::Outline;
use planecut_shapes::outline::{Join, MITER_LIMIT};

use super::judge::{assert_near, sweep};
use super::polygon;
use planecut_testkit::random::Rng;

const OPERATIONS: [Operation; 4] = [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor];

fn outline(loops: &[Vec<DVec2>]) -> Outline {
    Outline::from_loops(loops).expect("an outline")
}

fn loops(outline: &Outline) -> Vec<Vec<DVec2>> {
    outline.loops().cloned().collect()
}

fn combine(operation: Operation, operands: &[Outline]) -> Outline {
    Outline::combine(operation, operands).expect("an outline")
}

/// The corners of all loops, as bits.
fn corners(outline: &Outline) -> HashSet<[u64; 2]> {
    outline.loops().flatten().map(|p| p.to_array().map(f64::to_bits)).collect()
}

/// A loop that begins at its least corner.
fn rotated(corners: &[DVec2]) -> Vec<DVec2> {
    let least = (0..corners.len())
        .min_by(|a, b| corners[*a].x.total_cmp(&corners[*b].x).then(corners[*a].y.total_cmp(&corners[*b].y)));
    let mut corners = corners.to_vec();
    corners.rotate_left(least.unwrap_or_default());
    corners
}

#[test]
fn plain_polygons_come_through_bit_by_bit() {
    sweep(300, |rng| {
        // also small ones far from the origin, where the library's grid is coarsest
        let size = 10f64.powi(rng.integer(-6, 6) as i32);
        let center = DVec2::new(rng.float(-100.0, 100.0), rng.float(-100.0, 100.0)) * rng.whole(0, 1);
        let given: Vec<Vec<DVec2>> = polygon::random_region(rng, 30, center)
            .into_iter()
            .map(|corners| corners.into_iter().map(|p| p * size).collect())
            .collect();
        // either way round
        let turned = given.iter().map(|c| if rng.chance(0.5) { c.iter().rev().copied().collect() } else { c.clone() });
        let found = outline(&turned.collect::<Vec<_>>());
        assert_eq!(found.shapes().len(), 1);
        let mut expected: Vec<Vec<DVec2>> = given.iter().map(|c| rotated(c)).collect();
        let mut found: Vec<Vec<DVec2>> = loops(&found).iter().map(|c| rotated(c)).collect();
        expected.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        found.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        assert_eq!(found, expected);
    });
}

#[test]
fn rectangles_with_decimals_stay_what_they_were() {
    let [a, b, c, d] = [[0.1, 0.2], [0.7, 0.9], [0.3, 0.1], [0.4, 1.3]].map(DVec2::from);
    let (tall, wide) = (Outline::rectangle(a, b).expect("one"), Outline::rectangle(c, d).expect("another"));
    for operation in OPERATIONS {
        for corner in combine(operation, &[tall.clone(), wide.clone()]).loops().flatten() {
            // each coordinate is one that was given
            assert!([a.x, b.x, c.x, d.x].contains(&corner.x) && [a.y, b.y, c.y, d.y].contains(&corner.y), "{corner}");
        }
    }
    let tenths: Vec<Outline> = (0..10)
        .map(|k| {
            let low = f64::from(k) / 10.0;
            Outline::rectangle(DVec2::new(low, 0.0), DVec2::new(f64::from(k + 1) / 10.0, 0.3)).expect("a strip")
        })
        .collect();
    let whole = combine(Operation::Union, &tenths);
    assert_eq!(corners(&whole), corners(&Outline::rectangle(DVec2::ZERO, DVec2::new(1.0, 0.3)).expect("a rectangle")));
}

#[test]
fn rectangles_on_a_lattice_against_cells() {
    sweep(200, |rng| {
        let operation = rng.pick(&OPERATIONS);
        let count = 1 + rng.below(5);
        let rectangle = |rng: &mut Rng| {
            let low = [0; 2].map(|_| rng.integer(0, 6) as i32);
            let high = low.map(|v| v + rng.integer(1, 4) as i32);
            (low, high)
        };
        let given: Vec<([i32; 2], [i32; 2])> = (0..count).map(|_| rectangle(rng)).collect();
        let point = |[x, y]: [i32; 2]| DVec2::new(f64::from(x), f64::from(y));
        let outlines: Vec<Outline> =
            given.iter().map(|(low, high)| Outline::rectangle(point(*low), point(*high)).expect("one")).collect();
        let found = combine(operation, &outlines);
        let holds = |x: i32, y: i32| {
            let inside = given.iter().map(|(low, high)| low[0] <= x && x < high[0] && low[1] <= y && y < high[1]);
            let values: Vec<bool> = inside.collect();
            match operation {
                Operation::Union => values.contains(&true),
                Operation::Intersection => !values.contains(&false),
                Operation::Difference => values[0] && !values[1..].contains(&true),
                _ => values.iter().filter(|v| **v).count() % 2 == 1,
            }
        };
        let loops = loops(&found);
        let mut cells = 0;
        for (x, y) in (0..12).flat_map(|x| (0..12).map(move |y| (x, y))) {
            cells += i32::from(holds(x, y));
            let middle = point([x, y]) + DVec2::splat(0.5);
            assert_eq!(polygon::contains(&loops, middle), holds(x, y), "{operation:?} of {given:?} at {middle}");
        }
        assert_eq!(found.area(), f64::from(cells), "{operation:?} of {given:?}");
        assert!(
            found.shapes().iter().all(|shape| polygon::area(&shape[..1]) > 0.0),
            "outer loops run counter-clockwise"
        );
        assert!(
            found
                .shapes()
                .iter()
                .flat_map(|shape| &shape[1..])
                .all(|hole| polygon::area(std::slice::from_ref(hole)) < 0.0)
        );
    });
}

#[test]
fn areas_add_up() {
    sweep(150, |rng| {
        let center = |rng: &mut Rng| DVec2::new(rng.float(-1.0, 1.0), rng.float(-1.0, 1.0));
        let (at, other) = (center(rng), center(rng));
        let (a, b) = (outline(&polygon::random_region(rng, 20, at)), outline(&polygon::random_region(rng, 20, other)));
        let area = |operation| combine(operation, &[a.clone(), b.clone()]).area();
        let [union, meet, rest, xor] = OPERATIONS.map(area);
        assert_near(union + meet, a.area() + b.area(), 1e-13, "union and intersection");
        assert_near(rest + meet, a.area(), 1e-13, "difference and intersection");
        assert_near(xor + meet, union, 1e-13, "symmetric difference");
        for operation in [Operation::Union, Operation::Intersection] {
            assert_eq!(corners(&combine(operation, &[a.clone(), a.clone()])), corners(&a), "{operation:?} with itself");
        }
        assert!(combine(Operation::Difference, &[a.clone(), a.clone()]).is_empty());
        assert!(combine(Operation::Xor, &[b.clone(), b.clone()]).is_empty());
    });
}

#[test]
fn loops_that_cross_are_even_odd() {
    // a pentagram without its middle
    let pentagram: Vec<DVec2> =
        (0..5).map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(2 * k) / 5.0)).collect();
    let inner = (std::f64::consts::TAU / 5.0).cos() / (std::f64::consts::TAU / 10.0).cos();
    let star: Vec<DVec2> = (0..10)
        .map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 10.0) * if k % 2 == 0 { 1.0 } else { inner })
        .collect();
    let found = outline(&[pentagram]);
    assert_near(found.area(), polygon::area(&[star]) - polygon::regular_area(5, inner), 1e-14, "area");
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(DVec2::from).to_vec();
    let found = outline(&[bow]);
    assert_eq!((found.area(), found.shapes().len()), (2.0, 2));
    let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]].map(DVec2::from).to_vec();
    let nested = outline(&[square(0.0, 9.0), square(1.0, 8.0), square(2.0, 7.0)]);
    assert_eq!((nested.area(), nested.shapes().len()), (81.0 - 49.0 + 25.0, 2));
    assert!(outline(&[square(0.0, 1.0), square(0.0, 1.0)]).is_empty(), "twice the same loop is nothing");
    let flat = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]].map(DVec2::from).to_vec();
    assert!(outline(&[flat]).is_empty(), "nor is a loop without inside anything");
}

#[test]
fn affine_maps() {
    let l =
        outline(&[[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(DVec2::from).to_vec()]);
    let mirrored = l.transformed(DMat2::from_diagonal(DVec2::new(-2.0, 1.0)), DVec2::new(1.0, 5.0)).expect("a map");
    assert_eq!((l.area(), mirrored.area()), (4.0, 8.0));
    assert!(polygon::area(&loops(&mirrored)) > 0.0, "still counter-clockwise");
    assert!(mirrored.loops().flatten().any(|p| *p == DVec2::new(1.0 - 2.0 * 3.0, 5.0)));
    for flat in [DMat2::from_diagonal(DVec2::new(1.0, 0.0)), DMat2::from_diagonal(DVec2::new(f64::NAN, 1.0))] {
        assert_eq!(l.transformed(flat, DVec2::ZERO).expect_err("flat").parameter(), Some("matrix"));
    }
}

#[test]
fn offsets_of_convex_polygons_by_formulas() {
    sweep(100, |rng| {
        let n = 3 + rng.below(8) as u32;
        let radius = rng.float(0.5, 5.0);
        let turn = DMat2::from_angle(rng.float(0.0, 6.0));
        let shape =
            Outline::circle(radius, n).and_then(|c| c.transformed(turn, DVec2::new(3.0, -2.0))).expect("a polygon");
        let by = rng.float(0.01, 2.0);
        let segments = 3 + rng.below(40) as u32;
        let bend = std::f64::consts::TAU / f64::from(n);
        let side = 2.0 * radius * (0.5 * bend).sin();
        let strips = shape.area() + f64::from(n) * side * by;
        let corner = |pieces: f64| 0.5 * pieces * by * by * (bend / pieces).sin();
        let pieces = (f64::from(segments) / f64::from(n) - 1e-9).ceil().max(1.0);
        let mitered = by * by * (0.5 * bend).tan();
        let is_within = 1.0 / (0.5 * bend).cos() <= MITER_LIMIT;
        let expected = [
            (Join::Round, strips + f64::from(n) * corner(pieces)),
            (Join::Bevel, strips + f64::from(n) * corner(1.0)),
            (Join::Miter, strips + f64::from(n) * if is_within { mitered } else { corner(1.0) }),
        ];
        for (join, area) in expected {
            let grown = shape.offset(by, join, segments).expect("an offset");
            assert_near(grown.area(), area, 1e-12, &format!("{join:?}"));
            assert_eq!(grown.shapes().len(), 1);
        }
        let miter = shape.offset(by, Join::Miter, segments).expect("an offset");
        assert_eq!(
            miter.loops().map(Vec::len).sum::<usize>(),
            n as usize,
            "mitered corners are corners, sides stay sides"
        );
        // shrinking by less than the inner radius keeps the shape; by more leaves nothing
        let inner = radius * (0.5 * bend).cos();
        let shrunk = shape.offset(-0.5 * inner, Join::Round, segments).expect("an offset");
        assert_near(shrunk.area(), 0.25 * shape.area(), 1e-12, "half as large");
        assert!(shape.offset(-1.01 * inner, Join::Round, segments).expect("an offset").is_empty());
    });
}

#[test]
fn offsets_of_any_region_by_distance() {
    sweep(60, |rng| {
        let given = polygon::random_region(rng, 16, DVec2::ZERO);
        let shape = outline(&given);
        let (by, segments) = (rng.float(0.01, 0.5), 8 + rng.below(40) as u32);
        // chords of round corners lie nearer by this factor
        let chord = (std::f64::consts::PI / f64::from(segments)).cos();
        let grown = loops(&shape.offset(by, Join::Round, segments).expect("an offset"));
        let shrunk = loops(&shape.offset(-by, Join::Round, segments).expect("an offset"));
        for _ in 0..300 {
            let point = DVec2::new(rng.float(-3.0, 3.0), rng.float(-3.0, 3.0));
            let (is_inside, away) = (polygon::contains(&given, point), polygon::distance(&given, point));
            let outside = if is_inside { -away } else { away };
            if outside < by * chord - 1e-9 || outside > by + 1e-9 {
                assert_eq!(polygon::contains(&grown, point), outside < by, "{point} grown by {by}");
            }
            if -outside < by * chord - 1e-9 || -outside > by + 1e-9 {
                assert_eq!(polygon::contains(&shrunk, point), -outside > by, "{point} shrunk by {by}");
            }
        }
    });
}

#[test]
fn offsets_of_rectangles_are_exact() {
    let (min, max) = (DVec2::new(0.1, 0.2), DVec2::new(0.7, 0.5));
    let shape = Outline::rectangle(min, max).expect("a rectangle");
    let by = 0.05;
    let grown = shape.offset(by, Join::Miter, 32).expect("an offset");
    let expected = Outline::rectangle(min - DVec2::splat(by), max + DVec2::splat(by)).expect("a rectangle");
    assert_eq!(corners(&grown), corners(&expected));
    let shrunk = shape.offset(-by, Join::Round, 32).expect("an offset");
    for corner in shrunk.loops().flatten() {
        let near = |v: f64, all: [f64; 2]| all.into_iter().any(|w| (v - w).abs() <= 1e-15);
        assert!(near(corner.x, [min.x + by, max.x - by]) && near(corner.y, [min.y + by, max.y - by]), "{corner}");
    }
    assert_eq!(shape.offset(0.0, Join::Round, 32).expect("the same"), shape);
}

/// Once without end: needles that all but cover each other, as upright faces are in a shadow.
#[test]
fn needles_that_cover_each_other() {
    sweep(5, |rng| {
        let mut fans: Vec<Vec<DVec2>> = Vec::new();
        for _ in 0..150 {
            let (from, to) = (DVec2::from_angle(rng.float(0.0, 0.5)) * rng.float(1.0, 2.0), DVec2::new(-1.0, 0.3));
            // points that lie on one line but for rounding
            let on_line = |part: f64| from + (to - from) * part;
            let parts = [0.0, rng.float(0.0, 1.0), rng.float(0.0, 1.0), 1.0].map(on_line);
            fans.extend([[parts[0], parts[1], parts[2]], [parts[1], parts[3], parts[2]]].map(Vec::from));
        }
        fans.push([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(DVec2::from).to_vec());
        let union = Outline::from_wound_loops(&fans).expect("an outline");
        assert!((union.area() - 1.0).abs() < 1e-12, "{}", union.area());
    });
}
