//! Whether and how deeply two triangles pass through each other.
//!
//! Two convex sets `A` and `B` share relative interior points exactly where the origin lies in the relative interior of
//! their Minkowski difference `A - B`; the distance of the origin from its boundary is the *penetration depth*, the length of
//! the shortest translation after which they only touch. Each facet of `A - B` is orthogonal to one of eleven axes: the two
//! normals and the nine cross products of an edge of each. So both questions are answered axis by axis (the separating axis
//! theorem): the depth in floating point, "do they meet at all" by exact signs.
//!
//! The depth is a continuous function of the corners: moving each by at most `δ` changes it by at most `2 δ`. So where rounding moved
//! the corners of triangles that only touched, the depth is as small as the rounding, whatever their shape; a needle is no exception.
//! What the depth needs of floating point is the axes. Each direction at all, right or not, gives an upper bound of it, never one
//! too small; the axes of needles, of which plain products leave noise, are computed in twice the precision ([`across`]).

use std::cmp::Ordering;

use glam::DVec3;

use crate::axis::across;
use crate::orient::{determinant_sign, orient3d};

/// The corners of a triangle in order.
pub(crate) type Triangle = [DVec3; 3];

/// An overlap counts where it is this many times deeper in the plane than the two triangles may be apart.
///
/// Corners that are uncertain by `δ` leave the direction of a triangle of width `w` uncertain by `δ / w`: at a sharp but
/// sound edge a tiny triangle may look coplanar with the other side. With this ratio that takes edges below 0.6 degrees.
const OVERLAP_RATIO: f64 = 100.0;

/// The three edges of a triangle as pairs of its corners.
pub(crate) fn edges([a, b, c]: &Triangle) -> [(DVec3, DVec3); 3] {
    [(*a, *b), (*b, *c), (*c, *a)]
}

pub(crate) fn normal(t: &Triangle) -> DVec3 {
    (t[1] - t[0]).cross(t[2] - t[0])
}

/// Penetration depth of two triangles in space, or `None` where it is `limit` or less.
///
/// The least bound of all axes: first those that are cheap, most of which end the search; then the eleven of the theorem in twice the precision.
/// Two triangles so narrow and parallel that they are one segment, even so, are parted across it.
pub(crate) fn penetration_depth(a: &Triangle, b: &Triangle, limit: f64) -> Option<f64> {
    let mut depth = f64::INFINITY;
    for axis in [DVec3::X, DVec3::Y, DVec3::Z, normal(a), normal(b)] {
        depth = depth.min(overlap_along(axis, a, b, limit)?);
    }
    for (p, q) in edges(a) {
        for (r, s) in edges(b) {
            depth = depth.min(overlap_along((q - p).cross(s - r), a, b, limit)?);
        }
    }
    for axis in precise_axes(a, b) {
        depth = depth.min(overlap_along(axis, a, b, limit)?);
    }
    Some(depth)
}

/// The axes that decide, and those across the longest edges.
fn precise_axes(a: &Triangle, b: &Triangle) -> impl Iterator<Item = DVec3> {
    let (of_a, of_b) = (edges(a), edges(b));
    let normals = [of_a, of_b].map(|[e, f, _]| across(e, f));
    let crosses = of_a.into_iter().flat_map(move |e| of_b.into_iter().map(move |f| across(e, f)));
    let around = [a, b].into_iter().filter_map(|t| longest(t).try_normalize()).flat_map(|along| {
        let (x, y) = along.any_orthonormal_pair();
        [x, y]
    });
    let around: Vec<DVec3> = around.collect();
    normals.into_iter().chain(crosses).chain(around)
}

/// The longest edge of a triangle.
fn longest(t: &Triangle) -> DVec3 {
    let lengths = edges(t).map(|(p, q)| q - p);
    lengths.into_iter().max_by(|e, f| e.length_squared().total_cmp(&f.length_squared())).unwrap_or_default()
}

/// How far one of the point sets must move along the axis until they are apart; infinite for a null axis, `None` where it is
/// `limit` or less.
pub(crate) fn overlap_along(axis: DVec3, a: &[DVec3], b: &[DVec3], limit: f64) -> Option<f64> {
    let length = axis.length();
    if length == 0.0 {
        return Some(f64::INFINITY);
    }
    let range = |points: &[DVec3]| {
        points
            .iter()
            .map(|&p| axis.dot(p - a[0]))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)))
    };
    let ((a_low, a_high), (b_low, b_high)) = (range(a), range(b));
    let overlap = (a_high - b_low).min(b_high - a_low);
    // Written so that NaN counts as "not known to be apart": the exact test decides then.
    if overlap <= limit * length { None } else { Some(overlap / length) }
}

