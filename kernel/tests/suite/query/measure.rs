//! Volume, area, centroid and inertia to the last place.

use std::array::from_fn;

use dashu_ratio::RBig;
use planecut_kernel::{DMat3, DVec3, PlaneIdx};
use planecut_oracle::random::Rng;

use super::cases::{self, Case, build};
use super::truth::{Vector, cross, dot, faces, is_close, minus, planes, rational, square_root, vertices};

/// How far off a figure near zero may be, in units of the body.
const NEAR_ZERO: i32 = -75;

struct Exact {
    volume: RBig,
    areas: Vec<(usize, RBig)>,
    centroid: Vector,
    inertia: [[RBig; 3]; 3],
    extents: Vector,
}

/// By tetrahedra from the first vertex; `None` where there is no interior.
fn exact(case: &Case) -> Option<Exact> {
    let planes = planes(&case.planes);
    let vertices = vertices(&planes);
    let apex = vertices.first()?;
    let faces = faces(&planes, &vertices);
    let (mut six, mut first) = (RBig::ZERO, from_fn::<_, 3, _>(|_| RBig::ZERO));
    let mut second: [[RBig; 3]; 3] = from_fn(|_| from_fn(|_| RBig::ZERO));
    let mut areas = Vec::new();
    for (plane, ring) in &faces {
        let mut doubled: Vector = from_fn(|_| RBig::ZERO);
        for k in 2..ring.len() {
            let [a, b, c] = [&ring[0], &ring[k - 1], &ring[k]].map(|v| minus(v, apex));
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            doubled = from_fn(|i| &doubled[i] + &normal[i]);
            let det = dot(&a, &cross(&b, &c));
            let sum: Vector = from_fn(|i| &a[i] + &b[i] + &c[i]);
            first = from_fn(|i| &first[i] + &det * &sum[i]);
            second = from_fn(|i| {
                from_fn(|j| {
                    let corners = &a[i] * &a[j] + &b[i] * &b[j] + &c[i] * &c[j];
                    &second[i][j] + &det * (&sum[i] * &sum[j] + corners)
                })
            });
            six += det;
        }
        areas.push((*plane, square_root(&dot(&doubled, &doubled)) / RBig::from(2)));
    }
    if six == RBig::ZERO {
        return None;
    }
    let volume = six / RBig::from(6);
    let from_apex: Vector = from_fn(|i| &first[i] / (RBig::from(24) * &volume));
    let central = |i: usize, j: usize| &second[i][j] / RBig::from(120) - &volume * &from_apex[i] * &from_apex[j];
    let trace = (0..3).fold(RBig::ZERO, |sum, i| sum + central(i, i));
    let inertia = from_fn(|i| from_fn(|j| if i == j { &trace - central(i, i) } else { -central(i, j) }));
    let extents = from_fn(|i| {
        let along = || vertices.iter().map(|v| v[i].clone());
        along().max().expect("a solid has vertices") - along().min().expect("a solid has vertices")
    });
    Some(Exact { volume, areas, centroid: from_fn(|i| &apex[i] + &from_apex[i]), inertia, extents })
}

fn check(case: &Case) {
    let polytope = case.polytope();
    assert!(polytope.is_bounded(), "{}", case.report("not bounded"));
    let Some(exact) = exact(case) else {
        assert!(polytope.is_empty(), "{}", case.report("the set has no interior"));
        return;
    };
    let got = polytope.measures().unwrap_or_else(|| panic!("{}", case.report("no measures")));
    let compare = |what: &str, got: f64, exact: &RBig| {
        let shown = exact.to_f64().value();
        assert!(is_close(got, exact, 1), "{}", case.report(&format!("{what}: got {got:e}, exactly {shown:e}")));
    };
    let compare_near_zero = |what: &str, got: f64, exact: &RBig, size: RBig| {
        let room = size * rational(2f64.powi(NEAR_ZERO));
        let off = rational(got) - exact;
        if off > room || -off > room {
            compare(what, got, exact);
        }
    };
    compare("volume", got.volume, &exact.volume);
    compare("area", got.area, &exact.areas.iter().fold(RBig::ZERO, |sum, (_, area)| sum + area));
    for axis in 0..3 {
        compare_near_zero("centroid", got.centroid[axis], &exact.centroid[axis], exact.extents[axis].clone());
        compare("moment of inertia", got.inertia.col(axis)[axis], &exact.inertia[axis][axis]);
        for other in (0..3).filter(|other| *other != axis) {
            let size = &exact.volume * &exact.extents[axis] * &exact.extents[other];
            compare_near_zero("product of inertia", got.inertia.col(axis)[other], &exact.inertia[axis][other], size);
        }
    }
    for (plane, area) in &exact.areas {
        let face = polytope.face_area(PlaneIdx(*plane)).unwrap_or(f64::NAN);
        compare("face area", face, area);
    }
}

#[test]
fn every_figure_is_exact_to_the_last_place() {
    let mut solid = 0;
    for case in cases::bounded(800) {
        check(&case);
        solid += usize::from(!case.polytope().is_empty());
    }
    assert!(solid > 400, "{solid} of the sets have an interior");
}

#[test]
fn analytic_solids() {
    // a right-angled corner tetrahedron with legs 1: V = 1/6, inertia about the centroid 1/80 and products 1/480
    let corner = build(&[[-1., 0., 0., 0.], [0., -1., 0., 0.], [0., 0., -1., 0.], [1., 1., 1., 1.]]);
    let got = corner.measures().expect("bounded");
    assert_eq!((got.volume, got.centroid), (1.0 / 6.0, DVec3::splat(0.25)));
    assert!(is_close(got.area, &(rational(1.5) + square_root(&rational(0.75))), 1));
    let (moment, product) = (1.0 / 80.0, 1.0 / 480.0);
    let expected =
        DMat3::from_cols_array(&[moment, product, product, product, moment, product, product, product, moment]);
    assert_eq!(got.inertia, expected);
}

/// The area, a number like any other, takes integers of more than 1,024 bits.
#[test]
fn a_needle_far_longer_than_thick() {
    let (thin, long) = (2f64.powi(-198), 2f64.powi(199));
    let (near_one, slope) = (1.0 - f64::EPSILON / 2.0, f64::EPSILON / 2.0 * (1.0 - f64::EPSILON / 2.0));
    let planes = vec![
        [3.0, -3.0, 0.0, thin],
        [-3.0, 3.0, 0.0, thin],
        [0.0, 3.0, -3.0, thin],
        [0.0, -3.0, 3.0, thin],
        [1.0, -near_one, -slope, long],
        [-1.0, near_one, slope, long],
    ];
    check(&Case { seed: 0, planes, rng: Rng::new(0) });
}

#[test]
fn unbounded_and_empty_sets() {
    assert_eq!(build(&[[1., 0., 0., 1.]]).measures(), None);
    let empty = build(&[[1., 0., 0., -1.], [-1., 0., 0., -1.]]).measures().expect("an empty set is bounded");
    assert_eq!((empty.volume, empty.area, empty.inertia), (0.0, 0.0, DMat3::ZERO));
}
