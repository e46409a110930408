//! The floating-point tier: a value may be off by its bound at most, a permanent is the sum of the magnitudes of the terms,
//! and what is called certain is.

use dashu_ratio::RBig;
use planecut_oracle::random::Rng;

use super::super::extended::{self, Found};
use super::super::filter::{
    self, Ascent, DET3_BOUND, DET4_BOUND, Homogeneous, OffsetColumn, Slope, certain_det3, side_left_open,
};
use super::super::{Corner, FaceCorners, Probe, Row, Sign, near_zero};
use super::{DRAWS, dense_rows, exact, magnitude, normal, row, rows, shifted, sign_of, sum, terms_of_det3};
use crate::arithmetic::DoubleDouble;

/// Below `2^-SURE` of the permanent a filter may leave the sign of dense rows open, above it may not.
const SURE: usize = 45;

/// The coordinates of a meeting point, then the side of `h`, each with its permanent.
struct Meeting {
    point: [[RBig; 2]; 4],
    side: [RBig; 2],
}

impl Meeting {
    fn of(planes: &[Row; 3], h: &Row, column: OffsetColumn) -> Self {
        let offsets = [0, 1, 2].map(|k| exact(column.of(&planes[k])));
        let normals = [0, 1, 2].map(|k| normal(&planes[k]));
        let axis = |k: usize| [0, 1, 2].map(|i| RBig::from(u8::from(i == k)));
        // coordinate k is the determinant with the unit vector of the axis in the place of each normal in turn
        let coordinate = |k: usize| -> Vec<RBig> {
            let unit = axis(k);
            let terms = (0..3).flat_map(|i| {
                let mut rows = [&normals[0], &normals[1], &normals[2]];
                rows[i] = &unit;
                terms_of_det3(rows).map(|term| term * &offsets[i])
            });
            terms.collect()
        };
        let determinant = terms_of_det3([&normals[0], &normals[1], &normals[2]]);
        let (n, d) = (normal(h), exact(column.of(h)));
        let side = (0..3)
            .flat_map(|k| coordinate(k).into_iter().map(|term| term * &n[k]).collect::<Vec<_>>())
            .chain(determinant.iter().map(|term| -(term * &d)));
        let side = sum(side);
        let [x, y, z] = [0, 1, 2].map(|k| sum(coordinate(k)));
        Self { point: [x, y, z, sum(determinant)], side }
    }
}

/// Whether a computed value is as near to the exact one as the bound on its permanent says.
fn is_within(value: f64, exact_value: &RBig, bound: f64, permanent: f64) -> bool {
    magnitude(&(exact(value) - exact_value)) <= exact(bound) * exact(permanent)
}

/// Whether a permanent is right up to its own roundings, of which there are fewer than 16.
fn is_permanent(permanent: f64, exact_permanent: &RBig) -> bool {
    magnitude(&(exact(permanent) - exact_permanent)) <= shifted(exact_permanent, 49)
}

/// Three planes and a fourth; some of them at infinity where the column asks.
fn with_infinity(rng: &mut Rng, column: OffsetColumn) -> ([Row; 3], Row) {
    let [mut a, mut b, mut c, mut h] = rows(rng);
    if column == OffsetColumn::Infinite {
        for row in [&mut a, &mut b, &mut c, &mut h] {
            if rng.chance(0.4) {
                *row = Row::infinity(rng.lattice(100).map(|v| v as i64));
            }
        }
    }
    ([a, b, c], h)
}

#[test]
fn a_determinant_of_normals_is_within_its_bound() {
    let mut rng = Rng::new(1);
    for _ in 0..DRAWS {
        let [a, b, c]: [Row; 3] = rows(&mut rng);
        let [value, size] = sum(terms_of_det3([&normal(&a), &normal(&b), &normal(&c)]));
        let (found, permanent) = filter::det3(&a, &b, &c);
        assert!(is_within(found, &value, DET3_BOUND, permanent), "{a:?} {b:?} {c:?}: {found}");
        assert!(is_permanent(permanent, &size), "{a:?} {b:?} {c:?}: {permanent}");
    }
}

