//! The vertex that is extreme in a direction, by climbing along edges.

use super::IncrementalPolytope;
use crate::sign::{Row, Sign, orient3};

impl IncrementalPolytope {
    /// A vertex at which `normal·x` is largest, reached from `start` along ever better edges.
    ///
    /// Each step asks `orient3` only: leaving plane `a` of a vertex `(a, b, c)`, the edge runs along `−n_b × n_c`. Where
    /// no edge is better, the direction is a non-negative combination of the three normals (linear programming).
    pub(super) fn climb(&self, normal: &Row, start: u32) -> u32 {
        let mut vertex = start;
        let mut came_from = vertex;
        'climb: loop {
            let planes = self.vertices.planes[vertex as usize];
            let neighbours = self.vertices.neighbours[vertex as usize];
            for k in 0..3 {
                if neighbours[k] == came_from {
                    continue;
                }
                let (b, c) = (planes[(k + 1) % 3], planes[(k + 2) % 3]);
                if orient3(normal, self.row(b), self.row(c)) == Sign::Negative {
                    came_from = vertex;
                    vertex = neighbours[k];
                    continue 'climb;
                }
            }
            return vertex;
        }
    }
}
