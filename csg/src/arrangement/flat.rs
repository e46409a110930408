//! Places on one line, or on one plane.

use dashu_int::IBig;
use glam::{DVec3, Vec3Swizzles};
use planecut_kernel::decompose;

use super::exact::{Vector, cross, dot, integers, minus};
use crate::tolerances::FLATNESS;

/// Bound on the rounding of a component of a triangle's normal, in units of the magnitudes that it is a difference of.
const BOUND: f64 = 4.0 * f64::EPSILON;

/// Whether plain numbers show that three places are not on one line.
#[inline]
pub(super) fn is_surely_not_flat([a, b, c]: [DVec3; 3]) -> bool {
    let (p, q) = (b - a, c - a);
    let (left, right) = (p.yzx() * q.zxy(), p.zxy() * q.yzx());
    (left - right).abs().cmpgt(BOUND * (left.abs() + right.abs())).any()
}

/// Whether three places are on one line, exactly.
pub(super) fn are_collinear(places: [DVec3; 3]) -> bool {
    let [a, b, c] = in_one_unit(places);
    cross(&minus(&b, &a), &minus(&c, &a)).iter().all(|component| *component == IBig::ZERO)
}

/// Whether a glance shows that four places are on one plane, exactly: they have one coordinate in common, or some two lines along an axis run
/// through all of them. Nearly all planes that meshes share are of these kinds, which rounded numbers never tell and exact ones tell slowly.
pub(super) fn are_plainly_coplanar([a, b, c, d]: [DVec3; 4]) -> bool {
    let [ab, ac, ad, bc, bd, cd] = [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)].map(|(p, q)| p.cmpeq(q).bitmask());
    let are_on_two_lines = |axis: u32| {
        let others = 0b111 & !(1 << axis);
        let is_one = |equal: u32| equal & others == others;
        is_one(ab) && (is_one(cd) || is_one(ac) || is_one(ad))
            || is_one(ac) && (is_one(bd) || is_one(ad))
            || is_one(bc) && (is_one(ad) || is_one(bd))
    };
    ab & ac & ad != 0 || (0..3).any(are_on_two_lines)
}

/// Whether four places are on one plane, exactly.
pub(super) fn are_coplanar(places: [DVec3; 4]) -> bool {
    let [p, q, r] = [1, 2, 3].map(|k| places[k] - places[0]);
    let (left, right) = (q.yzx() * r.zxy(), q.zxy() * r.yzx());
    if p.dot(left - right).abs() > BOUND * p.abs().dot(left.abs() + right.abs()) {
        return false;
    }
    if are_plainly_coplanar(places) {
        return true;
    }
    let is_safe = |v: &f64| *v == 0.0 || (1e-60..1e60).contains(&v.abs());
    if places.iter().all(|place| place.to_array().iter().all(is_safe)) {
        let [a, b, c, d] = places.map(|DVec3 { x, y, z }| robust::Coord3D { x, y, z });
        return robust::orient3d(a, b, c, d) == 0.0;
    }
    let [a, b, c, d] = in_one_unit(places);
    dot(&minus(&b, &a), &cross(&minus(&c, &a), &minus(&d, &a))) == IBig::ZERO
}

/// Whether four places are on one plane after moving each of their coordinates by a share [`FLATNESS`] of the largest at most: the volume that they span
/// is one that this takes away.
pub(super) fn are_nearly_coplanar([a, b, c, d]: [DVec3; 4]) -> bool {
    let (p, q, r) = (b - a, c - a, d - a);
    // the volume changes by the area opposite to a corner where that corner moves
    let of_sides = [q.cross(r), r.cross(p), p.cross(q), (q - p).cross(r - p)];
    let areas: f64 = of_sides.iter().map(|normal| normal.abs().element_sum()).sum();
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs()).max_element();
    p.dot(of_sides[0]).abs() <= FLATNESS * size * areas
}

/// Places as integers in one unit.
fn in_one_unit<const N: usize>(places: [DVec3; N]) -> [Vector; N] {
    let all = places.map(|place| place.to_array());
    let exponent = |v: &f64| if *v == 0.0 { None } else { Some(decompose(*v).1) };
    let lowest = all.as_flattened().iter().filter_map(exponent).min().unwrap_or(0);
    places.map(|place| integers(place, lowest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_one_plane_at_a_glance_does_so_exactly() {
        let number = |k: usize, axis: usize| f64::from(u8::try_from(k >> (2 * axis) & 0b11).expect("two bits")) / 3.0;
        let place = |k: usize| DVec3::new(number(k, 0), 0.1 + number(k, 1), 0.7 * number(k, 2));
        let mut count = 0;
        for k in 0..4096_usize {
            let places = [0, 1, 2, 3].map(|j| place((k * (7 * j + 5) + 11 * j) % 64));
            if are_plainly_coplanar(places) {
                count += 1;
                let [a, b, c, d] = in_one_unit(places);
                let volume = dot(&minus(&b, &a), &cross(&minus(&c, &a), &minus(&d, &a)));
                assert_eq!(volume, IBig::ZERO, "{places:?}");
            }
        }
        assert!(count > 100, "{count}");
    }

    #[test]
    fn slanted_planes_along_an_axis_are_seen_at_a_glance() {
        let [low, high] = [DVec3::new(0.0, 0.1, 0.3), DVec3::new(0.0, 0.7, 1.1)];
        let along = |from: DVec3, x: f64| from + DVec3::X * x;
        assert!(are_plainly_coplanar([low, along(high, 0.2), along(low, 0.9), along(high, 1.3)]));
        assert!(!are_plainly_coplanar([low, along(high, 0.2), along(low, 0.9), DVec3::ONE]));
    }
}
