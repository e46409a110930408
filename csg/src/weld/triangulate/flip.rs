//! Flips diagonals towards the Delaunay criterion (Lawson 1977): fewer slivers, nicer meshes, the same boundary.

use super::{Node, orient};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{Id, NodeId, number32};
use crate::tolerances::{DELAUNAY_MARGIN, FLAT_TRIANGLE};
use planecut_kernel::DVec2;

/// No half-edge, no diagonal.
const NONE: u32 = u32::MAX;

/// A diagonal by its ends, the smaller one first, and its number.
type Numbered = (NodeId, NodeId, u32);

/// Improves triangulations, reusing its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Flips {
    /// For each half-edge, three for each triangle, the number of its diagonal.
    diagonal_of: Vec<u32>,
    /// The two half-edges of each diagonal.
    sides: Vec<[u32; 2]>,
    /// For each node the half-edge along the other side of the edge that leaves it, as ears are cut.
    behind: Vec<u32>,
    queue: Vec<Numbered>,
}

impl Flips {
    /// Improves triangles of nodes, counter-clockwise, in place: ears in the order in which they were cut from one ring, each beginning with
    /// the node before its tip. Boundary edges and bridges between copies of one node stay.
    pub(super) fn improve(&mut self, nodes: &[Node], triangles: &mut [[NodeId; 3]]) {
        if triangles.len() < 2 {
            return;
        }
        self.find_diagonals(nodes.len(), triangles);
        self.queue.clear();
        for (number, [half_edge, _]) in (0..).zip(&self.sides) {
            let (a, b) = ends(triangles, *half_edge);
            self.queue.push((a.min(b), a.max(b), number));
        }
        self.queue.sort_unstable();
        // Lawson's flips end; the cap guards against a cycle that rounding could make.
        let mut budget = 20 * triangles.len();
        while let Some((a, b, number)) = self.queue.pop() {
            let [one, other] = self.sides[number as usize];
            // a diagonal that was flipped meanwhile has other ends
            let (left, right) = match ends(triangles, one) {
                found if found == (a, b) => (one, other),
                found if found == (b, a) => (other, one),
                _ => continue,
            };
            let (c, d) = (apex(triangles, left), apex(triangles, right));
            let at = |node: NodeId| nodes[node.index()].corner.at;
            if budget > 0 && should_flip(at(a), at(b), at(c), at(d)) {
                budget -= 1;
                self.flip(triangles, number, [left, right], [a, b, c, d]);
            }
        }
    }

    /// Numbers the edges that two triangles share.
    fn find_diagonals(&mut self, nodes: usize, triangles: &[[NodeId; 3]]) {
        self.diagonal_of.clear();
        self.diagonal_of.resize(3 * triangles.len(), NONE);
        self.sides.clear();
        self.behind.clear();
        self.behind.resize(nodes, NONE);
        for (first, [a, b, c]) in (0..).step_by(3).zip(triangles) {
            // the last triangle is all that was left of the ring
            let is_last = first as usize + 3 == self.diagonal_of.len();
            let left = [(*a, first), (*b, first + 1), (*c, first + 2)];
            for (from, half_edge) in left.into_iter().take(if is_last { 3 } else { 2 }) {
                let behind = self.behind[from.index()];
                if behind != NONE {
                    debug_assert_eq!(ends(triangles, behind).1, from, "both sides of a diagonal have the same ends");
                    self.diagonal_of[half_edge as usize] = number32(self.sides.len());
                    self.diagonal_of[behind as usize] = number32(self.sides.len());
                    self.sides.push([behind, half_edge]);
                }
            }
            self.behind[a.index()] = first + 2;
        }
    }

    /// Makes the diagonal `a b` of the quadrilateral `a d b c`, its half-edge in the triangle of `c` first, the diagonal `c d`.
    fn flip(&mut self, triangles: &mut [[NodeId; 3]], number: u32, halves: [u32; 2], corners: [NodeId; 4]) {
        let ([left, right], [a, b, c, d]) = (halves, corners);
        let around = [next(right), previous(right), next(left), previous(left)];
        let diagonals = around.map(|half_edge| self.diagonal_of[half_edge as usize]);
        let (left, right) = (left / 3, right / 3);
        triangles[left as usize] = [a, d, c];
        triangles[right as usize] = [d, b, c];
        let places = [3 * left, 3 * right, 3 * right + 1, 3 * left + 2];
        for ((diagonal, from), to) in diagonals.into_iter().zip(around).zip(places) {
            self.diagonal_of[to as usize] = diagonal;
            if diagonal != NONE {
                let sides = &mut self.sides[diagonal as usize];
                sides[usize::from(sides[1] == from)] = to;
            }
        }
        self.diagonal_of[(3 * left + 1) as usize] = number;
        self.diagonal_of[(3 * right + 2) as usize] = number;
        self.sides[number as usize] = [3 * left + 1, 3 * right + 2];
        for ((p, q), diagonal) in [(a, d), (d, b), (b, c), (c, a)].into_iter().zip(diagonals) {
            if diagonal != NONE {
                self.queue.push((p.min(q), p.max(q), diagonal));
            }
        }
    }
}

/// The nodes between which a half-edge runs.
fn ends(triangles: &[[NodeId; 3]], half_edge: u32) -> (NodeId, NodeId) {
    let corners = &triangles[half_edge as usize / 3];
    (corners[half_edge as usize % 3], corners[(half_edge as usize + 1) % 3])
}

/// The node across from a half-edge.
fn apex(triangles: &[[NodeId; 3]], half_edge: u32) -> NodeId {
    triangles[half_edge as usize / 3][(half_edge as usize + 2) % 3]
}
/// Whether the diagonal `a b` of the quadrilateral `a d b c` should become `c d`.
pub(super) fn should_flip(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let longest =
        a.distance_squared(b).max(c.distance_squared(d)).max(a.distance_squared(c)).max(b.distance_squared(d));
    // without a branch for each
    if (orient(a, d, c) <= FLAT_TRIANGLE * longest) | (orient(d, b, c) <= FLAT_TRIANGLE * longest) {
        return false;
    }
    // in-circle of a, b, c at d, by the sum of the opposite angles: flip where it exceeds half a turn
    let (u, v) = (a - c, b - c);
    let (s, t) = (b - d, a - d);
    let (cos_c, sin_c) = (u.dot(v), u.perp_dot(v));
    let (cos_d, sin_d) = (s.dot(t), s.perp_dot(t));
    let value = sin_c * cos_d + cos_c * sin_d;
    value < -DELAUNAY_MARGIN * longest * longest
}
