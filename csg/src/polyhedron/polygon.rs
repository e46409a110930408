//! Cutting a facet into triangles on its own corners.

use planecut_kernel::{DVec2, DVec3};

/// Triangles of a polygon of at least three corners, as places in it. No corner is added or dropped: `n` corners give `n - 2`
/// triangles, of which some have no area where corners lie on a line.
///
/// Convex polygons become a fan; others are cut ear by ear in the coordinate plane onto which they project best. Where that
/// finds no ear, the polygon crosses itself, and the rest becomes a fan.
pub(super) fn triangles(polygon: &[DVec3]) -> Vec<[usize; 3]> {
    let n = polygon.len();
    if n == 3 {
        return vec![[0, 1, 2]];
    }
    let flat = projected(polygon);
    if is_convex(&flat) {
        return (1..n - 1).map(|k| [0, k, k + 1]).collect();
    }
    clip_ears(&flat)
}

/// Twice the area of a polygon, along its normal.
pub(super) fn area_vector(polygon: &[DVec3]) -> DVec3 {
    let from_first = |p: &DVec3| *p - polygon[0];
    polygon[1..].windows(2).map(|pair| from_first(&pair[0]).cross(from_first(&pair[1]))).sum()
}

/// The corners in the coordinate plane most nearly parallel to the polygon, counter-clockwise.
fn projected(polygon: &[DVec3]) -> Vec<DVec2> {
    let area = area_vector(polygon);
    let axis = area.abs().max_position();
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if area[axis] < 0.0 {
        (u, v) = (v, u);
    }
    polygon.iter().map(|p| DVec2::new(p[u] - polygon[0][u], p[v] - polygon[0][v])).collect()
}

/// Twice the signed area of a triangle, positive where it turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether every corner and every triangle of a fan from the first corner turns left.
fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let corners_turn_left = (0..n).all(|i| turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0.0);
    corners_turn_left && (1..n - 1).all(|i| turn(flat[0], flat[i], flat[i + 1]) > 0.0)
}

fn clip_ears(flat: &[DVec2]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    let mut left: Vec<usize> = (0..flat.len()).collect();
    // going on from the last ear spreads the ears around
    let mut start = 0;
    while left.len() > 3 {
        let n = left.len();
        let Some(ear) = (0..n).map(|k| (start + k) % n).find(|&i| is_ear(&left, i, flat)) else { break };
        triangles.push([(ear + n - 1) % n, ear, (ear + 1) % n].map(|i| left[i]));
        left.remove(ear);
        start = ear % left.len();
    }
    triangles.extend((1..left.len() - 1).map(|k| [left[0], left[k], left[k + 1]]));
    triangles
}

/// Whether the corner `i` of what is left turns left, and no other corner lies in its triangle or on its border.
fn is_ear(left: &[usize], i: usize, flat: &[DVec2]) -> bool {
    let n = left.len();
    let [a, b, c] = [(i + n - 1) % n, i, (i + 1) % n].map(|k| flat[left[k]]);
    if turn(a, b, c) <= 0.0 {
        return false;
    }
    // corners that coincide with those of the ear belong to bridges to holes and are no obstacle
    let blocks =
        |p: DVec2| p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    left.iter().all(|&k| !blocks(flat[k]))
}
