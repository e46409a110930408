//! Cutting a facet into triangles on its own corners.

use planecut_kernel::{DVec2, DVec3};

/// Most corners of a polygon that is not convex: cutting one takes time up to the square of this.
pub const MAX_CONCAVE_CORNERS: usize = 10_000;

/// Triangles of a polygon of at least three corners, as places in it. No corner is added or dropped: `n` corners give `n - 2`
/// triangles, of which some have no area where corners lie on a line.
///
/// Convex polygons become a fan; others are cut ear by ear in the coordinate plane onto which they project best. Where that
/// finds no ear, the polygon crosses itself, and the rest becomes a fan.
///
/// Gives `None` for polygons that are not convex with more than [`MAX_CONCAVE_CORNERS`] corners.
///
/// ```
/// use planecut_shapes::polyhedron::triangulate;
/// use planecut_kernel::DVec3;
///
/// let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 5.0));
/// let triangles = triangulate(&arrow).expect("few corners");
/// // the diagonal runs from the tip to the notch
/// assert!(triangles.len() == 2 && triangles.iter().all(|t| t.contains(&1) && t.contains(&3)));
/// ```
#[must_use]
pub fn triangulate(polygon: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let n = polygon.len();
    if n <= 3 {
        return Some(if n == 3 { vec![[0, 1, 2]] } else { Vec::new() });
    }
    let flat = projected(polygon);
    if is_convex(&flat) {
        return Some((1..n - 1).map(|k| [0, k, k + 1]).collect());
    }
    (n <= MAX_CONCAVE_CORNERS).then(|| clip_ears(&flat))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangulates a polygon in a slanted plane and gives the triangles back in two dimensions.
    fn cut(outline: &[DVec2]) -> Vec<[DVec2; 3]> {
        let positions: Vec<DVec3> = outline.iter().map(|p| DVec3::new(p.x, p.y, 2.0 * p.x - p.y)).collect();
        let triangles = triangulate(&positions).expect("few corners");
        triangles.into_iter().map(|t| t.map(|v| outline[v])).collect()
    }

    fn area(outline: &[DVec2]) -> f64 {
        let next = outline.iter().cycle().skip(1);
        outline.iter().zip(next).map(|(p, q)| p.perp_dot(*q)).sum::<f64>() / 2.0
    }

    #[test]
    fn triangles_cover_the_polygon_without_overlap() {
        // A random star-shaped outline with integer corners has no crossings; areas in integers are exact.
        let seed = 0x5eed_3001u64;
        let mut state = seed;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        for case in 0..500 {
            let n = 4 + below(12) as usize;
            let outline: Vec<DVec2> = (0..n)
                .map(|k| {
                    let radius = (100 + below(1000)) as f64;
                    (DVec2::from_angle(k as f64 / n as f64 * std::f64::consts::TAU) * radius).round()
                })
                .collect();
            let triangles = cut(&outline);
            assert_eq!(triangles.len(), n - 2, "seed {seed:#x} case {case}");
            // All turn left and their areas add up: then they cannot overlap or leave the polygon.
            assert!(
                triangles.iter().all(|[a, b, c]| turn(*a, *b, *c) >= 0.0),
                "seed {seed:#x} case {case}: {outline:?}"
            );
            let sum: f64 = triangles.iter().map(|t| area(t)).sum();
            assert_eq!(sum, area(&outline), "seed {seed:#x} case {case}: {outline:?}");
        }
    }

    #[test]
    fn corners_on_a_side_stay_corners() {
        let square =
            [(0, 0), (1, 0), (2, 0), (2, 2), (1, 2), (0, 2)].map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        let triangles = cut(&square);
        assert_eq!(triangles.len(), 4);
        assert!(triangles.iter().all(|[a, b, c]| turn(*a, *b, *c) > 0.0), "none is flat: {triangles:?}");
    }

    #[test]
    fn a_polygon_that_crosses_itself_keeps_its_corners() {
        let bow = [(0, 0), (2, 2), (2, 0), (0, 2)].map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        assert_eq!(cut(&bow).len(), 2);
    }
}
