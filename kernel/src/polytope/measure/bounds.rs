//! The bounds of the tier of 100 bits against exact corners and against sums in 1,088 bits.

use std::array::from_fn;

use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::DVec3;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::{cases, first_seed};

use super::corners::Corners;
use super::double::DoubleSums;
use crate::arithmetic::{DoubleDouble, ldexp};
use crate::half_space::HalfSpace;
use crate::polytope::IncrementalPolytope;
use crate::sign::homogeneous_exactly;

type Plane = [f64; 4];

const KINDS: u64 = 8;

fn power(rng: &mut Rng, low: i64, high: i64) -> f64 {
    2f64.powi(rng.integer(low, high) as i32)
}

fn along(n: [f64; 3], point: [f64; 3]) -> f64 {
    n[0] * point[0] + n[1] * point[1] + n[2] * point[2]
}

/// Pairs of planes on both sides of the origin.
fn slabs(rng: &mut Rng, normals: &[[f64; 3]], smallest: i64) -> Vec<Plane> {
    let mut planes = Vec::new();
    for &[x, y, z] in normals {
        let width = power(rng, smallest, 0);
        planes.push([x, y, z, rng.float(0.5, 1.0) * width]);
        planes.push([-x, -y, -z, rng.float(0.5, 1.0) * width]);
    }
    planes
}

fn near(rng: &mut Rng, n: [f64; 3], distance: f64) -> [f64; 3] {
    let by = rng.direction();
    from_fn(|k| n[k] + by[k] * distance)
}

/// Bodies that are hard on one of the bounds each.
fn planes(rng: &mut Rng, kind: u64) -> Vec<Plane> {
    let normals = [rng.direction(), rng.direction(), rng.direction()];
    let mut planes = match kind {
        // an askew box, needle or plate
        0 => slabs(rng, &normals, -30),
        // many faces, many of them nearly parallel to their neighbours
        1 => {
            let count = 20 + rng.below(100);
            (0..count).map(|_| rng.direction()).map(|[x, y, z]| [x, y, z, 1.0]).collect()
        }
        // wedges of nearly parallel planes
        2 => {
            let mut planes = slabs(rng, &normals, 0);
            for _ in 0..1 + rng.below(4) {
                let (n, distance) = (rng.pick(&normals), power(rng, -50, -2));
                let [x, y, z] = near(rng, n, distance);
                planes.push([x, y, z, rng.float(0.2, 1.0)]);
            }
            planes
        }
        // each axis at its own scale
        3 => {
            let count = 8 + rng.below(12);
            let scale = [power(rng, -60, 60), power(rng, -60, 60), power(rng, -60, 60)];
            (0..count)
                .map(|_| {
                    let n = rng.direction();
                    [n[0] / scale[0], n[1] / scale[1], n[2] / scale[2], rng.float(0.8, 1.2)]
                })
                .collect()
        }
        // a corner cut off very near its tip
        4 => {
            let mut planes = slabs(rng, &normals, -3);
            let sum: [f64; 3] = from_fn(|k| planes[0][k] + planes[2][k] + planes[4][k]);
            let reach = planes[0][3] + planes[2][3] + planes[4][3];
            planes.push([sum[0], sum[1], sum[2], reach * (1.0 - power(rng, -45, -2))]);
            planes
        }
        // rows of any length
        5 => {
            let mut planes = slabs(rng, &normals, -3);
            planes.iter_mut().for_each(|plane| *plane = plane.map(|v| v * 3.0));
            planes.iter_mut().for_each(|plane| {
                let scale = power(rng, -300, 300);
                *plane = plane.map(|v| v * scale);
            });
            planes
        }
        // a needle that is a wedge in both directions
        6 => {
            let mut planes = slabs(rng, &normals[..1], 0);
            for n in &normals[1..] {
                let (width, angle) = (power(rng, -35, -1), power(rng, -35, -1));
                for n in [*n, n.map(|v| -v)] {
                    let [x, y, z] = near(rng, n, angle);
                    planes.push([x, y, z, width * rng.float(0.5, 1.0)]);
                }
            }
            planes
        }
        // nearly along the axes
        _ => {
            let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|n| {
                let distance = power(rng, -52, -1);
                near(rng, n, distance)
            });
            slabs(rng, &normals, -20)
        }
    };
    if rng.chance(0.4) {
        let reach = power(rng, -10, 27);
        let by = from_fn(|_| rng.float(-reach, reach));
        planes.iter_mut().for_each(|plane| plane[3] += along([plane[0], plane[1], plane[2]], by));
    }
    planes
}