#[test]
fn a_meeting_point_is_within_its_bound() {
    let mut rng = Rng::new(2);
    for draw in 0..DRAWS {
        let column = [OffsetColumn::Finite, OffsetColumn::Infinite][draw % 2];
        let (planes, h) = with_infinity(&mut rng, column);
        let [a, b, c] = &planes;
        let truth = Meeting::of(&planes, &h, column);
        let (point, quick) = (Homogeneous::of(a, b, c, column), Homogeneous::quick(a, b, c, column));
        for (k, [value, size]) in truth.point.iter().enumerate() {
            let (found, permanent) = (point.value[k], point.permanent[k]);
            assert!(is_within(found, value, DET4_BOUND, permanent), "{planes:?} {column:?}: {point:?}");
            assert!(is_permanent(permanent, size), "{planes:?} {column:?}: {point:?}");
            assert!(
                is_within(quick.value[k], value, DET4_BOUND, quick.permanent[k]),
                "{planes:?} {column:?}: {quick:?}"
            );
            let reach = exact(quick.permanent[k]);
            assert!(&reach + shifted(&reach, 49) >= *size, "{planes:?} {column:?}: {quick:?}");
        }
        if column == OffsetColumn::Finite {
            assert_eq!(Homogeneous::meet(a, b, c), point);
            assert_eq!(point.side_of([a, b, c], &h), sign_of(&truth.side[0]));
        }
    }
}

#[test]
fn a_certain_side_is_the_side() {
    let mut rng = Rng::new(3);
    let mut certain = 0;
    for draw in 0..DRAWS {
        let column = [OffsetColumn::Finite, OffsetColumn::Infinite][draw % 2];
        let (planes, h) = with_infinity(&mut rng, column);
        let [a, b, c] = &planes;
        let found = Probe::new(&h, column).certain_side(&Corner::new(&Homogeneous::quick(a, b, c, column), column));
        let truth = sign_of(&Meeting::of(&planes, &h, column).side[0]);
        assert!(found == truth || found == Sign::Zero, "{planes:?} {h:?} {column:?}: {found:?}, exactly {truth:?}");
        assert_eq!(Homogeneous::of(a, b, c, column).side([a, b, c], &h, column), truth, "{planes:?} {h:?} {column:?}");
        certain += usize::from(found != Sign::Zero);
    }
    assert!(certain > DRAWS / 4 && certain < DRAWS, "{certain} of {DRAWS}");
}

/// Below `2^-SURE_TWICE` of the permanent double-doubles may leave a sign open, above it they may not.
const SURE_TWICE: usize = 97;

#[test]
fn what_double_doubles_decide_is_the_side() {
    let mut rng = Rng::new(8);
    let (mut behind, mut open, mut short) = (0, 0, 0);
    for _ in 0..2 * DRAWS {
        let [a, b, c, h]: [Row; 4] = rows(&mut rng);
        let [value, size] = Meeting::of(&[a, b, c], &h, OffsetColumn::Finite).side;
        assert_eq!(side_left_open([&a, &b, &c], &h), sign_of(&value), "{a:?} {b:?} {c:?} {h:?}");
        let found = match extended::side([&a, &b, &c], &h, size.to_f64().value()) {
            Found::Sign(found) => {
                assert_eq!(found, sign_of(&value), "{a:?} {b:?} {c:?} {h:?}");
                Some(found)
            }
            Found::Below(bound) => {
                assert!(magnitude(&value) <= exact(bound), "{a:?} {b:?} {c:?} {h:?}: {bound}");
                let small = near_zero::side([&a, &b, &c], &h, bound);
                assert!(small.is_none_or(|found| found == sign_of(&value)), "{a:?} {b:?} {c:?} {h:?}: {small:?}");
                short += usize::from(small.is_some());
                None
            }
            Found::Nothing => None,
        };
        if magnitude(&value) > shifted(&size, SURE_TWICE) {
            assert!(found.is_some(), "{a:?} {b:?} {c:?} {h:?}");
            behind += usize::from(magnitude(&value) < shifted(&size, SURE));
        } else {
            open += 1;
        }
    }
    assert!(behind > DRAWS / 20 && open > DRAWS / 20, "{behind} behind the filter, {open} open");
    assert!(short > open / 2, "{short} of {open} by three words");
}

#[test]
fn determinants_with_zeros_are_exact() {
    // of planes through the origin, near it and far away, and across axes
    let (normals, offsets) = ([0.0, 0.0, 1.0, -1.0, 0.3, 0.01, 1.0 + f64::EPSILON], [0.0, 0.0, 1e-9, 0.3, 1e6]);
    let mut rng = Rng::new(10);
    let (mut found, mut zeros) = (0, 0);
    for _ in 0..2 * DRAWS {
        let planes: [[f64; 4]; 4] = std::array::from_fn(|_| {
            std::array::from_fn(|k| if k < 3 { rng.pick(&normals) } else { rng.pick(&offsets) })
        });
        if planes.iter().any(|plane| plane[..3].iter().all(|v| *v == 0.0)) {
            continue;
        }
        let [a, b, c, h] = planes.map(row);
        let [value, _] = Meeting::of(&[a, b, c], &h, OffsetColumn::Finite).side;
        let bound = (magnitude(&value).to_f64().value() * (1.0 + 4.0 * f64::EPSILON)).max(1e-200);
        let side = near_zero::side([&a, &b, &c], &h, bound);
        assert!(side.is_none_or(|side| side == sign_of(&value)), "{a:?} {b:?} {c:?} {h:?}: {side:?}");
        assert_eq!(side_left_open([&a, &b, &c], &h), sign_of(&value), "{a:?} {b:?} {c:?} {h:?}");
        found += usize::from(side.is_some());
        zeros += usize::from(side == Some(Sign::Zero));
    }
    assert!(found > DRAWS / 10 && zeros > DRAWS / 10, "{found} found, {zeros} zeros");
}

