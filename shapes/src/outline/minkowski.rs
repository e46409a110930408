//! The Minkowski sum of outlines.
//!
//! Two convex loops are merged by the directions of their sides. Otherwise the sum is the union of the parallelograms that
//! each two sides span, and of each operand moved to a corner of each part of the other, which fills the middle: nothing of
//! a hole is lost or filled that the sum leaves or fills. The points of the sum are made in the whole numbers of the grid, so
//! that sides moved by different corners stay parallel exactly.

use planecut_csg::SNAP_TOLERANCE;
use planecut_kernel::DVec2;

use super::boolean::Grid;
use super::hull::turn;
use super::{Outline, signed_area};
use crate::parameter::{ShapeError, pieces};

impl Outline {
    /// All sums of a point of one outline and a point of the other; nothing where one of them is.
    ///
    /// # Errors
    /// [`ShapeError::TooLarge`] where the product of the numbers of corners is more than is accepted.
    pub fn minkowski(&self, other: &Self) -> Result<Self, ShapeError> {
        if self.is_empty() || other.is_empty() {
            return Ok(Self::empty());
        }
        if let (Some(own), Some(others)) = (self.convex_loop(), other.convex_loop()) {
            return Ok(Self { shapes: vec![vec![merged(own, others)]] });
        }
        let count = |outline: &Self| outline.loops().map(Vec::len).sum::<usize>() as u64;
        pieces(count(self) * count(other))?;
        let mut grid = Grid::of_sums(self, other);
        let mut loops = Vec::new();
        for (own, others) in self.loops().flat_map(|own| other.loops().map(move |others| (own, others))) {
            grid.add_parallelograms(own, others, &mut loops);
        }
        for (own, others) in [(self, other), (other, self)] {
            for at in own.shapes().iter().map(|shape| shape[0][0]) {
                loops.extend(others.loops().map(|corners| grid.moved(corners, at)));
            }
        }
        Ok(grid.union(&loops).without_slivers())
    }

    /// Its loop where it is convex, and turns in each corner.
    pub(crate) fn convex_loop(&self) -> Option<&[DVec2]> {
        let [shape] = &self.shapes[..] else { return None };
        let [corners] = &shape[..] else { return None };
        let n = corners.len();
        let turns = |k: usize| turn(corners[k], corners[(k + 1) % n], corners[(k + 2) % n]) > 0.0;
        // a loop that does not cross itself turns around once
        (signed_area(corners) > 0.0 && (0..n).all(turns)).then_some(corners)
    }
}

/// The sum of two convex loops; sides of the same direction become one.
fn merged(a: &[DVec2], b: &[DVec2]) -> Vec<DVec2> {
    let (a, b) = (from_lowest(a), from_lowest(b));
    let (mut i, mut j) = (0, 0);
    let mut corners = Vec::with_capacity(a.len() + b.len());
    while i < a.len() || j < b.len() {
        corners.push(a[i % a.len()] + b[j % b.len()]);
        let turn = if i == a.len() {
            -1.0
        } else if j == b.len() {
            1.0
        } else {
            turn_of_sides([a[i], a[(i + 1) % a.len()]], [b[j], b[(j + 1) % b.len()]])
        };
        i += usize::from(turn >= 0.0);
        j += usize::from(turn <= 0.0);
    }
    corners
}

/// A loop that begins at its lowest corner, the leftmost of these.
fn from_lowest(corners: &[DVec2]) -> Vec<DVec2> {
    let order = |a: &DVec2, b: &DVec2| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x));
    let lowest = (0..corners.len()).min_by(|a, b| order(&corners[*a], &corners[*b])).unwrap_or_default();
    let mut corners = corners.to_vec();
    corners.rotate_left(lowest);
    corners
}

/// Above 0 where the second side turns left of the first one, below where it turns right; both go up, or both down, or the one
/// that goes up comes first.
fn turn_of_sides(a: [DVec2; 2], b: [DVec2; 2]) -> f64 {
    let rises = |side: [DVec2; 2]| side[1].y > side[0].y || side[1].y == side[0].y && side[1].x > side[0].x;
    match (rises(a), rises(b)) {
        (true, false) => 1.0,
        (false, true) => -1.0,
        _ => cross(a, b),
    }
}

/// The cross product of two sides; 0 where they differ by no more than rounding.
fn cross(a: [DVec2; 2], b: [DVec2; 2]) -> f64 {
    let (a, b) = (a[1] - a[0], b[1] - b[0]);
    let cross = a.perp_dot(b);
    if cross.abs() <= SNAP_TOLERANCE * a.length() * b.length() { 0.0 } else { cross }
}