/// Whether the relative interiors of two triangles share a point although no plane holds both: they cross. Exact.
pub(crate) fn interiors_cross(a: &Triangle, b: &Triangle) -> bool {
    let (sides_of_a, sides_of_b) = (plane_sides(a, b), plane_sides(b, a));
    if is_one_sided(&sides_of_a) || is_one_sided(&sides_of_b) {
        return false;
    }
    // Not one-sided and not straddling means all zero. Where both are, a plane holds both triangles, or both lack area.
    if sides_of_a.iter().chain(&sides_of_b).all(|&s| s == Ordering::Equal) {
        return false;
    }
    (0..3).all(|i| (0..3).all(|j| !is_separated_by_edges(a, i, b, j)))
}

/// On which sides of the plane of `a` the corners of `b` lie.
fn plane_sides(a: &Triangle, b: &Triangle) -> [Ordering; 3] {
    b.map(|corner| orient3d(a[0], a[1], a[2], corner))
}

/// Whether the signs are all of one side, with zeros allowed but not alone.
fn is_one_sided(signs: &[Ordering]) -> bool {
    signs.contains(&Ordering::Less) != signs.contains(&Ordering::Greater)
}

/// Whether the axis orthogonal to edge `i` of `a` and edge `j` of `b` separates the triangles properly.
fn is_separated_by_edges(a: &Triangle, i: usize, b: &Triangle, j: usize) -> bool {
    let (p, q, a_far) = (a[i], a[(i + 1) % 3], a[(i + 2) % 3]);
    let (r, s, b_far) = (b[j], b[(j + 1) % 3], b[(j + 2) % 3]);
    let side = |from_a: DVec3, from_b: DVec3| determinant_sign([(q, p), (s, r), (from_a, from_b)]);
    is_one_sided(&[side(p, r), side(a_far, r), side(p, b_far), side(a_far, b_far)])
}

/// Depth in their common plane to which two triangles overlap with area, or `None` where they do not, or are not coplanar
/// within `limit`, a length above zero.
///
/// Counted are overlaps of triangles wider than `limit`, where the smaller lies within `limit` of the plane of the larger,
/// deeper than `OVERLAP_RATIO · limit`.
pub(crate) fn overlap_depth(a: &Triangle, b: &Triangle, limit: f64) -> Option<f64> {
    let (normal_a, normal_b) = (normal(a), normal(b));
    let larger_is_a = normal_a.length_squared() >= normal_b.length_squared();
    let (host, guest, axis) = if larger_is_a { (a, b, normal_a) } else { (b, a, normal_b) };
    let axis = axis.try_normalize()?;
    if guest.iter().any(|&p| axis.dot(p - host[0]).abs() > limit) || width(a) <= limit || width(b) <= limit {
        return None;
    }
    let mut depth = f64::INFINITY;
    for (p, q) in edges(a).into_iter().chain(edges(b)) {
        depth = depth.min(overlap_along(axis.cross(q - p), a, b, OVERLAP_RATIO * limit)?);
    }
    Some(depth)
}

/// Smallest height of a triangle.
fn width(t: &Triangle) -> f64 {
    let longest = longest(t).length();
    if longest == 0.0 { 0.0 } else { normal(t).length() / longest }
}

/// Whether two triangles with area lie in one plane and share interior points there. Exact.
pub(crate) fn interiors_overlap(a: &Triangle, b: &Triangle) -> bool {
    let in_one_plane = plane_sides(a, b).iter().chain(&plane_sides(b, a)).all(|&s| s == Ordering::Equal);
    // Along this coordinate axis the plane projects without collapsing.
    let Some(axis) = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|&k| turn(k, a[0], a[1], a[2]).is_ne()) else {
        return false;
    };
    in_one_plane
        && turn(axis, b[0], b[1], b[2]).is_ne()
        && !is_separated_by_own_edge(axis, a, b)
        && !is_separated_by_own_edge(axis, b, a)
}

