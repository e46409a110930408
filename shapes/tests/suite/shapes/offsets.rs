//! Offsets as Clipper makes them, by counts, formulas and distances; hulls and Minkowski sums of outlines by their definitions.

use glam::{DMat2, DVec2};
use planecut_shapes::Outline;
use planecut_shapes::outline::{ClipperJoin, OffsetRule};

use super::judge::{assert_near, sweep};
use super::polygon;
use planecut_testkit::random::Rng;

fn outline(loops: &[Vec<DVec2>]) -> Outline {
    Outline::from_loops(loops).expect("an outline")
}

fn loops(outline: &Outline) -> Vec<Vec<DVec2>> {
    outline.loops().cloned().collect()
}

fn corners(outline: &Outline) -> usize {
    outline.loops().map(Vec::len).sum()
}

fn offset(outline: &Outline, by: f64, join: ClipperJoin) -> Outline {
    outline.offset_with(&OffsetRule { by, join }).expect("an offset")
}

fn round(segments: u32) -> ClipperJoin {
    ClipperJoin::Round { segments }
}

fn square(low: f64, high: f64) -> Outline {
    Outline::rectangle(DVec2::splat(low), DVec2::splat(high)).expect("a square")
}

fn turned_polygon(rng: &mut Rng, n: u32, radius: f64) -> Outline {
    let turn = DMat2::from_angle(rng.float(0.0, 6.0));
    Outline::circle(radius, n).and_then(|c| c.transformed(turn, DVec2::new(3.0, -2.0))).expect("a polygon")
}

#[test]
fn a_quarter_turn_has_as_many_steps_as_it_rounds_to() {
    // 90° in steps of 360°/n: n/4 of them when rounded, and the end; 3 and 4 segments are taken for 4.35
    for (segments, points) in [(28, 8), (11, 4), (13, 4), (16, 5), (5, 2), (4, 2), (3, 2), (64, 17)] {
        let grown = offset(&square(0.0, 10.0), 1.0, round(segments));
        assert_eq!(corners(&grown), 4 * points, "{segments} segments");
    }
    // the arc begins where the side before ends, so what is left over comes last
    let grown = offset(&square(0.0, 10.0), 1.0, round(11));
    let step = (360.0 / 11.0_f64).to_radians();
    for k in 0..3 {
        let expected = DVec2::splat(10.0) + DVec2::from_angle(step * f64::from(k));
        assert!(grown.loops().flatten().any(|p| p.distance(expected) < 1e-14), "{expected}");
    }
    // shrinking a hole begins there too
    let frame = outline(&[loops(&square(0.0, 30.0)).remove(0), loops(&square(10.0, 20.0)).remove(0)]);
    let shrunk = offset(&frame, -1.0, round(11));
    assert_eq!(corners(&shrunk), 4 + 4 * 4);
    for k in 0..3 {
        // a hole runs clockwise: the side before the corner (20, 20) comes up along its left, the one after leaves to the right
        let expected = DVec2::splat(20.0) + DVec2::from_angle(std::f64::consts::FRAC_PI_2 - step * f64::from(k));
        assert!(shrunk.loops().flatten().any(|p| p.distance(expected) < 1e-14), "{expected}");
    }
}

