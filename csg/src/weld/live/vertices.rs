//! Vertices: corners joined around each fan.

use super::names::place;
use super::pieces::Pieces;
use crate::ids::{HalfEdgeId, Id, VertexId};

/// The vertices in use.
#[derive(Clone, Default)]
pub(super) struct Vertices {
    /// The vertex at the start of each half-edge.
    of_piece: Vec<VertexId>,
    /// How many half-edges begin at each; 0 for one that is free.
    corners: Vec<u32>,
    free: Vec<VertexId>,
}

impl Vertices {
    /// Joins the corners again around which something has changed.
    pub(super) fn update(&mut self, pieces: &mut Pieces) {
        self.of_piece.resize(pieces.half_edges.len(), VertexId::NONE);
        for gone in &pieces.gone {
            self.leave(*gone);
        }
        pieces.turned.retain(|piece| !pieces.is_gone[piece.index()]);
        for piece in &pieces.turned {
            self.leave(*piece);
        }
        for start in pieces.turned.drain(..) {
            if self.of_piece[start.index()] != VertexId::NONE {
                continue;
            }
            let vertex: VertexId = place(&mut self.corners, &mut self.free, 0);
            let mut piece = start;
            while self.of_piece[piece.index()] != vertex {
                self.leave(piece);
                self.of_piece[piece.index()] = vertex;
                self.corners[vertex.index()] += 1;
                piece = pieces.following[pieces.half_edges[piece.index()].twin.index()];
            }
        }
    }

    /// The vertex at the start of a half-edge.
    pub(super) fn at(&self, piece: HalfEdgeId) -> VertexId {
        self.of_piece[piece.index()]
    }

    fn leave(&mut self, piece: HalfEdgeId) {
        let vertex = std::mem::replace(&mut self.of_piece[piece.index()], VertexId::NONE);
        if vertex != VertexId::NONE {
            let corners = &mut self.corners[vertex.index()];
            *corners -= 1;
            if *corners == 0 {
                self.free.push(vertex);
            }
        }
    }
}
