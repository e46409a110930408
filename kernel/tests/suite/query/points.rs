//! Support points, membership, clipping, distances, bounds and face polygons against brute force.

use std::array::from_fn;

use dashu_ratio::RBig;
use planecut_kernel::{ClosestFeature, DVec3, InteriorPoint, Location, PlaneIdx, Support, VertexIdx};
use planecut_oracle::random::Rng;

use super::cases::{self, Case};
use super::truth::{
    Plane, Vector, closest, contains, dot, faces, is_close, minus, planes, square_root, support, vector, vertices,
};

const CASES: u64 = 600;

/// Points near the set, on it, exactly on its planes where that is possible, and far away.
fn some_points(case: &Case, rng: &mut Rng) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = Vec::new();
    let polytope = case.polytope();
    points.extend(polytope.to_mesh().0.into_iter().take(3));
    for _ in 0..4 {
        let size = [0.5, 3.0, 1e9][rng.below(3)];
        let lattice = rng.lattice(3);
        let point = if rng.chance(0.5) { lattice } else { rng.direction().map(|v| v * size) };
        points.push(DVec3::from_array(point));
    }
    let middle = points.iter().take(2).fold(DVec3::ZERO, |sum, p| sum + 0.5 * *p);
    points.push(middle);
    points
}

fn is_rounded(got: DVec3, exact: &Vector) -> bool {
    (0..3).all(|k| is_close(got[k], &exact[k], 1))
}

#[test]
fn membership() {
    let mut found = [0usize; 3];
    for mut case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        let mut rng = case.rng.clone();
        for point in some_points(&case, &mut rng) {
            let at = vector(point.to_array());
            let location = if polytope.is_empty() || !contains(&exact, &at) {
                Location::Outside
            } else if exact.iter().any(|plane| dot(&plane.n, &at) == plane.d) {
                Location::On
            } else {
                Location::Inside
            };
            // a plane that touches the set in an edge or corner has no face, but others there do
            assert_eq!(polytope.classify(point), location, "{}", case.report(&format!("{point:?}")));
            assert_eq!(polytope.contains(point), location != Location::Outside);
            found[location as usize] += 1;
        }
        case.rng = rng;
    }
    assert!(found.iter().all(|n| *n > 100), "inside, on, outside: {found:?}");
}

#[test]
fn support_points_and_bounds() {
    let mut found = [0usize; 3];
    for mut case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        let axes = (0..6).map(|k| if k % 2 == 0 { DVec3::AXES[k / 2] } else { -DVec3::AXES[k / 2] });
        let mut directions: Vec<DVec3> = axes.collect();
        directions.extend((0..4).map(|_| DVec3::from_array(case.rng.direction())));
        directions.push(DVec3::from_array(case.rng.lattice(3)));
        directions.extend(case.planes.first().map(|&[x, y, z, _]| DVec3::new(x, y, z)));
        let bounds = polytope.bounding_box();
        assert_eq!(bounds.is_none(), polytope.is_empty());
        for (k, direction) in directions.into_iter().enumerate() {
            let along = vector(direction.to_array());
            let report = || case.report(&format!("direction {direction:?}"));
            let got = polytope.support(direction).expect("an accepted direction");
            if polytope.is_empty() {
                assert_eq!(got, Support::Empty);
                continue;
            }
            let farthest = support(&exact, &along);
            let restarted = polytope.support_from(direction, VertexIdx(k as u32)).expect("an accepted direction");
            assert_eq!(std::mem::discriminant(&got), std::mem::discriminant(&restarted), "{}", report());
            match (got, &farthest) {
                (Support::Unbounded { direction: way }, None) => {
                    assert!(way.dot(direction) > 0.0, "{}", report());
                    assert!(case.planes.iter().all(|p| DVec3::new(p[0], p[1], p[2]).dot(way) < 1e-12), "{}", report());
                    found[0] += 1;
                }
                (Support::Vertex { position, .. }, Some(value)) => {
                    let corner =
                        vertices(&exact).into_iter().find(|v| is_rounded(position, v) && dot(v, &along) == *value);
                    assert!(corner.is_some(), "{}", report());
                    found[1] += 1;
                }
                (Support::Flat { point }, Some(value)) => {
                    assert!(vertices(&exact).is_empty(), "{}", report());
                    let off = (point.dot(direction) - value.to_f64().value()).abs();
                    assert!(off <= 1e-14 * (1.0 + point.length()) * direction.length(), "{}", report());
                    found[2] += 1;
                }
                other => panic!("{other:?} {}", report()),
            }
            if let (Some(bounds), true) = (bounds, k < 6) {
                let (bound, sign) = if k % 2 == 0 { (bounds.max, 1.0) } else { (bounds.min, -1.0) };
                match &farthest {
                    None => assert_eq!(sign * bound[k / 2], f64::INFINITY, "{}", report()),
                    Some(value) => assert!(is_close(sign * bound[k / 2], value, 1), "{}", report()),
                }
            }
        }
    }
    assert!(found.iter().all(|n| *n > 100), "unbounded, vertices, flats: {found:?}");
}