#[test]
fn clipper_offsets_of_convex_polygons_by_formulas() {
    sweep(100, |rng| {
        let n = 3 + rng.below(8) as u32;
        let (radius, by) = (rng.float(0.5, 5.0), rng.float(0.01, 2.0));
        let shape = turned_polygon(rng, n, radius);
        let segments = 11 + rng.below(60) as u32;
        let (bend, step) = (std::f64::consts::TAU / f64::from(n), std::f64::consts::TAU / f64::from(segments));
        let strips = shape.area() + f64::from(n) * 2.0 * radius * (0.5 * bend).sin() * by;
        let count = f64::from(n);
        let whole = (bend / step).round().max(1.0) - 1.0;
        let fan = 0.5 * by * by * (whole * step.sin() + (bend - whole * step).sin());
        let miter = by * by * (0.5 * bend).tan();
        // the cut takes a triangle off the miter, by (1 / cos − 1) high and as wide as the miter is blunt
        let above = by * (1.0 / (0.5 * bend).cos() - 1.0);
        let cut = above * above / (0.5 * bend).tan();
        let expected = [(round(segments), fan), (ClipperJoin::Miter, miter), (ClipperJoin::Square, miter - cut)];
        for (join, corner) in expected {
            assert_near(offset(&shape, by, join).area(), strips + count * corner, 1e-12, &format!("{join:?}"));
        }
        let inner = radius * (0.5 * bend).cos();
        for join in [round(segments), ClipperJoin::Miter, ClipperJoin::Square] {
            assert_near(offset(&shape, -0.5 * inner, join).area(), 0.25 * shape.area(), 1e-12, "half as large");
            assert!(offset(&shape, -1.01 * inner, join).is_empty());
        }
    });
}

#[test]
fn clipper_offsets_of_any_region_by_distance() {
    sweep(60, |rng| {
        let given = polygon::random_region(rng, 16, DVec2::ZERO);
        let shape = outline(&given);
        let (by, segments) = (rng.float(0.01, 0.5), 8 + rng.below(40) as u32);
        // the last chord of an arc has up to one and a half steps
        let chord = (1.5 * std::f64::consts::PI / f64::from(segments)).cos();
        let grown = loops(&offset(&shape, by, round(segments)));
        let shrunk = loops(&offset(&shape, -by, round(segments)));
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
fn needles_get_long_miters() {
    // a triangle whose tip has 1°: the miter is 1 / sin 0.5° = 114.6 times the distance away
    let half = 0.5_f64.to_radians();
    let needle = outline(&[vec![DVec2::ZERO, DVec2::from_angle(-half) * 9.0, DVec2::from_angle(half) * 9.0]]);
    let grown = offset(&needle, 0.5, ClipperJoin::Miter);
    let tip = grown.loops().flatten().map(|p| p.x).fold(f64::INFINITY, f64::min);
    assert_near(tip, -0.5 / half.sin(), 1e-12, "the tip");
    let cut = offset(&needle, 0.5, ClipperJoin::Square);
    let end = cut.loops().flatten().map(|p| p.x).fold(f64::INFINITY, f64::min);
    assert_near(end, -0.5, 1e-12, "as far away as the sides");
}

#[test]
fn nothing_is_left_of_a_strip_shrunk_by_half_its_width() {
    for width in [0.1, 0.2, 0.3, 1.0, 7.7] {
        let strip = Outline::rectangle(DVec2::new(0.1, 0.3), DVec2::new(9.7, 0.3 + width)).expect("a strip");
        for join in [round(16), ClipperJoin::Miter, ClipperJoin::Square] {
            assert!(offset(&strip, -0.5 * width, join).is_empty(), "{width} {join:?}");
        }
    }
}

#[test]
fn hulls_hold_all_and_turn_left() {
    sweep(100, |rng| {
        let given: Vec<Outline> = (0..1 + rng.below(3))
            .map(|_| {
                let center = DVec2::new(rng.float(-3.0, 3.0), rng.float(-3.0, 3.0));
                outline(&polygon::random_region(rng, 12, center))
            })
            .collect();
        let hull = loops(&Outline::hull(&given));
        assert_eq!(hull.len(), 1);
        let points: Vec<DVec2> = given.iter().flat_map(Outline::loops).flatten().copied().collect();
        for (p, q) in polygon::edges(&hull[0]) {
            assert!(points.contains(&p));
            assert!(
                points.iter().all(|r| (q - p).perp_dot(*r - p) >= -1e-12),
                "all points are to the left of each side"
            );
        }
        assert!(polygon::area(&hull) > 0.0);
    });
    let grid =
        outline(&[[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]].map(DVec2::from).to_vec()]);
    assert_eq!(corners(&Outline::hull(&[grid])), 4, "no corners on straight lines");
    assert!(Outline::hull(&[]).is_empty());
}

#[test]
fn sums_of_convex_outlines_have_all_sides() {
    sweep(100, |rng| {
        let (n, m) = (3 + rng.below(9) as u32, 3 + rng.below(9) as u32);
        let (a, b) = (turned_polygon(rng, n, 1.5), turned_polygon(rng, m, 0.7));
        let sum = a.minkowski(&b).expect("a sum");
        let hull: Vec<DVec2> = a.loops().flatten().flat_map(|p| b.loops().flatten().map(move |q| *p + *q)).collect();
        // the hull of all sums of corners
        let expected = polygon::area(&[hull_order(&hull)]);
        assert_near(sum.area(), expected, 1e-12, "area");
        assert_eq!(corners(&sum), (n + m) as usize);
    });
    // sides of the same direction become one
    let eight = Outline::circle(1.0, 8).expect("a circle");
    let sum = eight.minkowski(&Outline::circle(0.3, 8).expect("a circle")).expect("a sum");
    assert_eq!(corners(&sum), 8);
    assert_near(sum.area(), polygon::regular_area(8, 1.3), 1e-12, "area");
    assert!(eight.minkowski(&Outline::empty()).expect("nothing").is_empty());
}

/// The convex hull of points by gift wrapping.
fn hull_order(points: &[DVec2]) -> Vec<DVec2> {
    let start = *points.iter().min_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))).expect("points");
    let mut hull = vec![start];
    loop {
        let at = hull[hull.len() - 1];
        let further = |best: DVec2, p: &DVec2| {
            let turn = (best - at).perp_dot(*p - at);
            let is_better = best == at || turn < 0.0 || turn == 0.0 && p.distance(at) > best.distance(at);
            if is_better { *p } else { best }
        };
        let next = points.iter().fold(at, further);
        if next == start {
            return hull;
        }
        hull.push(next);
    }
}

