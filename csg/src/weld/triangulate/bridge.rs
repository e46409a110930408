//! Bridges from holes to the loop around them.

use planecut_kernel::DVec2;
use planecut_kernel::sign::Sign;

use super::{Boundary, NO_LINE, Node, orient};

impl Boundary<'_> {
    /// Joins rings of holes to the ring of `outer`, from left to right, so that each finds the ones before it joined.
    pub(super) fn join_holes(&mut self, outer: u32, holes: &mut [u32]) {
        for hole in holes.iter_mut() {
            let by_place = |a: &u32, b: &u32| {
                let (p, q) = (self.at(*a), self.at(*b));
                p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
            };
            *hole = self.ring(*hole).min_by(by_place).unwrap_or(*hole);
        }
        holes.sort_by(|a, b| {
            let (p, q) = (self.at(*a), self.at(*b));
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
        });
        for &hole in holes.iter() {
            let bridge = self.visible_from(hole, outer);
            self.connect(bridge, hole);
        }
    }

    /// A node of the outer ring that sees `hole`, the leftmost node of a hole.
    ///
    /// The ray to the left meets an edge; its left end is seen unless some corner lies in the triangle between, and then
    /// the one at the smallest angle to the ray is.
    fn visible_from(&self, hole: u32, outer: u32) -> u32 {
        let from = self.at(hole);
        let mut nearest = f64::NEG_INFINITY;
        let mut seen = outer;
        for node in self.ring(outer) {
            let (p, q) = (self.at(node), self.at(self.next(node)));
            // left of the hole the boundary runs downward
            if p.y < from.y || q.y > from.y || p.y == q.y {
                continue;
            }
            let x = p.x + (from.y - p.y) / (q.y - p.y) * (q.x - p.x);
            if x <= from.x && x > nearest {
                nearest = x;
                seen = if p.x < q.x { node } else { self.next(node) };
            }
        }
        if nearest == f64::NEG_INFINITY {
            return outer;
        }
        self.first_in_sight(from, DVec2::new(nearest, from.y), seen, hole)
    }

    /// Among the corners in the triangle of the hole's corner, the hit point and `seen`, the one nearest to the ray.
    fn first_in_sight(&self, from: DVec2, hit: DVec2, seen: u32, hole: u32) -> u32 {
        let target = self.at(seen);
        let (b, c) = if target.y > from.y { (target, hit) } else { (hit, target) };
        let mut best = seen;
        let mut slope = f64::INFINITY;
        for node in self.ring(seen) {
            let p = self.at(node);
            if p.x >= from.x || p.x < target.x || !in_triangle(from, b, c, p) || !self.opens_towards(node, hole) {
                continue;
            }
            let angle = (p.y - from.y).abs() / (from.x - p.x);
            if angle < slope || angle == slope && p.x > self.at(best).x {
                slope = angle;
                best = node;
            }
        }
        best
    }

    /// Whether the inside at `node` lies towards `other`.
    fn opens_towards(&self, node: u32, other: u32) -> bool {
        let (before, after) = (self.previous(node), self.next(node));
        if self.turn(before, node, after) == Sign::Positive {
            self.turn(node, after, other) != Sign::Negative && self.turn(before, node, other) != Sign::Negative
        } else {
            self.turn(node, after, other) == Sign::Positive || self.turn(before, node, other) == Sign::Positive
        }
    }

    /// Doubles both ends of a bridge and splices the ring of `hole` into that of `bridge`.
    fn connect(&mut self, bridge: u32, hole: u32) {
        let (after_bridge, before_hole) = (self.next(bridge), self.previous(hole));
        let hole_copy = self.nodes.len() as u32;
        let bridge_copy = hole_copy + 1;
        let mut end = self.nodes[hole as usize];
        end.corner.line = NO_LINE;
        self.nodes.push(Node { previous: before_hole, next: bridge_copy, ..end });
        let start = self.nodes[bridge as usize];
        self.nodes.push(Node { previous: hole_copy, next: after_bridge, ..start });
        self.nodes[before_hole as usize].next = hole_copy;
        self.nodes[after_bridge as usize].previous = bridge_copy;
        self.nodes[bridge as usize].next = hole;
        self.nodes[bridge as usize].corner.line = NO_LINE;
        self.nodes[hole as usize].previous = bridge;
    }
}

/// Whether `p` lies in the closed triangle `a, b, c`, given counter-clockwise, in rounded coordinates.
fn in_triangle(a: DVec2, b: DVec2, c: DVec2, p: DVec2) -> bool {
    orient(a, b, p) >= 0.0 && orient(b, c, p) >= 0.0 && orient(c, a, p) >= 0.0
}
