//! Cutting ears until nothing is left.

use planecut_kernel::DVec2;
use planecut_kernel::sign::Sign;

use super::grid::Grid;
use super::{Boundary, orient};
use crate::ids::{Id, LineId, NodeId};
use crate::tolerances::EAR_NOISE;

/// How strict the test of an ear is. The exact points leave a strict one unless a bridge was placed badly within noise; then
/// the test is loosened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Care {
    /// Strictly convex, not of one line, and no other corner in it.
    Strict,
    /// The same but for noise: as good as convex, and no other corner deeper in it than noise goes. Boundaries whose
    /// corners lie within noise of one another need this: rounded, they cross themselves a little.
    Tolerant,
    /// Strictly convex and not of one line, whatever lies in it.
    Convex,
    /// Anything.
    Any,
}

impl Care {
    fn looser(self) -> Self {
        match self {
            Self::Strict => Self::Tolerant,
            Self::Tolerant => Self::Convex,
            Self::Convex | Self::Any => Self::Any,
        }
    }
}

/// Cuts boundaries into triangles, reusing its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Ears {
    ring: Vec<NodeId>,
    grid: Grid,
    triangles: Vec<[NodeId; 3]>,
}

impl Ears {
    /// Cuts the ring of `start` into triangles of nodes.
    pub(super) fn cut(&mut self, boundary: &mut Boundary<'_>, start: NodeId) -> &mut [[NodeId; 3]] {
        let Self { ring, grid, triangles } = self;
        ring.clear();
        ring.extend(boundary.ring(start));
        for &node in ring.iter() {
            boundary.classify(node);
        }
        grid.fill(boundary, ring);
        let noise = EAR_NOISE * ring.iter().map(|node| boundary.at(*node).abs().max_element()).fold(0.0, f64::max);
        triangles.clear();
        let mut left = ring.len();
        let mut node = start;
        let mut tried = 0;
        let mut care = Care::Strict;
        while left > 3 {
            if tried > left {
                care = care.looser();
                tried = 0;
            }
            let (before, after) = (boundary.previous(node), boundary.next(node));
            if boundary.is_ear([before, node, after], care, noise, grid) {
                triangles.push([before, node, after]);
                boundary.remove(node);
                left -= 1;
                tried = 0;
                care = Care::Strict;
                // going on two further spreads the ears instead of making fans
                node = boundary.next(after);
            } else {
                node = after;
                tried += 1;
            }
        }
        triangles.push([boundary.previous(node), node, boundary.next(node)]);
        triangles
    }
}

impl Boundary<'_> {
    fn remove(&mut self, node: NodeId) {
        let (before, after) = (self.previous(node), self.next(node));
        self.nodes[node.index()].removed = true;
        self.nodes[before.index()].next = after;
        self.nodes[after.index()].previous = before;
        self.classify(before);
        self.classify(after);
    }

    fn classify(&mut self, node: NodeId) {
        let reflex = self.turn(self.previous(node), node, self.next(node)) != Sign::Positive;
        self.nodes[node.index()].reflex = reflex;
    }

    /// A line of the boundary through both nodes.
    fn shared_line(&self, a: NodeId, c: NodeId) -> Option<LineId> {
        let at_c = self.nodes[c.index()].lines;
        self.nodes[a.index()].lines.into_iter().find(|line| at_c.contains(line))
    }

    /// Whether another corner of what is left lies between two on the same line, which rounding may hide.
    fn has_corner_between(&self, a: NodeId, c: NodeId, line: LineId) -> bool {
        let (from, along) = (self.at(a), self.at(c) - self.at(a));
        let length = along.length_squared();
        self.ring(c).any(|node| {
            let place = (self.at(node) - from).dot(along);
            node != a && node != c && self.nodes[node.index()].lines.contains(&line) && place > 0.0 && place < length
        })
    }

    fn is_ear(&self, [a, b, c]: [NodeId; 3], care: Care, noise: f64, grid: &Grid) -> bool {
        if care == Care::Any {
            return true;
        }
        if let Some(line) = self.shared_line(a, c) {
            let flat = self.nodes[b.index()].lines.contains(&line);
            if flat || care != Care::Convex && self.has_corner_between(a, c, line) {
                return false;
            }
        }
        if care == Care::Tolerant {
            let longest = self.at(a).distance(self.at(c)).max(self.at(a).distance(self.at(b)));
            let turn = orient(self.at(a), self.at(b), self.at(c));
            return turn >= -noise * longest && !self.holds_a_corner([a, b, c], noise, grid);
        }
        if self.nodes[b.index()].reflex {
            return false;
        }
        care == Care::Convex || !self.holds_a_corner([a, b, c], 0.0, grid)
    }

    /// Whether another corner of what is left lies in a triangle, deeper than `noise` where that is not zero; one at the
    /// same place as a corner of it does not count.
    fn holds_a_corner(&self, corners: [NodeId; 3], noise: f64, grid: &Grid) -> bool {
        let [p, q, r] = corners.map(|corner| self.at(corner));
        let (min, max) = (p.min(q).min(r), p.max(q).max(r));
        grid.any_in(min, max, |node| {
            let entry = &self.nodes[node.index()];
            let at = entry.corner.at;
            // without a branch for each
            let is_near = entry.reflex & !entry.removed & at.cmpge(min).all() & at.cmple(max).all();
            is_near
                && corners.iter().all(|corner| self.nodes[corner.index()].corner.point != entry.corner.point)
                && if noise > 0.0 { is_deep_in(p, q, r, at, noise) } else { self.is_in_triangle(corners, node) }
        })
    }
}

/// Whether `p` lies in a triangle, farther than `depth` from each of its sides.
fn is_deep_in(a: DVec2, b: DVec2, c: DVec2, p: DVec2, depth: f64) -> bool {
    let is_deep = |from: DVec2, to: DVec2| (to - from).perp_dot(p - from) > depth * from.distance(to);
    is_deep(a, b) && is_deep(b, c) && is_deep(c, a)
}