/// Of any rows, with the determinant itself as the bound: up to the longest that three words hold.
#[test]
fn determinants_of_three_words_are_exact() {
    let mut rng = Rng::new(9);
    let (mut found, mut long) = (0, 0);
    for _ in 0..2 * DRAWS {
        let [a, b, c, h]: [Row; 4] = rows(&mut rng);
        let [value, size] = Meeting::of(&[a, b, c], &h, OffsetColumn::Finite).side;
        let bound = (magnitude(&value).to_f64().value() * (1.0 + 4.0 * f64::EPSILON)).max(1e-200);
        let side = near_zero::side([&a, &b, &c], &h, bound);
        assert!(side.is_none_or(|side| side == sign_of(&value)), "{a:?} {b:?} {c:?} {h:?}: {side:?}");
        found += usize::from(side.is_some());
        // one word less than it has would not do
        long += usize::from(side.is_some() && near_zero::side([&a, &b, &c], &h, bound * 2f64.powi(64)).is_none());
        assert!(magnitude(&value) <= size);
    }
    assert!(found > DRAWS / 4 && long > DRAWS / 40, "{found} found, {long} of more than two words");
}

#[test]
fn a_loose_sum_is_within_its_bound() {
    let mut rng = Rng::new(9);
    let value = |v: DoubleDouble| exact(v.high) + exact(v.low);
    let mut cancelled = 0;
    for draw in 0..2 * DRAWS {
        let [p, q, r, s]: [f64; 4] = std::array::from_fn(|_| rng.float(-2.0, 2.0));
        let left = DoubleDouble::product(p, q);
        // products that differ in their last digits, or anywhere
        let right = if draw % 2 == 0 {
            DoubleDouble::product(rng.nudge(p, 3), rng.nudge(-q, 3)).plus(DoubleDouble::product(r, s * 1e-20))
        } else {
            DoubleDouble::product(r, s)
        };
        let (sum, size) = (value(left) + value(right), magnitude(&value(left)) + magnitude(&value(right)));
        let found = left.plus_loosely(right);
        assert!(
            magnitude(&(value(found) - &sum)) <= shifted(&size, 106) * RBig::from(7),
            "{left:?} {right:?}: {found:?}"
        );
        assert!(found.low.abs() <= f64::EPSILON * found.high.abs(), "{left:?} {right:?}: {found:?}");
        cancelled += usize::from(magnitude(&sum) < shifted(&size, 40));
    }
    assert!(cancelled > DRAWS / 4, "{cancelled}");
}

/// The quick permanents are a few times too large, not more, and sides that are clear are found.
#[test]
fn quick_bounds_fit_dense_rows() {
    let mut rng = Rng::new(4);
    let mut clear = 0;
    for _ in 0..DRAWS {
        let [a, b, c, h]: [Row; 4] = dense_rows(&mut rng);
        let truth = Meeting::of(&[a, b, c], &h, OffsetColumn::Finite);
        let quick = Homogeneous::quick(&a, &b, &c, OffsetColumn::Finite);
        for (k, [_, size]) in truth.point.iter().enumerate() {
            assert!(exact(quick.permanent[k]) <= size * RBig::from(9), "{a:?} {b:?} {c:?}: {quick:?}");
        }
        let [value, size] = &truth.side;
        if magnitude(value) > shifted(size, SURE) {
            clear += 1;
            assert_eq!(
                Probe::new(&h, OffsetColumn::Finite).certain_side(&Corner::new(&quick, OffsetColumn::Finite)),
                sign_of(value),
                "{a:?} {b:?} {c:?} {h:?}"
            );
        }
        let [value, size] = sum(terms_of_det3([&normal(&a), &normal(&b), &normal(&c)]));
        if magnitude(&value) > shifted(&size, SURE) {
            assert_eq!(certain_det3(&a, &b, &c), sign_of(&value), "{a:?} {b:?} {c:?}");
        }
    }
    assert!(clear > DRAWS / 2, "{clear} of {DRAWS}");
}

