//! Order and turn of meeting points, exactly, against rationals.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use planecut_kernel::sign::{Row, Sign};
use planecut_kernel::{compare_exactly, direction_across, line_coordinates, line_direction, planar_turn};
use planecut_oracle::exact::{Coefficients, cross, dot, integer_row, normal};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

const DRAWS: usize = 2_000;

/// Three planes with right-handed normals, and where they meet.
struct Point {
    rows: [Row; 3],
    at: [RBig; 3],
}

impl Point {
    /// `None` where the planes do not meet in one point.
    fn new(planes: [Coefficients; 3]) -> Option<Self> {
        let exact = planes.map(integer_row);
        let [a, b, c] = [0, 1, 2].map(|k| normal(&exact[k]));
        let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
        let w = dot(&a, &bc);
        if w <= 0.into() {
            return None;
        }
        let at = [0, 1, 2].map(|k| {
            let numerator = &exact[0][3] * &bc[k] + &exact[1][3] * &ca[k] + &exact[2][3] * &ab[k];
            RBig::from(numerator) / RBig::from(w.clone())
        });
        Some(Self { rows: planes.map(|plane| Row::new(&half_space(plane))), at })
    }

    fn rows(&self) -> [&Row; 3] {
        let [a, b, c] = &self.rows;
        [a, b, c]
    }
}

/// Small integers, so that coordinates are often equal and points often in line, or decimal numbers.
fn draw(rng: &mut Rng, decimal: bool) -> Point {
    loop {
        let planes = [(); 3].map(|()| {
            let [x, y, z] = if decimal { rng.direction() } else { rng.lattice(1) };
            [x, y, z, if decimal { rng.float(-1.0, 1.0) } else { rng.whole(-1, 1) }]
        });
        if let Some(point) = Point::new(planes) {
            return point;
        }
    }
}

#[test]
fn the_order_is_that_of_the_rationals() {
    let mut rng = Rng::new(first_seed());
    let mut seen = [0; 3];
    for k in 0..DRAWS {
        let [p, q] = [(); 2].map(|()| draw(&mut rng, k % 2 == 0));
        for axes in [&[0][..], &[1, 2], &[2, 0, 1]] {
            let truth = axes.iter().map(|&axis| p.at[axis].cmp(&q.at[axis])).find(|order| order.is_ne());
            let truth = truth.unwrap_or(Ordering::Equal);
            assert_eq!(compare_exactly(p.rows(), q.rows(), axes), truth, "{:?} {:?} {axes:?}", p.rows, q.rows);
            seen[(truth as i8 + 1) as usize] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > DRAWS / 10), "{seen:?}");
}

