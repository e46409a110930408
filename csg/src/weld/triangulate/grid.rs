//! A grid of the reflex corners of a boundary, so that an ear asks only those near it.

use planecut_kernel::DVec2;

use super::Boundary;
use crate::base::push_if;
use crate::ids::{Id, NodeId, number32};

/// Below this many reflex corners a list does.
const SMALL: usize = 32;

/// The reflex corners by cell. Cutting ears never makes a convex corner reflex, so the grid is filled once for each boundary.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    min: DVec2,
    scale: DVec2,
    columns: usize,
    rows: usize,
    /// Where the corners of each cell begin in `nodes`.
    starts: Vec<u32>,
    nodes: Vec<NodeId>,
}

impl Grid {
    /// Replaces what is there by the reflex corners of a ring.
    pub(super) fn fill(&mut self, boundary: &Boundary<'_>, ring: &[NodeId]) {
        self.starts.clear();
        self.nodes.clear();
        for node in ring {
            push_if(&mut self.nodes, *node, boundary.nodes[node.index()].reflex);
        }
        let count = self.nodes.len();
        let side = if count <= SMALL { 1 } else { count.isqrt() };
        (self.columns, self.rows) = (side, side);
        if side == 1 {
            self.starts.extend([0, number32(count)]);
            return;
        }
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &node in &self.nodes {
            min = min.min(boundary.at(node));
            max = max.max(boundary.at(node));
        }
        let extent = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        (self.min, self.scale) = (min, DVec2::splat(side as f64) / extent);
        let mut keyed: Vec<(usize, NodeId)> =
            self.nodes.iter().map(|node| (self.cell(boundary.at(*node)), *node)).collect();
        keyed.sort_unstable();
        self.starts.extend((0..=side * side).map(|cell| number32(keyed.partition_point(|(k, _)| *k < cell))));
        self.nodes.clear();
        self.nodes.extend(keyed.into_iter().map(|(_, node)| node));
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    fn place(&self, at: DVec2) -> (usize, usize) {
        let cell = (at - self.min) * self.scale;
        // `as` saturates, so that what lies outside falls into the nearest cell
        ((cell.x as usize).min(self.columns - 1), (cell.y as usize).min(self.rows - 1))
    }

    fn cell(&self, at: DVec2) -> usize {
        let (x, y) = self.place(at);
        y * self.columns + x
    }

    /// Whether `wanted` holds for some corner in the cells of a box.
    pub(super) fn any_in(&self, min: DVec2, max: DVec2, mut wanted: impl FnMut(NodeId) -> bool) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        if self.starts.len() == 2 {
            return self.nodes.iter().any(|node| wanted(*node));
        }
        let ((x0, y0), (x1, y1)) = (self.place(min), self.place(max));
        (y0..=y1).any(|y| {
            let (start, end) = (self.starts[y * self.columns + x0], self.starts[y * self.columns + x1 + 1]);
            self.nodes[start as usize..end as usize].iter().any(|node| wanted(*node))
        })
    }
}
