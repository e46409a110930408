//! Cutting a face polygon into triangles on its own corners.

use glam::{DVec2, DVec3};

/// Most corners of a polygon that is not convex: cutting one takes time up to the square of this.
pub(super) const MAX_CONCAVE_CORNERS: usize = 10_000;

/// Appends the triangles of a polygon of at least three corners, whose indices are in range. No corner is added or dropped:
/// `n` corners give `n - 2` triangles, of which some have no area where corners lie on a line.
///
/// Convex polygons become a fan; others are cut ear by ear in the coordinate plane onto which they project best. Where that finds
/// no ear, the polygon crosses itself, and the rest becomes a fan.
///
/// Gives `false`, and appends nothing, for polygons that are not convex with more than [`MAX_CONCAVE_CORNERS`] corners.
pub(super) fn triangulate(corners: &[u32], positions: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> bool {
    if corners.len() == 3 {
        triangles.push([corners[0], corners[1], corners[2]]);
        return true;
    }
    let flat = projected(corners, positions);
    if !is_convex(&flat) {
        if corners.len() > MAX_CONCAVE_CORNERS {
            return false;
        }
        clip_ears(corners, &flat, triangles);
        return true;
    }
    fan(corners, triangles);
    true
}

fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    triangles.extend(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]));
}

/// The corners in a coordinate plane, counter-clockwise: the plane most nearly parallel to the polygon.
fn projected(corners: &[u32], positions: &[DVec3]) -> Vec<DVec2> {
    let origin = positions[corners[0] as usize];
    let points: Vec<DVec3> = corners.iter().map(|&v| positions[v as usize] - origin).collect();
    let area: DVec3 = points.windows(2).map(|pair| pair[0].cross(pair[1])).sum();
    let axis = (0..3).max_by(|&i, &j| area[i].abs().total_cmp(&area[j].abs())).unwrap_or(2);
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if area[axis] < 0.0 {
        (u, v) = (v, u);
    }
    points.iter().map(|p| DVec2::new(p[u], p[v])).collect()
}

/// Twice the signed area of a triangle, positive where it turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether a fan from the first corner is made of left turns alone, and every corner is one.
fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let corners_turn_left = (0..n).all(|i| turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0.0);
    corners_turn_left && (1..n - 1).all(|i| turn(flat[0], flat[i], flat[i + 1]) > 0.0)
}

fn clip_ears(corners: &[u32], flat: &[DVec2], triangles: &mut Vec<[u32; 3]>) {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    // Where the search for an ear starts: going on from the last one spreads the ears around.
    let mut start = 0;
    while left.len() > 3 {
        let n = left.len();
        let Some(ear) = (0..n).map(|k| (start + k) % n).find(|&i| is_ear(&left, i, flat)) else { break };
        triangles.push([(ear + n - 1) % n, ear, (ear + 1) % n].map(|i| corners[left[i]]));
        left.remove(ear);
        start = ear % left.len();
    }
    let rest: Vec<u32> = left.iter().map(|&i| corners[i]).collect();
    fan(&rest, triangles);
}

/// Whether the corner `i` of what is left turns left, and no other corner lies in its triangle or on its border.
fn is_ear(left: &[usize], i: usize, flat: &[DVec2]) -> bool {
    let n = left.len();
    let [a, b, c] = [(i + n - 1) % n, i, (i + 1) % n].map(|k| flat[left[k]]);
    if turn(a, b, c) <= 0.0 {
        return false;
    }
    // Corners that coincide with those of the ear belong to bridges to holes and are no obstacle.
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
        let corners: Vec<u32> = (0..outline.len() as u32).collect();
        let mut triangles = Vec::new();
        assert!(triangulate(&corners, &positions, &mut triangles));
        triangles.into_iter().map(|t| t.map(|v| outline[v as usize])).collect()
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
