//! Each tier against exact arithmetic: what the floating-point tier claims to be certain of, what the integer tiers compute,
//! and what a row keeps of its plane.

mod filter;
mod integers;
mod row;

use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::DVec3;
use planecut_oracle::exact::{cross, det3};
use planecut_oracle::random::Rng;

use super::{Row, Sign};
use crate::half_space::HalfSpace;

/// Draws of each test.
const DRAWS: usize = 3_000;

fn plane([x, y, z, d]: [f64; 4]) -> HalfSpace {
    HalfSpace::new(DVec3::new(x, y, z), d).unwrap_or_else(|e| panic!("{:?}: {e}", [x, y, z, d]))
}

fn row(coefficients: [f64; 4]) -> Row {
    Row::new(&plane(coefficients))
}

fn exact(v: f64) -> RBig {
    RBig::try_from(v).expect("a finite number")
}

fn magnitude(v: &RBig) -> RBig {
    if *v < RBig::ZERO { -v.clone() } else { v.clone() }
}

/// `2^-power` of a number.
fn shifted(v: &RBig, power: usize) -> RBig {
    v / RBig::from(IBig::ONE << power)
}

fn sign_of(v: &RBig) -> Sign {
    match v.cmp(&RBig::ZERO) {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

/// A sum of products as its exact value and the sum of the magnitudes of its terms.
fn sum(terms: impl IntoIterator<Item = RBig>) -> [RBig; 2] {
    terms.into_iter().fold([RBig::ZERO, RBig::ZERO], |[value, size], term| {
        let larger = size + magnitude(&term);
        [value + term, larger]
    })
}

/// The terms of the determinant of three vectors.
fn terms_of_det3([a, b, c]: [&[RBig; 3]; 3]) -> [RBig; 6] {
    [(0, 1, 2, 1), (1, 2, 0, 1), (2, 0, 1, 1), (0, 2, 1, -1), (1, 0, 2, -1), (2, 1, 0, -1)]
        .map(|(i, j, k, parity)| &a[i] * &b[j] * &c[k] * RBig::from(parity))
}

fn normal(row: &Row) -> [RBig; 3] {
    let [x, y, z, _] = *row.coefficients();
    [x, y, z].map(exact)
}

/// Planes through one point up to little; the point lies on coordinate planes by chance, and these are among the planes.
fn near_point<const N: usize>(rng: &mut Rng) -> [Row; N] {
    let distance = rng.pick(&[1.0, 1e8]);
    let mut point = rng.direction().map(|v| v * distance);
    point[rng.below(3)] = 0.0;
    let reach = rng.pick(&[0, 1, 3]);
    std::array::from_fn(|_| {
        let mut n = rng.direction();
        if rng.chance(0.3) {
            n = [0.0; 3];
            n[rng.below(3)] = rng.pick(&[1.0, -0.7]);
        }
        let offset = n[0] * point[0] + n[1] * point[1] + n[2] * point[2];
        row([n[0], n[1], n[2], rng.nudge(offset, reach)])
    })
}

/// Long integer rows through one point, or past it by one.
fn near_integer_point<const N: usize>(rng: &mut Rng) -> [Row; N] {
    let bits = [rng.integer(1, 24), rng.integer(1, 24)];
    let point = rng.lattice(1 << bits[0]);
    std::array::from_fn(|_| {
        let n = rng.lattice(1 << bits[1]);
        let offset = n[0] * point[0] + n[1] * point[1] + n[2] * point[2];
        row([n[0], n[1], n[2], offset + rng.pick(&[-1.0, 0.0, 0.0, 1.0])])
    })
}

/// Rows of all kinds that share a kind: dense, sparse, small and large integers, nearly or exactly dependent.
fn rows<const N: usize>(rng: &mut Rng) -> [Row; N] {
    let (kind, bits) = (rng.below(8), rng.integer(16, 47));
    match kind {
        6 => return near_point(rng),
        7 => return near_integer_point(rng),
        _ => {}
    }
    let mut drawn: [[f64; 4]; N] = std::array::from_fn(|_| {
        let [x, y, z] = match kind {
            0 | 1 => rng.direction(),
            2 => rng.lattice(3),
            3 => rng.lattice(1 << bits),
            4 => {
                let axis = rng.below(3);
                std::array::from_fn(|k| if k == axis || rng.chance(0.3) { rng.direction()[k] } else { 0.0 })
            }
            _ => rng.direction().map(|v| v * 2f64.powi(rng.integer(-40, 0) as i32)),
        };
        let offset = if rng.chance(0.2) { 0.0 } else { rng.float(-4.0, 4.0) };
        [x, y, z, if kind == 2 || kind == 3 { (offset * 1000.0).round() } else { offset }]
    });
    if N > 2 && rng.chance(0.5) {
        // the last row from the first two, up to a few units in the last place
        let reach = rng.pick(&[0, 1, 8, 1 << 20]);
        let combined: [f64; 4] = std::array::from_fn(|k| drawn[0][k] - 2.0 * drawn[1][k]);
        let nudged = combined.map(|v| rng.nudge(v, reach));
        if HalfSpace::new(DVec3::new(nudged[0], nudged[1], nudged[2]), nudged[3]).is_ok() {
            drawn[N - 1] = nudged;
        }
        rng.shuffle(&mut drawn);
    }
    drawn.map(row)
}

/// Rows whose normal components are all about as large as the largest: the quick bounds fit them well.
fn dense_rows<const N: usize>(rng: &mut Rng) -> [Row; N] {
    std::array::from_fn(|_| {
        let mut component = || rng.float(0.5, 1.0) * rng.pick(&[1.0, -1.0]);
        row([component(), component(), component(), component()])
    })
}

#[test]
fn terms_add_up_to_the_determinant() {
    let mut rng = Rng::new(1);
    for _ in 0..100 {
        let vectors: [[IBig; 3]; 3] = std::array::from_fn(|_| rng.lattice(9).map(|v| IBig::from(v as i64)));
        let [a, b, c] = [0, 1, 2].map(|k| vectors[k].clone().map(RBig::from));
        let [value, size] = sum(terms_of_det3([&a, &b, &c]));
        assert_eq!(value, RBig::from(det3(&vectors[0], &vectors[1], &vectors[2])));
        assert!(size >= magnitude(&value));
        assert_eq!(cross(&vectors[0], &vectors[0]), [IBig::ZERO, IBig::ZERO, IBig::ZERO]);
    }
}