#[test]
fn a_certain_determinant_has_the_sign() {
    let mut rng = Rng::new(5);
    let mut certain = 0;
    for _ in 0..DRAWS {
        let [a, b, c]: [Row; 3] = rows(&mut rng);
        let [value, _] = sum(terms_of_det3([&normal(&a), &normal(&b), &normal(&c)]));
        let (found, truth) = (certain_det3(&a, &b, &c), sign_of(&value));
        assert!(found == truth || found == Sign::Zero, "{a:?} {b:?} {c:?}: {found:?}, exactly {truth:?}");
        certain += usize::from(found != Sign::Zero);
    }
    assert!(certain > DRAWS / 4 && certain < DRAWS, "{certain} of {DRAWS}");
}

/// The determinants of `n` with two planes each, and the sums of the magnitudes of their terms.
fn slopes<const N: usize>(n: &Row, pairs: [[&Row; 2]; N]) -> [[RBig; 2]; N] {
    pairs.map(|[p, q]| sum(terms_of_det3([&normal(n), &normal(p), &normal(q)])))
}

/// Checks where a climb goes on, of edges counted from `first`; whether it told.
fn check_slope<const N: usize>(found: Slope, edges: &[[RBig; 2]; N], first: usize, must_tell: bool) -> bool {
    match found {
        Slope::Up(k) => assert!(edges[k - first][0] < RBig::ZERO, "{found:?}: {edges:?}"),
        Slope::Top => assert!(edges.iter().all(|[value, _]| *value > RBig::ZERO), "{edges:?}"),
        Slope::Open => {
            let clear = edges.iter().all(|[value, size]| magnitude(value) > shifted(size, SURE));
            assert!(!(must_tell && clear), "{edges:?}: open");
        }
    }
    found != Slope::Open
}

/// The climb at the vertex of three planes, and where it goes up, at one that the edge leads to, on plane `r`.
fn check_ascent(n: &Row, planes: &[Row; 3], r: &Row, must_tell: bool) -> [Option<bool>; 2] {
    let [a, b, c] = planes;
    let (mut ascent, slope) = Ascent::begin(n, [a, b, c]);
    let told = check_slope(slope, &slopes(n, [[b, c], [c, a], [a, b]]), 0, must_tell);
    let Slope::Up(k) = slope else { return [Some(told), None] };
    // seen from the other end, the two planes of the edge change places
    let (p, q) = (&planes[(k + 2) % 3], &planes[(k + 1) % 3]);
    let slope = ascent.step(n, r);
    [Some(told), Some(check_slope(slope, &slopes(n, [[q, r], [r, p]]), 1, must_tell))]
}

#[test]
fn a_climb_goes_up_and_ends_at_the_top() {
    let mut rng = Rng::new(6);
    let mut told = [0; 2];
    for _ in 0..4 * DRAWS {
        let [n, a, b, c, r]: [Row; 5] = rows(&mut rng);
        for (count, answer) in told.iter_mut().zip(check_ascent(&n, &[a, b, c], &r, false)) {
            *count += usize::from(answer == Some(true));
        }
        let [n, a, b, c, r]: [Row; 5] = dense_rows(&mut rng);
        check_ascent(&n, &[a, b, c], &r, true);
    }
    assert!(told.iter().all(|count| (DRAWS / 2..4 * DRAWS).contains(count)), "{told:?} of {}", 4 * DRAWS);
}

/// A corner made with products that are known is off by as little as one made at once, and has the same permanents.
#[test]
fn a_corner_is_the_meeting_point() {
    let mut rng = Rng::new(7);
    for _ in 0..DRAWS {
        let [n, p, q, h]: [Row; 4] = rows(&mut rng);
        let corner = FaceCorners::begin(&n, &p).next(&q).homogeneous();
        let quick =
            Corner::new(&Homogeneous::quick(&n, &p, &q, OffsetColumn::Finite), OffsetColumn::Finite).homogeneous();
        let truth = Meeting::of(&[n, p, q], &h, OffsetColumn::Finite);
        for (k, [value, _]) in truth.point.iter().enumerate() {
            assert!(
                is_within(corner.value[k], value, DET4_BOUND, corner.permanent[k]),
                "{n:?} {p:?} {q:?}: {corner:?}"
            );
        }
        // they are rounded in another order, then to half their length
        for (a, b) in corner.permanent.into_iter().zip(quick.permanent) {
            assert!((a - b).abs() <= 1e-5 * b, "{n:?} {p:?} {q:?}");
        }
    }
}