/// The smallest and largest parameter on `a + t·b`, of `from ≤ t ≤ to`; `None` where it misses.
fn clip(planes: &[Plane], a: &Vector, b: &Vector, to: Option<RBig>) -> Option<(RBig, Option<RBig>)> {
    let (mut low, mut high) = (RBig::ZERO, to);
    for plane in planes {
        let (room, slope) = (&plane.d - dot(&plane.n, a), dot(&plane.n, b));
        if slope == RBig::ZERO {
            if room < RBig::ZERO {
                return None;
            }
            continue;
        }
        let at = &room / &slope;
        if slope < RBig::ZERO {
            low = low.max(at);
        } else if high.as_ref().is_none_or(|high| at < *high) {
            high = Some(at);
        }
    }
    high.as_ref().is_none_or(|high| low <= *high).then_some((low, high))
}

#[test]
fn rays_and_segments() {
    let (mut hits, mut misses) = (0, 0);
    for mut case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        let mut rng = case.rng.clone();
        let points = some_points(&case, &mut rng);
        for pair in points.windows(2) {
            let (a, b) = (vector(pair[0].to_array()), vector(pair[1].to_array()));
            for is_segment in [false, true] {
                let report = || case.report(&format!("{pair:?}, segment: {is_segment}"));
                let along = if is_segment { minus(&b, &a) } else { b.clone() };
                let expected =
                    clip(&exact, &a, &along, is_segment.then_some(RBig::ONE)).filter(|_| !polytope.is_empty());
                let got = if is_segment {
                    polytope.clip_segment(pair[0], pair[1])
                } else {
                    polytope.clip_ray(pair[0], pair[1])
                };
                let (Some(got), Some((low, high))) = (got, &expected) else {
                    assert_eq!(got.is_some(), expected.is_some(), "{}", report());
                    misses += 1;
                    continue;
                };
                hits += 1;
                assert!(is_close(got.from, low, 1), "{}", report());
                assert!(
                    high.as_ref().map_or(got.to == f64::INFINITY, |high| is_close(got.to, high, 1)),
                    "{}",
                    report()
                );
                for (plane, at) in [(got.entry, Some(low)), (got.exit, high.as_ref())] {
                    let Some(PlaneIdx(plane)) = plane else { continue };
                    let at = at.expect("a plane ends it");
                    let point: Vector = from_fn(|k| &a[k] + &along[k] * at);
                    assert_eq!(dot(&exact[plane].n, &point), exact[plane].d, "{}", report());
                }
                assert_eq!(got.entry.is_some(), *low > RBig::ZERO, "{}", report());
            }
        }
        case.rng = rng;
    }
    assert!(hits > 500 && misses > 500, "{hits} hits, {misses} misses");
}

#[test]
fn closest_points() {
    let mut features = [0usize; 4];
    for mut case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        let mut rng = case.rng.clone();
        for point in some_points(&case, &mut rng) {
            let report = || case.report(&format!("{point:?}"));
            let Some(got) = polytope.closest_point(point) else {
                assert!(polytope.is_empty(), "{}", report());
                assert_eq!(polytope.distance(point), f64::INFINITY);
                continue;
            };
            let (nearest, squared) = closest(&exact, &vector(point.to_array()));
            assert!(is_rounded(got.point, &nearest), "{got:?} {}", report());
            assert!(is_close(got.distance, &square_root(&squared), 1), "{got:?} {}", report());
            assert_eq!(got.distance, polytope.distance(point));
            let holders = match got.feature {
                ClosestFeature::Inside => vec![],
                ClosestFeature::Face(plane) => vec![plane],
                ClosestFeature::Edge(planes) => planes.to_vec(),
                ClosestFeature::Vertex(planes) => planes.to_vec(),
            };
            assert_eq!(holders.is_empty(), squared == RBig::ZERO, "{}", report());
            assert!(holders.iter().all(|p| dot(&exact[p.0].n, &nearest) == exact[p.0].d), "{}", report());
            features[holders.len()] += 1;
        }
        case.rng = rng;
    }
    assert!(features.iter().all(|n| *n > 50), "by number of planes: {features:?}");
}