/// Direction of the turn at `q` on the way from `p` to `r`, seen against the axis.
fn turn(axis: DVec3, p: DVec3, q: DVec3, r: DVec3) -> Ordering {
    determinant_sign([(q, p), (r, p), (axis, DVec3::ZERO)])
}

/// Whether a side of `a` has all of `b` on its outer side or on its line.
fn is_separated_by_own_edge(axis: DVec3, a: &Triangle, b: &Triangle) -> bool {
    let inside = turn(axis, a[0], a[1], a[2]);
    edges(a).into_iter().any(|(p, q)| b.iter().all(|&corner| turn(axis, p, q, corner) != inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: Triangle = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];

    /// A triangle that stands on its corner at depth `depth` below the plane of [`FLAT`], away from the border.
    fn standing(depth: f64) -> Triangle {
        [DVec3::new(1.0, 1.0, -depth), DVec3::new(1.5, 1.0, 3.0), DVec3::new(0.5, 1.0, 3.0)]
    }

    #[test]
    fn the_depth_is_the_distance_to_pull_out() {
        for depth in [0.5, 1e-3, 1e-9] {
            let found = penetration_depth(&FLAT, &standing(depth), 0.0).expect("they cross");
            assert!((found - depth).abs() <= 1e-15, "{found} for {depth}");
            assert!(interiors_cross(&FLAT, &standing(depth)));
            assert_eq!(penetration_depth(&FLAT, &standing(depth), 2.0 * depth), None);
        }
    }

    #[test]
    fn touching_is_not_crossing() {
        let standing = standing(0.0);
        assert!(!interiors_cross(&FLAT, &standing) && !interiors_cross(&standing, &FLAT));
        let on_edge = [DVec3::new(1.0, 0.0, -1.0), DVec3::new(2.0, 0.0, -1.0), DVec3::new(1.5, 0.0, 1.0)];
        assert!(!interiors_cross(&FLAT, &on_edge), "it passes the border line");
        let neighbour = [FLAT[1], FLAT[0], DVec3::new(1.0, 1.0, 1.0)];
        assert!(!interiors_cross(&FLAT, &neighbour) && !interiors_overlap(&FLAT, &neighbour));
    }

    #[test]
    fn triangles_without_area_cross_as_segments() {
        let needle = [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 0.5), DVec3::new(1.0, 1.0, 2.0)];
        assert!(interiors_cross(&FLAT, &needle) && interiors_cross(&needle, &FLAT));
        let other = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0)];
        assert!(!interiors_cross(&other, &needle), "two segments bound nothing");
    }

    /// Two needles that lie along one line, of `pencilrot_6_check_cross.json`: by rationals they reach `4e-18` past each other.
    #[test]
    fn needles_along_one_line_are_no_deeper_than_they_are_wide() {
        let needle = [
            DVec3::new(0.7338973164305829, 0.6043076100251108, -0.15473059734804798),
            DVec3::new(1.5484237986756915, 1.1255275258411659, -1.9502895486037333),
            DVec3::new(-0.1357366047745985, 0.04782414499155574, 1.7623083271956748),
        ];
        let other = [
            DVec3::new(0.12482856606967581, 0.21456121170755232, 1.1879130986877888),
            DVec3::new(-0.6971955552860006, -0.3114564840594478, 3.0),
            DVec3::new(-0.24403644859692666, -0.02147751273278989, 2.0010467331696344),
        ];
        let depth = penetration_depth(&needle, &other, 0.0).unwrap_or(0.0);
        assert!(depth < 4e-16, "{depth:e}");
    }

    #[test]
    fn overlaps_have_area() {
        let shifted = FLAT.map(|p| p + DVec3::new(1.0, 1.0, 0.0));
        let beside = FLAT.map(|p| DVec3::new(4.0, 4.0, 0.0) - p);
        assert!(interiors_overlap(&FLAT, &FLAT) && interiors_overlap(&FLAT, &shifted));
        assert!(!interiors_overlap(&FLAT, &beside), "they share an edge");
        assert!(overlap_depth(&FLAT, &shifted, 1e-9).is_some() && overlap_depth(&FLAT, &beside, 1e-9).is_none());
        let above = shifted.map(|p| p + DVec3::Z * 1e-3);
        assert!(!interiors_overlap(&FLAT, &above) && overlap_depth(&FLAT, &above, 1e-4).is_none());
        assert!(overlap_depth(&FLAT, &above, 2e-3).is_some());
    }
}
