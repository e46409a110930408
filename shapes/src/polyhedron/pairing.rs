//! Which triangles belong together at an edge: by the solid between them where an edge has more than two.

use std::cmp::Ordering;
use std::f64::consts::PI;

use planecut_csg::stages::{HalfEdges, NO_TWIN};
use planecut_kernel::DVec3;

use crate::tolerances::SAME_ANGLE;

/// One side of a triangle.
#[derive(Debug, Clone, Copy)]
struct Side {
    from: u32,
    to: u32,
    half_edge: u32,
}

impl Side {
    fn of(triangles: &[[u32; 3]], half_edge: u32) -> Self {
        let corners = triangles[half_edge as usize / 3];
        let k = half_edge as usize % 3;
        Self { from: corners[k], to: corners[(k + 1) % 3], half_edge }
    }

    fn ends(&self) -> (u32, u32) {
        (self.from.min(self.to), self.from.max(self.to))
    }

    fn is_forward(&self) -> bool {
        self.from < self.to
    }
}

/// The half-edge on the other side of each. Every edge must be used equally often in both directions.
pub(super) fn pair_half_edges(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<u32> {
    let half_edges = HalfEdges::new(points.len(), triangles);
    let mut mates = half_edges.twins();
    for half_edge in 0..mates.len() as u32 {
        let (a, b) = (half_edges.from(half_edge), half_edges.to(half_edge));
        if mates[half_edge as usize] != NO_TWIN || a > b {
            continue;
        }
        // the triangles of a facet with a spike can have sides from a vertex to itself
        let back = half_edges.between(b, a).filter(|_| a != b);
        let sides: Vec<Side> = half_edges.between(a, b).chain(back).map(|h| Side::of(triangles, h)).collect();
        let pairs = if let [a, b] = sides[..] { vec![(a, b)] } else { wedges(points, triangles, &sides) };
        for (a, b) in pairs {
            mates[a.half_edge as usize] = b.half_edge;
            mates[b.half_edge as usize] = a.half_edge;
        }
    }
    mates
}

/// Pairs of sides with solid between them. Turning about the edge against the sense of its forward direction, the solid begins
/// behind a forward side and ends at a backward one.
fn wedges(points: &[DVec3], triangles: &[[u32; 3]], sides: &[Side]) -> Vec<(Side, Side)> {
    let mut around: Vec<(f64, Side)> = sides.iter().map(|side| (angle(points, triangles, side), *side)).collect();
    around.sort_by(|(p, _), (q, _)| q.total_cmp(p));
    for same in around.chunk_by_mut(|(p, _), (q, _)| p - q <= SAME_ANGLE) {
        same.sort_by(|(_, a), (_, b)| touching(a, b));
    }
    // beginning where most have ended, each end finds its beginning
    let mut depth = 0i64;
    let depths = around.iter().enumerate().map(|(k, (_, side))| {
        depth += if side.is_forward() { 1 } else { -1 };
        (depth, k)
    });
    let start = depths.min().map_or(0, |(_, k)| k + 1);
    around.rotate_left(start % sides.len().max(1));
    let (mut open, mut pairs) = (Vec::new(), Vec::new());
    for (_, side) in around {
        if side.is_forward() {
            open.push(side);
        } else if let Some(begin) = open.pop() {
            pairs.push((begin, side));
        }
    }
    pairs
}

/// Of facets that lie on each other, what ends comes before what begins.
fn touching(a: &Side, b: &Side) -> Ordering {
    a.is_forward().cmp(&b.is_forward()).then(a.half_edge.cmp(&b.half_edge))
}

/// The direction of a triangle about its side, counter-clockwise about the side's forward direction.
fn angle(points: &[DVec3], triangles: &[[u32; 3]], side: &Side) -> f64 {
    let at = |v: u32| points[v as usize];
    let (low, high) = side.ends();
    let along = (at(high) - at(low)).normalize_or_zero();
    let u = along.any_orthonormal_vector();
    let v = along.cross(u);
    let apex = triangles[side.half_edge as usize / 3][(side.half_edge as usize + 2) % 3];
    let to_apex = at(apex) - at(low);
    let angle = to_apex.dot(v).atan2(to_apex.dot(u));
    // a half turn is one angle, not two
    if angle > PI - SAME_ANGLE { -PI } else { angle }
}

/// Gives each fan of triangles around a vertex a vertex of its own, and the positions of all.
pub(super) fn split_vertices(points: &[DVec3], triangles: &mut [[u32; 3]], mates: &[u32]) -> Vec<DVec3> {
    let mut fan = vec![u32::MAX; 3 * triangles.len()];
    let mut split = Vec::with_capacity(points.len());
    for start in 0..fan.len() {
        if fan[start] != u32::MAX {
            continue;
        }
        let vertex = split.len() as u32;
        split.push(points[triangles[start / 3][start % 3] as usize]);
        let mut corner = start;
        while fan[corner] == u32::MAX {
            fan[corner] = vertex;
            // beyond the side that ends here, the corner is where the mate begins
            let before = corner - corner % 3 + (corner + 2) % 3;
            corner = mates[before] as usize;
        }
    }
    for (triangle, fans) in triangles.iter_mut().zip(fan.chunks_exact(3)) {
        triangle.copy_from_slice(fans);
    }
    split
}
