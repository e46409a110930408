//! A half-space for a facet: exact where its coefficients fit, else rounded so that it contains every point.

use std::array::from_fn;

use dashu_int::{IBig, UBig, ops::BitTest, ops::Gcd};
use glam::DVec3;

use crate::double_double::DoubleDouble;
use crate::half_space::HalfSpace;
use crate::meet::round_quotient;
use crate::polytope::exact_side;
use crate::sign::{Row, Sign, big_integers};

/// Components of a rounded normal that are this much smaller than the largest are left out; the offset makes up for it.
const NEGLIGIBLE: f64 = f64::from_bits((1023 - 100) << 52);
/// The smallest ratio of an offset to a normal that half-spaces accept, with room.
const SMALLEST_OFFSET: f64 = f64::from_bits((1023 - 190) << 52);

/// The half-space through three points of a hull, counter-clockwise seen from outside, that contains all of them.
pub(super) fn through(points: &[DVec3], corners: [u32; 3], neighbours: &[Vec<u32>]) -> HalfSpace {
    let [a, b, c] = corners.map(|p| points[p as usize]);
    if let Some(half_space) = small_integers(a, b, c) {
        return half_space;
    }
    let coefficients = exact_coefficients(a, b, c);
    if let Some(half_space) = representable(&coefficients) {
        return half_space;
    }
    let normal = rounded_normal(&coefficients);
    let top = farthest(points, corners[0], normal, neighbours);
    containing(normal, points[top as usize])
}

/// A half-space that touches the hull at a sharp edge, given by its two ends and the opposite corners of its triangles;
/// `None` where they are too near each other to tell.
pub(super) fn across_edge(points: &[DVec3], edge: &[u32; 4], neighbours: &[Vec<u32>]) -> Option<HalfSpace> {
    let [from, to, first, second] = edge.map(|p| points[p as usize]);
    let along = (to - from).normalize_or_zero();
    let away = |p: DVec3| {
        let inward = p - from;
        -(inward - along * inward.dot(along)).normalize_or_zero()
    };
    let normal = (away(first) + away(second)).normalize_or_zero();
    let normal = normal.map(|v| if v.abs() < NEGLIGIBLE { 0.0 } else { v });
    if normal == DVec3::ZERO {
        return None;
    }
    Some(containing(normal, points[farthest(points, edge[0], normal, neighbours) as usize]))
}

/// The exact plane where everything is a small integer.
fn small_integers(a: DVec3, b: DVec3, c: DVec3) -> Option<HalfSpace> {
    const SMALL: f64 = (1u64 << 15) as f64;
    let is_small = |p: DVec3| p == p.trunc() && p.abs().max_element() < SMALL;
    if ![a, b, c].into_iter().all(is_small) {
        return None;
    }
    let normal = (b - a).cross(c - a);
    HalfSpace::new(normal, normal.dot(a)).ok()
}

/// `[n | d]` of the plane through three points, up to one positive scale.
fn exact_coefficients(a: DVec3, b: DVec3, c: DVec3) -> [IBig; 4] {
    let [ax, ay, az, bx, by, bz, cx, cy, cz, one] = big_integers([a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, 1.0]);
    let (u, v) = ([bx - &ax, by - &ay, bz - &az], [cx - &ax, cy - &ay, cz - &az]);
    let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    let normal = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let offset = &normal[0] * ax + &normal[1] * ay + &normal[2] * az;
    let [x, y, z] = normal;
    [x * &one, y * &one, z * &one, offset]
}

/// The plane itself, where its coprime coefficients are below 2⁵³ (or up to powers of two, so few bits long).
fn representable(coefficients: &[IBig; 4]) -> Option<HalfSpace> {
    let magnitudes = coefficients.each_ref().map(|v| v.clone().into_parts().1);
    let divisor = magnitudes.into_iter().filter(|v| !v.is_zero()).reduce(UBig::gcd)?;
    let divisor = IBig::from(divisor);
    let coprime = coefficients.each_ref().map(|v| v / &divisor);
    if coprime.iter().any(|v| v.bit_len() > 53) {
        return None;
    }
    let [x, y, z, d] = coprime.map(|v| i64::try_from(v).unwrap_or_default() as f64);
    HalfSpace::new(DVec3::new(x, y, z), d).ok()
}

/// The normal scaled to a largest component of one, each component correctly rounded.
fn rounded_normal(coefficients: &[IBig; 4]) -> DVec3 {
    let largest = (0..3).map(|k| coefficients[k].clone().into_parts().1).max().unwrap_or(UBig::ONE);
    let largest = IBig::from(largest);
    DVec3::from_array(from_fn(|k| {
        let component = round_quotient(coefficients[k].clone(), &largest);
        if component.abs() < NEGLIGIBLE { 0.0 } else { component }
    }))
}

/// The vertex of the hull that is farthest along a normal: a local maximum among neighbours is one of all.
fn farthest(points: &[DVec3], start: u32, normal: DVec3, neighbours: &[Vec<u32>]) -> u32 {
    let mut top = start;
    'climb: loop {
        for &other in &neighbours[top as usize] {
            if is_farther(normal, points[other as usize], points[top as usize]) {
                top = other;
                continue 'climb;
            }
        }
        return top;
    }
}

/// Whether `n·p > n·q`, exactly.
fn is_farther(normal: DVec3, p: DVec3, q: DVec3) -> bool {
    let (n, p, q) = (normal.to_array(), p.to_array(), q.to_array());
    let value = (0..3).map(|k| n[k] * (p[k] - q[k])).sum::<f64>();
    let permanent: f64 = (0..3).map(|k| n[k].abs() * (p[k] - q[k]).abs()).sum();
    // difference, product and two sums: 4 roundings a term
    if value.abs() > 4.0 * f64::EPSILON * permanent {
        return value > 0.0;
    }
    let [nx, ny, nz] = big_integers(n);
    let [px, py, pz, qx, qy, qz] = big_integers([p[0], p[1], p[2], q[0], q[1], q[2]]);
    nx * (px - qx) + ny * (py - qy) + nz * (pz - qz) > IBig::ZERO
}

/// The half-space of a normal whose offset is the smallest number that lets it contain a point.
fn containing(normal: DVec3, point: DVec3) -> HalfSpace {
    let sum = DoubleDouble::product(normal.x, point.x)
        .plus(DoubleDouble::product(normal.y, point.y))
        .plus(DoubleDouble::product(normal.z, point.z));
    let mut offset = sum.high;
    loop {
        // an offset too small for a half-space is moved outward to one that fits
        if offset != 0.0 && offset.abs() < SMALLEST_OFFSET {
            offset = if offset > 0.0 { SMALLEST_OFFSET } else { 0.0 };
        }
        let half_space = HalfSpace::new(normal, offset).expect("the points are in the accepted range");
        if exact_side(&Row::new(&half_space), point) != Sign::Positive {
            return half_space;
        }
        offset = offset.next_up();
    }
}
