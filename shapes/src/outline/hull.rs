//! The convex hull of outlines.

use planecut_kernel::DVec2;
use robust::{Coord, orient2d};

use super::{Outline, largest_coordinate};
use crate::tolerances::COLLINEAR_CORNER;

impl Outline {
    /// The convex hull of all operands together, its corners those of the operands, without any on a straight line but for rounding;
    /// nothing where there is none.
    #[must_use]
    pub fn hull(operands: &[Self]) -> Self {
        let points: Vec<DVec2> = operands.iter().flat_map(Self::loops).flatten().copied().collect();
        let mut corners: Vec<DVec2> = corners_of_hull(&points).into_iter().map(|k| points[k]).collect();
        straighten(&mut corners);
        if corners.len() < 3 {
            return Self::empty();
        }
        Self { shapes: vec![vec![corners]] }
    }
}

/// Leaves out the corners of a convex polygon that are on a straight line but for rounding.
fn straighten(corners: &mut Vec<DVec2>) {
    let least = COLLINEAR_CORNER * largest_coordinate(&*corners);
    let mut k = 0;
    while k < corners.len() && corners.len() > 3 {
        let n = corners.len();
        let (before, at, after) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
        let chord = after - before;
        if chord.perp_dot(at - before).abs() <= least * chord.length() {
            corners.remove(k);
        } else {
            k += 1;
        }
    }
}

/// The numbers of the corners of the convex hull of points, counter-clockwise from the least, without any on a straight line;
/// fewer than three where there is no hull.
///
/// Andrew's monotone chain (1979), with exact turns.
pub(crate) fn corners_of_hull(points: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|p, q| points[*p].x.total_cmp(&points[*q].x).then(points[*p].y.total_cmp(&points[*q].y)));
    let mut corners = chain(points, order.iter());
    corners.extend(chain(points, order.iter().rev()));
    corners
}

/// The points that a walk along sorted points keeps when it only turns left, without the last.
fn chain<'a>(points: &[DVec2], walk: impl Iterator<Item = &'a usize>) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for number in walk {
        while let [.., p, q] = kept[..]
            && turn(points[p], points[q], points[*number]) <= 0.0
        {
            kept.pop();
        }
        kept.push(*number);
    }
    kept.pop();
    kept
}

/// Positive where a way by three points turns left at the second, negative where it turns right, exactly.
pub(crate) fn turn(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(at(p), at(q), at(r))
}
