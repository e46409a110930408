//! What a removal would add, against volumes with and without the plane.

use dashu_ratio::RBig;
use planecut_kernel::PlaneIdx;

use super::cases;
use super::truth::{Plane, cross, dot, faces, minus, planes, rational, support, vector, vertices};

/// Largest error, relative to the cube of the largest coordinate.
const ERROR: f64 = 1.0 / (1u64 << 40) as f64;

/// The volume, by tetrahedra from the first vertex; `None` where the set is unbounded. It must have an interior.
fn volume(planes: &[Plane]) -> Option<RBig> {
    for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        support(planes, &vector(axis))?;
        support(planes, &vector(axis.map(|v: f64| -v)))?;
    }
    let vertices = vertices(planes);
    let mut six = RBig::ZERO;
    for (_, ring) in faces(planes, &vertices) {
        for k in 2..ring.len() {
            let [a, b, c] = [&ring[0], &ring[k - 1], &ring[k]].map(|v| minus(v, &vertices[0]));
            six += dot(&a, &cross(&b, &c));
        }
    }
    Some(six / RBig::from(6))
}

#[test]
fn gains_are_differences_of_volumes() {
    let (mut endless, mut hidden, mut finite) = (0, 0, 0);
    for case in cases::bounded(60).chain(cases::any(60)) {
        let mut polytope = case.polytope();
        // which of several nearby vertices is seen depends on their handles
        polytope.set_epsilon(0.0);
        if polytope.is_empty() {
            assert!((0..case.planes.len()).all(|plane| polytope.volume_beyond(PlaneIdx(plane)).is_none()));
            continue;
        }
        let before = (polytope.to_mesh(), polytope.is_bounded(), polytope.vertex_count());
        let with = volume(&planes(&case.planes));
        for number in 0..case.planes.len() {
            let mut others = case.planes.clone();
            others.remove(number);
            let without = planes(&others);
            let found = polytope.volume_beyond(PlaneIdx(number));
            let (Some(with), Some(wide)) = (&with, volume(&without)) else {
                // an unbounded set may gain nothing
                assert!(found.is_none_or(|gain| with.is_none() || gain == 0.0), "{}", case.report("no end"));
                endless += 1;
                continue;
            };
            let reach = vertices(&without).into_iter().flatten().map(|v| v.to_f64().value().abs()).fold(0.0, f64::max);
            let found = found.unwrap_or_else(|| panic!("{}", case.report("found no end")));
            let off = rational(found) - (wide - with);
            assert!(off.to_f64().value().abs() <= ERROR * reach.powi(3), "{}: {number}", case.report("wrong gain"));
            finite += 1;
            hidden += usize::from(polytope.is_redundant(PlaneIdx(number)));
        }
        assert_eq!(before.1, polytope.is_bounded());
        assert_eq!(before.2, polytope.vertex_count());
        let sorted = |mut corners: Vec<[f64; 3]>| {
            corners.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            corners
        };
        let corners = |mesh: &(Vec<planecut_kernel::DVec3>, Vec<Vec<usize>>)| {
            sorted(mesh.0.iter().map(planecut_kernel::DVec3::to_array).collect())
        };
        assert_eq!(corners(&before.0), corners(&polytope.to_mesh()), "{}", case.report("another set"));
        assert!(polytope.volume_beyond(PlaneIdx(case.planes.len())).is_none());
    }
    assert!(endless > 50 && hidden > 50 && finite > 200, "{endless} {hidden} {finite}");
}