fn exactly(v: f64) -> RBig {
    RBig::try_from(v).expect("a finite number")
}

fn exactly_both(v: DoubleDouble) -> RBig {
    exactly(v.high) + exactly(v.low)
}

fn magnitude(v: RBig) -> RBig {
    if v < RBig::ZERO { -v } else { v }
}

/// Each corner and each distance is as near as its bound says.
fn check_corners(polytope: &IncrementalPolytope, of: &Corners) {
    for vertex in polytope.vertices.slots() {
        let [x, y, z, w] = homogeneous_exactly(polytope.vertices.planes(vertex).map(|plane| polytope.row(plane)));
        let w = RBig::from(w);
        for (axis, numerator) in [x, y, z].into_iter().enumerate() {
            let exact = RBig::from(numerator) / &w - exactly(of.reference[axis]);
            let unit = exactly(ldexp(1.0, of.exponents[axis]));
            let off = magnitude(exact / unit - exactly_both(of.corners[vertex as usize][axis]));
            assert!(off <= exactly(of.errors[vertex as usize]), "corner {vertex}, axis {axis}");
        }
    }
    for plane in polytope.face_slots() {
        let [x, y, z, d] = polytope.row(plane).coefficients().map(exactly);
        let [px, py, pz] = of.reference.to_array().map(exactly);
        let got = of.distances[plane as usize];
        let off = magnitude(d - x * px - y * py - z * pz - exactly_both(got.value));
        assert!(off <= exactly(got.error), "distance {plane}");
    }
}

/// Whether there were sums to be checked.
fn check_sums(polytope: &IncrementalPolytope) -> bool {
    let Some(DoubleSums { sums, area }) = polytope.double_sums() else { return false };
    let wide = polytope.wide_corners(1088);
    if let (Some(got), Some(exact)) = (area, wide.area(polytope, None)) {
        assert!((got - exact).abs() <= exact.next_up() - exact, "area {got:e}, exactly {exact:e}");
    }
    let exact = wide.sums(polytope).expect("enough bits for any of these");
    assert_eq!((sums.units, sums.reference), (exact.units, exact.reference));
    let unit = |power: i64| {
        let one = RBig::from(IBig::ONE << power.unsigned_abs() as usize);
        if power < 0 { RBig::ONE / one } else { one }
    };
    let scale = unit(exact.exponent);
    // what the exact ones lost as double-double numbers
    let room = exactly(20.0 * exact.six_volume.high) * &scale * unit(-102);
    let check = |what: &str, got: DoubleDouble, exact: DoubleDouble, error: f64| {
        let off = magnitude(exactly_both(got) - exactly_both(exact) * &scale);
        assert!(off <= exactly(error) + &room, "{what}");
    };
    check("volume", sums.six_volume, exact.six_volume, sums.errors[0]);
    (0..3).for_each(|k| check("first moment", sums.first[k], exact.first[k], sums.errors[1]));
    (0..6).for_each(|k| check("second moment", sums.second[k], exact.second[k], sums.errors[2]));
    true
}

#[test]
fn bounds_hold() {
    let (mut done, mut left) = (0, 0);
    for k in 0..cases(1600) as u64 {
        let seed = first_seed() + k;
        let planes = planes(&mut Rng::new(seed), k % KINDS);
        let mut polytope = IncrementalPolytope::new();
        for &[x, y, z, d] in &planes {
            polytope.add_plane(HalfSpace::new(DVec3::new(x, y, z), d).expect("in the accepted range"));
        }
        if !polytope.is_bounded() || polytope.is_empty() {
            continue;
        }
        // printed only where the test fails
        println!("seed {seed}, planes:\nlet planes: Vec<[f64; 4]> = vec!{planes:?};");
        if let Some(corners) = polytope.double_corners() {
            check_corners(&polytope, &corners);
        }
        if check_sums(&polytope) { done += 1 } else { left += 1 }
    }
    assert!(done > 20 * left, "{done} bodies done in 100 bits, {left} left to more");
}
