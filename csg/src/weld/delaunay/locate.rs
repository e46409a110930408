//! Where a point lies among the triangles.

use planecut_kernel::DVec2;

use super::predicates::orient;
use super::{Delaunay, NONE};
use crate::closed_mesh::connectivity::next;

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Within the triangle of a half-edge.
    Within(u32),
    /// Within the edge of a half-edge.
    On(u32),
    /// At the start of a half-edge.
    At(u32),
}

impl Delaunay {
    /// Walks from triangle to triangle towards a point within the outer triangle. Which of two sides is asked first changes
    /// all the time: in a constrained triangulation a fixed order may go in circles (Devillers, Pion and Teillaud 2002).
    pub(super) fn locate(&mut self, at: DVec2) -> Place {
        let mut first = 3 * (self.last / 3);
        let mut entered = NONE;
        'walk: loop {
            self.turn = self.turn.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let start = (self.turn >> 16) % 3;
            let mut collinear = [NONE; 2];
            for k in 0..3 {
                let side = first + (start + k) % 3;
                if side == entered {
                    continue;
                }
                let turn = orient(self.at(self.from(side)), self.at(self.to(side)), at);
                if turn < 0.0 {
                    entered = self.twin(side);
                    assert!(entered != NONE, "sites lie within the outer triangle");
                    first = 3 * (entered / 3);
                    continue 'walk;
                }
                if turn == 0.0 {
                    collinear = [side, collinear[0]];
                }
            }
            self.last = first;
            return match collinear {
                [NONE, _] => Place::Within(first),
                [side, NONE] => Place::On(side),
                [one, other] => Place::At(if next(one) == other { other } else { one }),
            };
        }
    }
}