/// Which way three points turn in the plane of two coordinates.
fn true_turn([p, q, r]: &[Point; 3], u: usize, v: usize) -> Sign {
    let step = |to: &Point, axis: usize| &to.at[axis] - &p.at[axis];
    let area = step(q, u) * step(r, v) - step(q, v) * step(r, u);
    match area.cmp(&RBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

#[test]
fn the_turn_is_that_of_the_rationals() {
    let mut rng = Rng::new(first_seed());
    let mut seen = [0; 3];
    for k in 0..DRAWS {
        let points = [(); 3].map(|()| draw(&mut rng, k % 2 == 0));
        let [p, q, r] = &points;
        for (u, v) in [(0, 1), (1, 2), (2, 0), (1, 0)] {
            let truth = true_turn(&points, u, v);
            let found = planar_turn([p.rows(), q.rows(), r.rows()], u, v);
            assert_eq!(found, truth, "{:?} {:?} {:?} {u} {v}", p.rows, q.rows, r.rows);
            seen[truth as usize] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > DRAWS / 10), "{seen:?}");
}

/// Nine planes that nearly pass through one point, and three points where three of them meet: as far apart as rounding goes.
fn draw_near(rng: &mut Rng) -> [Point; 3] {
    let center = [(); 3].map(|()| rng.float(-1.0, 1.0));
    let plane = |rng: &mut Rng| {
        let [x, y, z] = rng.direction();
        [x, y, z, x * center[0] + y * center[1] + z * center[2]]
    };
    [(); 3].map(|()| {
        loop {
            if let Some(point) = Point::new([plane(rng), plane(rng), plane(rng)]) {
                return point;
            }
        }
    })
}

#[test]
fn turns_of_points_that_rounding_parts_are_those_of_the_rationals() {
    let mut rng = Rng::new(first_seed());
    let mut seen = [0; 3];
    for _ in 0..DRAWS / 4 {
        let points = draw_near(&mut rng);
        let [p, q, r] = &points;
        for (u, v) in [(0, 1), (2, 0)] {
            let truth = true_turn(&points, u, v);
            let found = planar_turn([p.rows(), q.rows(), r.rows()], u, v);
            assert_eq!(found, truth, "{:?} {:?} {:?} {u} {v}", p.rows, q.rows, r.rows);
            seen[truth as usize] += 1;
        }
    }
    assert!(seen[0] > DRAWS / 10 && seen[2] > DRAWS / 10, "{seen:?}");
}

/// Whether a number is the one nearest to a rational, or one of two.
fn is_nearest(found: f64, exact: &RBig) -> bool {
    let rational = |v: f64| RBig::try_from(v).expect("a finite number");
    let two = RBig::from(2);
    let halfway = |other: f64| (rational(found) + rational(other)) / &two;
    halfway(found.next_down()) <= *exact && *exact <= halfway(found.next_up())
}

#[test]
fn coordinates_of_lines_are_the_nearest_numbers() {
    let mut rng = Rng::new(first_seed());
    let mut lines = 0;
    for k in 0..DRAWS {
        // decimals, small integers, and planes that differ by roundings
        let first = [(); 4].map(|()| if k % 3 == 1 { rng.whole(-2, 2) } else { rng.float(-1.0, 1.0) });
        let second = match k % 3 {
            0 => [(); 4].map(|()| rng.float(-1.0, 1.0)),
            1 => [(); 4].map(|()| rng.whole(-2, 2)),
            _ => first.map(|v| v * (1.0 + f64::EPSILON * rng.whole(-4, 4))),
        };
        if [first, second].iter().any(|plane| plane[..3].iter().all(|v| *v == 0.0)) {
            continue;
        }
        let rows = [first, second].map(|plane| Row::new(&half_space(plane)));
        let [a, b] = [first, second].map(integer_row);
        let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let whole = minor(u, v);
            let found = line_coordinates(&rows[0], &rows[1], axis);
            assert_eq!(found.is_none(), whole == 0.into(), "{first:?} {second:?} {axis}");
            let Some(found) = found else { continue };
            // a rational for each: the slopes, and the point at which the axis is zero
            for (number, (i, j)) in found.into_iter().zip([(v, axis), (axis, u), (3, v), (u, 3)]) {
                let exact = RBig::from(minor(i, j)) / RBig::from(whole.clone());
                assert!(is_nearest(number, &exact), "{first:?} {second:?} {axis}: {number}");
            }
            let along = line_direction(&rows[0], &rows[1]);
            let slope = along[u] / along[axis];
            let error = (slope - found[0]).abs();
            assert!(error <= 1e-14 * (1.0 + slope.abs()) * (1.0 + slope.abs()), "{first:?} {second:?} {axis}: {along}");
            lines += 1;
        }
    }
    assert!(lines > DRAWS, "{lines}");
}

#[test]
fn directions_across_two_lines_are_accurate_however_near_these_are() {
    let mut rng = Rng::new(first_seed());
    let mut near = 0;
    for k in 0..DRAWS {
        let base = [(); 4].map(|()| [(); 4].map(|()| rng.float(-1.0, 1.0)));
        // the second pair is any, or the first but for roundings
        let mut wobbled = |plane: Coefficients| plane.map(|v| v * (1.0 + f64::EPSILON * rng.whole(-4, 4)));
        let planes = if k % 2 == 0 { base } else { [base[0], base[1], wobbled(base[0]), wobbled(base[1])] };
        let [a, b, c, d] = planes.map(|plane| Row::new(&half_space(plane)));
        let exact = planes.map(integer_row);
        let [first, second] = [[0, 1], [2, 3]].map(|pair| {
            let [p, q] = pair.map(|k| normal(&exact[k]));
            cross(&p, &q)
        });
        let truth = cross(&first, &second);
        let found = direction_across([[&a, &b], [&c, &d]]).to_array();
        if truth.iter().all(|v| *v == 0.into()) {
            assert_eq!(found, [0.0; 3]);
            continue;
        }
        near += usize::from(k % 2 == 1);
        let axis = (0..3).max_by(|i, j| found[*i].abs().total_cmp(&found[*j].abs())).expect("three");
        assert_eq!(found[axis] > 0.0, truth[axis] > 0.into(), "{planes:?}");
        for other in 0..3 {
            let expected = (RBig::from(truth[other].clone()) / RBig::from(truth[axis].clone())).to_f64().value();
            let error = (found[other] / found[axis] - expected).abs();
            assert!(error <= 4.0 * f64::EPSILON, "{planes:?}: {found:?}, coordinate {other} of {axis}: {expected}");
        }
    }
    assert!(near > DRAWS / 4, "{near}");
}