/// Whether a point is a sum: whether one outline meets the other's mirror image about half the point.
fn is_sum(a: &[Vec<DVec2>], b: &[Vec<DVec2>], point: DVec2) -> bool {
    let mirrored: Vec<Vec<DVec2>> = b.iter().map(|c| c.iter().map(|p| point - *p).collect()).collect();
    let crosses = |(p, q): (DVec2, DVec2), (r, s): (DVec2, DVec2)| {
        let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) > 0.0;
        side(p, q, r) != side(p, q, s) && side(r, s, p) != side(r, s, q)
    };
    let all =
        |loops: &[Vec<DVec2>]| loops.iter().flat_map(|c| polygon::edges(c).collect::<Vec<_>>()).collect::<Vec<_>>();
    let others = all(&mirrored);
    all(a).into_iter().any(|own| others.iter().any(|other| crosses(own, *other)))
        || a.iter().any(|c| polygon::contains(&mirrored, c[0]))
        || mirrored.iter().any(|c| polygon::contains(a, c[0]))
}

#[test]
fn points_of_sums() {
    sweep(40, |rng| {
        let a = vec![polygon::random_star(rng, 12, DVec2::new(1.0, 0.5), 0.4, 2.0)];
        // a frame whose hole the other operand may or may not fill
        let size = rng.float(1.0, 4.0);
        let b = vec![
            loops(&square(-size, size)).remove(0),
            loops(&square(-size * 0.8, size * 0.7)).remove(0).into_iter().rev().collect::<Vec<_>>(),
        ];
        let sum = loops(&outline(&a).minkowski(&outline(&b)).expect("a sum"));
        for _ in 0..300 {
            let point = DVec2::new(rng.float(-7.0, 7.0), rng.float(-7.0, 7.0));
            if polygon::distance(&sum, point) > 1e-9 {
                assert_eq!(polygon::contains(&sum, point), is_sum(&a, &b, point), "{point}");
            }
        }
    });
}