#[test]
fn face_polygons_of_bounded_sets() {
    for case in cases::bounded(300) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        if polytope.is_empty() {
            continue;
        }
        let expected = faces(&exact, &vertices(&exact));
        for plane in 0..case.planes.len() {
            let got = polytope.face_polygon(PlaneIdx(plane));
            let Some((_, ring)) = expected.iter().find(|(i, _)| *i == plane) else {
                assert!(got.is_none(), "{}", case.report(&format!("plane {plane} has no face")));
                continue;
            };
            let corners = got.map(|polygon| polygon.corners).unwrap_or_default();
            let turned = |by: usize| (0..ring.len()).all(|i| is_rounded(corners[i], &ring[(i + by) % ring.len()]));
            let same = corners.len() == ring.len() && (0..ring.len()).any(turned);
            assert!(same, "{}", case.report(&format!("face {plane}: {corners:?}")));
        }
    }
}

#[test]
fn face_polygons_of_unbounded_sets() {
    let (mut with_rays, mut with_lines) = (0, 0);
    for case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        if polytope.is_bounded() {
            continue;
        }
        let corners = vertices(&exact);
        let unit: Vec<DVec3> = case.planes.iter().map(|p| DVec3::new(p[0], p[1], p[2]).normalize()).collect();
        for plane in 0..case.planes.len() {
            let Some(face) = polytope.face_polygon(PlaneIdx(plane)) else { continue };
            let report = || case.report(&format!("{face:?}"));
            let on: Vec<&Vector> = corners.iter().filter(|v| dot(&exact[plane].n, v) == exact[plane].d).collect();
            assert_eq!(face.corners.len(), on.len(), "{}", report());
            assert!(face.corners.iter().all(|c| on.iter().any(|v| is_rounded(*c, v))), "{}", report());
            let stays = |way: DVec3| unit.iter().all(|n| n.dot(way) < 1e-14) && unit[plane].dot(way).abs() < 1e-14;
            if let Some([first, last]) = face.rays {
                with_rays += 1;
                assert!(stays(first) && stays(last) && face.lines.is_empty(), "{}", report());
                // counter-clockwise: the boundary comes in along the first ray and leaves along the last
                assert!((-first).cross(last).dot(unit[plane]) > -1e-14, "{}", report());
            }
            for line in &face.lines {
                with_lines += 1;
                assert!(stays(line.direction) && stays(-line.direction), "{}", report());
                let distances = case
                    .planes
                    .iter()
                    .zip(&unit)
                    .map(|(p, n)| n.dot(line.point) - p[3] / DVec3::new(p[0], p[1], p[2]).length());
                let touched = distances.clone().filter(|d| d.abs() < 1e-13).count();
                assert!(touched >= 2 && distances.into_iter().all(|d| d < 1e-13), "{}", report());
            }
        }
    }
    assert!(with_rays > 100 && with_lines > 100, "{with_rays} faces with rays, {with_lines} lines");
}

#[test]
fn interior_points() {
    let (mut found, mut thin) = (0, 0);
    for case in cases::any(CASES) {
        let (exact, polytope) = (planes(&case.planes), case.polytope());
        match polytope.interior_point() {
            InteriorPoint::Empty => assert!(polytope.is_empty(), "{}", case.report("empty")),
            InteriorPoint::Thin => thin += 1,
            InteriorPoint::Point(point) => {
                let at = vector(point.to_array());
                assert!(
                    exact.iter().all(|plane| dot(&plane.n, &at) < plane.d),
                    "{}",
                    case.report(&format!("{point:?}"))
                );
                found += 1;
            }
        }
    }
    assert!(found > 300 && thin < found / 10, "{found} points, {thin} thin sets");
}

#[test]
fn invalid_arguments_have_answers() {
    let polytope = cases::build(&[[1., 0., 0., 1.]]);
    for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::ZERO] {
        assert_eq!(polytope.support(bad), None);
    }
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        assert!(!polytope.contains(bad) && polytope.closest_point(bad).is_none() && polytope.distance(bad).is_nan());
        assert!(polytope.clip_ray(bad, DVec3::X).is_none() && polytope.clip_segment(DVec3::ZERO, bad).is_none());
    }
    assert_eq!(polytope.face_polygon(PlaneIdx(usize::MAX)), None);
}
