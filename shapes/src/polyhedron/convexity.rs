//! Whether a surface is clearly not that of one convex body: what is cheap to know before that is tried.

use planecut_csg::stages::{HalfEdges, NO_TWIN, next, previous};
use planecut_kernel::DVec3;

use super::precision::Precision;

/// Room for what a corner may be off in the edges that meet in it.
const MARGIN: f64 = 8.0;

/// Whether triangles may be the surface of one convex body: all their edges are paired, and at none of them does the surface clearly turn inward,
/// whatever the rounding of corners. Linear.
pub(super) fn may_be_convex(points: &[DVec3], triangles: &[[u32; 3]], precision: Precision) -> bool {
    let slack = precision.slack(points).into_iter().fold(0.0, f64::max);
    let center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let reaches = |triangle: &[u32; 3], point: DVec3| {
        let [a, b, c] = triangle.map(|corner| points[corner as usize]);
        is_clearly_above([a, b, c], point, slack)
    };
    // most that is not convex is told by its middle
    if triangles.iter().any(|triangle| reaches(triangle, center)) {
        return false;
    }
    let half_edges = HalfEdges::new(points.len(), triangles);
    let twins = half_edges.twins();
    (0..).zip(&twins).all(|(half_edge, &twin): (u32, &u32)| {
        let is_paired = twin != NO_TWIN;
        is_paired
            && (twin > half_edge || {
                let apex = points[half_edges.from(previous(twin)) as usize];
                debug_assert_eq!(half_edges.from(next(twin)), half_edges.from(half_edge));
                !reaches(&triangles[half_edge as usize / 3], apex)
            })
    })
}

/// Whether a point lies above the plane of three others also where each of the four is off by as much as `slack`.
fn is_clearly_above([a, b, c]: [DVec3; 3], point: DVec3, slack: f64) -> bool {
    let (u, v, w) = (b - a, c - a, point - a);
    let (p, q, r) = (u.length(), v.length(), w.length());
    u.cross(v).dot(w) > MARGIN * slack * (p * q + q * r + r * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube whose lid is drawn in or out in its middle.
    fn with_lid(height: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut points: Vec<DVec3> =
            (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
        points.push(DVec3::new(0.5, 0.5, height));
        let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        triangles.extend([[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]);
        (points, triangles)
    }

    #[test]
    fn what_turns_inward_is_told_from_what_is_off_by_rounding() {
        let is = |height: f64| {
            let (points, triangles) = with_lid(height);
            may_be_convex(&points, &triangles, Precision::Single)
        };
        assert!(is(1.5) && is(1.0) && is(1.0 - 1e-8));
        assert!(!is(0.99) && !is(0.2));
    }

    #[test]
    fn two_bodies_are_not_one() {
        let (points, triangles) = with_lid(1.5);
        let moved = points.iter().map(|point| *point + 3.0 * DVec3::X);
        let both: Vec<DVec3> = points.iter().copied().chain(moved).collect();
        let count = points.len() as u32;
        let second = triangles.iter().map(|triangle| triangle.map(|corner| corner + count));
        let all: Vec<[u32; 3]> = triangles.iter().copied().chain(second).collect();
        assert!(!may_be_convex(&both, &all, Precision::Double));
        assert!(!may_be_convex(&points, &triangles[1..], Precision::Double), "an open edge");
    }
}
