//! A grid of the reflex corners of a boundary, so that an ear asks only those near it.

use planecut_kernel::DVec2;

use super::Boundary;

/// Below this many reflex corners a list does.
const SMALL: usize = 32;

/// The reflex corners by cell. Cutting ears never makes a convex corner reflex, so the grid is built once.
#[derive(Debug)]
pub(super) struct Grid {
    min: DVec2,
    scale: DVec2,
    columns: usize,
    rows: usize,
    /// Where the corners of each cell begin in `nodes`.
    starts: Vec<u32>,
    nodes: Vec<u32>,
}

impl Grid {
    pub(super) fn new(boundary: &Boundary<'_>, ring: &[u32]) -> Self {
        let reflex: Vec<u32> = ring.iter().copied().filter(|node| boundary.nodes[*node as usize].reflex).collect();
        let side = if reflex.len() <= SMALL { 1 } else { (reflex.len() as f64).sqrt() as usize };
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &node in &reflex {
            min = min.min(boundary.at(node));
            max = max.max(boundary.at(node));
        }
        let extent = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        let scale = DVec2::splat(side as f64) / extent;
        let mut grid = Self { min, scale, columns: side, rows: side, starts: Vec::new(), nodes: Vec::new() };
        if side == 1 {
            grid.starts = vec![0, reflex.len() as u32];
            grid.nodes = reflex;
            return grid;
        }
        let mut keyed: Vec<(usize, u32)> = reflex.iter().map(|node| (grid.cell(boundary.at(*node)), *node)).collect();
        keyed.sort_unstable();
        grid.starts = (0..=side * side).map(|cell| keyed.partition_point(|(k, _)| *k < cell) as u32).collect();
        grid.nodes = keyed.into_iter().map(|(_, node)| node).collect();
        grid
    }

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
    pub(super) fn any_in(&self, min: DVec2, max: DVec2, mut wanted: impl FnMut(u32) -> bool) -> bool {
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
