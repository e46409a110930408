//! Vertices: corners joined around each fan.

use super::Pieces;
use super::names::place;
use crate::weld::cancel::UNPAIRED;

/// The vertices in use.
#[derive(Default)]
pub(super) struct Vertices {
    /// The vertex at the start of each half-edge.
    of_piece: Vec<u32>,
    /// How many half-edges begin at each; 0 for one that is free.
    corners: Vec<u32>,
    free: Vec<u32>,
}

impl Vertices {
    /// Joins the corners again around which something has changed.
    pub(super) fn update(&mut self, pieces: &mut Pieces) {
        self.of_piece.resize(pieces.half_edges.len(), UNPAIRED);
        for gone in &pieces.gone {
            self.leave(*gone);
        }
        pieces.turned.retain(|piece| !pieces.is_gone[*piece as usize]);
        for piece in &pieces.turned {
            self.leave(*piece);
        }
        for start in pieces.turned.drain(..) {
            if self.of_piece[start as usize] != UNPAIRED {
                continue;
            }
            let vertex = place(&mut self.corners, &mut self.free, 0);
            let mut piece = start;
            while self.of_piece[piece as usize] != vertex {
                self.leave(piece);
                self.of_piece[piece as usize] = vertex;
                self.corners[vertex as usize] += 1;
                piece = pieces.following[pieces.half_edges[piece as usize].twin as usize];
            }
        }
    }

    /// The vertex at the start of a half-edge.
    pub(super) fn at(&self, piece: u32) -> u32 {
        self.of_piece[piece as usize]
    }

    fn leave(&mut self, piece: u32) {
        let vertex = std::mem::replace(&mut self.of_piece[piece as usize], UNPAIRED);
        if vertex != UNPAIRED {
            let corners = &mut self.corners[vertex as usize];
            *corners -= 1;
            if *corners == 0 {
                self.free.push(vertex);
            }
        }
    }
}
