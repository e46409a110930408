//! Order and turn of meeting points, exactly, against rationals.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use planecut_kernel::sign::{Row, Sign};
use planecut_kernel::{compare_exactly, planar_turn};
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

#[test]
fn the_turn_is_that_of_the_rationals() {
    let mut rng = Rng::new(first_seed());
    let mut seen = [0; 3];
    for k in 0..DRAWS {
        let points = [(); 3].map(|()| draw(&mut rng, k % 2 == 0));
        let [p, q, r] = &points;
        for (u, v) in [(0, 1), (1, 2), (2, 0), (1, 0)] {
            let step = |to: &Point, axis: usize| &to.at[axis] - &p.at[axis];
            let area = step(q, u) * step(r, v) - step(q, v) * step(r, u);
            let truth = match area.cmp(&RBig::ZERO) {
                Ordering::Less => Sign::Negative,
                Ordering::Equal => Sign::Zero,
                Ordering::Greater => Sign::Positive,
            };
            let found = planar_turn([p.rows(), q.rows(), r.rows()], u, v);
            assert_eq!(found, truth, "{:?} {:?} {:?} {u} {v}", p.rows, q.rows, r.rows);
            seen[truth as usize] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > DRAWS / 10), "{seen:?}");
}
