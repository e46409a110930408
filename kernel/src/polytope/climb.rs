//! The vertex that is extreme in a direction, by climbing along edges.

use super::IncrementalPolytope;
use super::store::{BEFORE, NEXT};
use crate::sign::{Row, Sign, certain_climb, orient3};

impl IncrementalPolytope {
    /// A vertex at which `normal·x` is largest, reached from `start` along ever better edges.
    ///
    /// Each step asks `orient3` only: leaving plane `a` of a vertex `(a, b, c)`, the edge runs along `−n_b × n_c`. Where
    /// no edge is better, the direction is a non-negative combination of the three normals (linear programming).
    pub(super) fn climb(&self, normal: &Row, start: u32) -> u32 {
        let mut vertex = start;
        loop {
            let rows = self.vertices.planes(vertex).map(|plane| self.row(plane));
            let better = match certain_climb(normal, rows) {
                Ok(better) => better,
                Err(()) => (0..3).find(|k| orient3(normal, rows[NEXT[*k]], rows[BEFORE[*k]]) == Sign::Negative),
            };
            match better {
                Some(k) => vertex = self.vertices.link(vertex, k).vertex(),
                None => return vertex,
            }
        }
    }
}
