//! The vertex that is extreme in a direction, by climbing along edges.

use super::IncrementalPolytope;
use super::store::{BEFORE, Farthest, NEXT};
use crate::sign::{Ascent, Probe, Row, Sign, Slope, orient3};

/// Indices counted on from any of the three.
const INDEX: [usize; 5] = [0, 1, 2, 0, 1];

impl IncrementalPolytope {
    /// A vertex at which `normal·x` is largest, reached from `start` along ever better edges.
    ///
    /// Each step asks for `orient3` only: leaving plane `a` of a vertex `(a, b, c)`, the edge runs along `−n_b × n_c`. Where
    /// no edge is better, the direction is a non-negative combination of the three normals (linear programming).
    pub(super) fn climb(&self, normal: &Row, start: u32) -> u32 {
        let mut vertex = start;
        loop {
            vertex = match self.climb_quickly(normal, vertex) {
                Ok(top) => return top,
                Err(open) => open,
            };
            let rows = self.vertices.planes(vertex).map(|plane| self.row(plane));
            match (0..3).find(|k| orient3(normal, rows[NEXT[*k]], rows[BEFORE[*k]]) == Sign::Negative) {
                Some(k) => vertex = self.vertices.link(vertex, k).vertex(),
                None => return vertex,
            }
        }
    }

    /// The vertex at which `normal·x` is largest, where only one is the best for certain: the one that seems to be, or where a climb from there
    /// ends. Any climb ends there, wherever it begins.
    #[inline(always)]
    pub(super) fn certain_top(&self, normal: &Row, farthest: Farthest) -> Option<u32> {
        let seemingly = farthest.vertex;
        let rows = self.vertices.planes(seemingly).map(|plane| self.row(plane));
        if farthest.is_certain || Ascent::is_top(normal, rows) {
            Some(seemingly)
        } else {
            self.climb_quickly(normal, seemingly).ok()
        }
    }

    /// The first vertex outside of `plane` on a climb from `start`, which is inside, or else the top; and whether it is outside. `normal` is the row of the plane.
    /// Mostly a vertex is outside before the top.
    pub(super) fn climb_outside(&self, normal: &Row, start: u32, plane: u32, probe: &Probe) -> (u32, bool) {
        let (mut ascent, mut slope) = Ascent::begin(normal, self.vertices.planes(start).map(|plane| self.row(plane)));
        let (mut vertex, mut entered) = (start, 0);
        while let Slope::Up(k) = slope {
            let link = self.vertices.link(vertex, INDEX[entered + k]);
            (vertex, entered) = (link.vertex(), link.index());
            if self.violates(vertex, plane, probe) {
                return (vertex, true);
            }
            slope = ascent.step(normal, self.row(self.vertices.planes(vertex)[entered]));
        }
        if slope == Slope::Top {
            return (vertex, false);
        }
        let top = self.climb(normal, vertex);
        (top, self.violates(top, plane, probe))
    }

    /// Climbs while the filter decides; else the vertex at which it does not.
    fn climb_quickly(&self, normal: &Row, start: u32) -> Result<u32, u32> {
        let (mut ascent, mut slope) = Ascent::begin(normal, self.vertices.planes(start).map(|plane| self.row(plane)));
        let mut vertex = start;
        let mut entered = 0;
        loop {
            let k = match slope {
                Slope::Top => return Ok(vertex),
                Slope::Open => return Err(vertex),
                Slope::Up(k) => k,
            };
            // `k` counts from the plane that the last edge did not lie on
            let link = self.vertices.link(vertex, INDEX[entered + k]);
            (vertex, entered) = (link.vertex(), link.index());
            slope = ascent.step(normal, self.row(self.vertices.planes(vertex)[entered]));
        }
    }
}
