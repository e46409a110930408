//! Cutting ears until nothing is left.

use super::grid::Grid;
use super::{Boundary, NO_LINE, in_triangle};

/// How strict the test of an ear is; loosened only where rounding left no strict one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Care {
    /// Strictly convex, not of one line, and no other corner in it.
    Strict,
    /// Convex and not of one line.
    Convex,
    /// Not of one line.
    Bent,
    /// Anything.
    Any,
}

impl Care {
    fn looser(self) -> Self {
        match self {
            Self::Strict => Self::Convex,
            Self::Convex => Self::Bent,
            Self::Bent | Self::Any => Self::Any,
        }
    }
}

impl Boundary {
    /// Cuts the ring of `start` into triangles of nodes.
    pub(super) fn cut_ears(&mut self, start: u32) -> Vec<[u32; 3]> {
        let ring: Vec<u32> = self.ring(start).collect();
        for &node in &ring {
            self.classify(node);
        }
        let grid = Grid::new(self, &ring);
        let mut triangles = Vec::with_capacity(ring.len() - 2);
        let mut left = ring.len();
        let mut node = start;
        let mut tried = 0;
        let mut care = Care::Strict;
        while left > 3 {
            if tried > left {
                care = care.looser();
                tried = 0;
            }
            let (before, after) = (self.previous(node), self.next(node));
            if self.is_ear([before, node, after], care, &grid) {
                triangles.push([before, node, after]);
                self.remove(node);
                left -= 1;
                tried = 0;
                care = Care::Strict;
                // going on two further spreads the ears instead of making fans
                node = self.next(after);
            } else {
                node = after;
                tried += 1;
            }
        }
        triangles.push([self.previous(node), node, self.next(node)]);
        triangles
    }

    fn remove(&mut self, node: u32) {
        let (before, after) = (self.previous(node), self.next(node));
        self.nodes[node as usize].removed = true;
        self.nodes[before as usize].next = after;
        self.nodes[before as usize].corner.line = NO_LINE;
        self.nodes[after as usize].previous = before;
        self.classify(before);
        self.classify(after);
    }

    fn classify(&mut self, node: u32) {
        let reflex = self.turn(self.previous(node), node, self.next(node)) <= 0.0;
        self.nodes[node as usize].reflex = reflex;
    }

    /// The lines on which the two edges at a node lie.
    fn lines_at(&self, node: u32) -> [u32; 2] {
        [self.nodes[self.previous(node) as usize].corner.line, self.nodes[node as usize].corner.line]
    }

    /// Whether the diagonal of an ear would run along a line of the boundary.
    fn is_along_line(&self, a: u32, c: u32) -> bool {
        let at_c = self.lines_at(c);
        self.lines_at(a).into_iter().any(|line| line != NO_LINE && at_c.contains(&line))
    }

    fn is_ear(&self, [a, b, c]: [u32; 3], care: Care, grid: &Grid) -> bool {
        if care == Care::Any {
            return true;
        }
        if self.is_along_line(a, c) {
            return false;
        }
        if care == Care::Bent {
            return true;
        }
        if self.nodes[b as usize].reflex {
            return false;
        }
        care == Care::Convex || !self.holds_a_corner([a, b, c], grid)
    }

    /// Whether another corner of what is left lies in a triangle; one at the same place as a corner of it does not count.
    fn holds_a_corner(&self, [a, b, c]: [u32; 3], grid: &Grid) -> bool {
        let (p, q, r) = (self.at(a), self.at(b), self.at(c));
        let (min, max) = (p.min(q).min(r), p.max(q).max(r));
        grid.any_in(min, max, |node| {
            let entry = &self.nodes[node as usize];
            let at = entry.corner.at;
            entry.reflex
                && !entry.removed
                && at.cmpge(min).all()
                && at.cmple(max).all()
                && at != p
                && at != q
                && at != r
                && in_triangle(p, q, r, at)
        })
    }
}
