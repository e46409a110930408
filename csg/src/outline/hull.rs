//! The convex hull of outlines.

use planecut_kernel::DVec2;
use robust::{Coord, orient2d};

use super::Outline;

impl Outline {
    /// The convex hull of all operands together, its corners those of the operands, without any on a straight line; nothing
    /// where there is none.
    ///
    /// Andrew's monotone chain (1979), with exact turns.
    #[must_use]
    pub fn hull(operands: &[Self]) -> Self {
        let mut points: Vec<DVec2> = operands.iter().flat_map(Self::loops).flatten().copied().collect();
        points.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        points.dedup();
        let mut corners = chain(points.iter());
        corners.extend(chain(points.iter().rev()));
        if corners.len() < 3 {
            return Self::empty();
        }
        Self { shapes: vec![vec![corners]] }
    }
}

/// The points that a walk along sorted points keeps when it only turns left, without the last.
fn chain<'a>(points: impl Iterator<Item = &'a DVec2>) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::new();
    for point in points {
        while let [.., p, q] = kept[..]
            && !turns_left(p, q, *point)
        {
            kept.pop();
        }
        kept.push(*point);
    }
    kept.pop();
    kept
}

/// Whether a way by three points turns left at the second, exactly.
pub(super) fn turns_left(p: DVec2, q: DVec2, r: DVec2) -> bool {
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(at(p), at(q), at(r)) > 0.0
}
