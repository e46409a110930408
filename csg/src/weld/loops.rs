//! Chains the half-edges of each region into loops.
//!
//! Where several loops meet in a point, the next edge is the first outgoing one clockwise from the reversed incoming one:
//! the turn stays tight around the inside, so that each wedge of the region has a corner of its own.

use planecut_kernel::sign::Sign;

use super::WeldError;
use super::cancel::HalfEdge;
use crate::plane_table::{PlaneId, PlaneTable};

/// The half-edge that follows each half-edge around its region; half-edges must be ordered by region.
pub(super) fn following(table: &PlaneTable, planes: &[PlaneId], pieces: &[HalfEdge]) -> Result<Vec<u32>, WeldError> {
    let mut following = vec![0; pieces.len()];
    let mut outgoing: Vec<(u32, u32)> = Vec::new();
    let mut base = 0;
    for region in pieces.chunk_by(|a, b| a.region == b.region) {
        let plane = planes[region[0].region as usize];
        outgoing.clear();
        outgoing.extend(region.iter().enumerate().map(|(k, piece)| (piece.from, (base + k) as u32)));
        outgoing.sort_unstable();
        for (k, piece) in region.iter().enumerate() {
            let start = outgoing.partition_point(|(from, _)| *from < piece.to);
            let candidates = outgoing[start..].iter().take_while(|(from, _)| *from == piece.to).map(|(_, next)| *next);
            let next = candidates.reduce(|best, other| {
                let earlier = is_earlier(table, plane, piece, &pieces[other as usize], &pieces[best as usize]);
                if earlier { other } else { best }
            });
            following[base + k] = next.ok_or(WeldError::Open { from: piece.from, to: piece.to })?;
        }
        base += region.len();
    }
    Ok(following)
}

/// Whether outgoing edge `a` comes before `b`, turning clockwise from the reversed `incoming` edge.
///
/// Directions are `n × e`, edge normals turned by a right angle, so the edge normals are compared instead.
fn is_earlier(table: &PlaneTable, plane: PlaneId, incoming: &HalfEdge, a: &HalfEdge, b: &HalfEdge) -> bool {
    let quarter = |piece: &HalfEdge| {
        if piece.line == incoming.line {
            // straight on is half a turn from the reversed edge; straight back is a whole one
            return if piece.forward == incoming.forward { 1 } else { 3 };
        }
        match table.orient3(plane, incoming.edge.flipped(), piece.edge) {
            Sign::Negative => 0,
            Sign::Zero => 1,
            Sign::Positive => 2,
        }
    };
    let (at_a, at_b) = (quarter(a), quarter(b));
    at_a < at_b || at_a == at_b && table.orient3(plane, a.edge, b.edge) == Sign::Negative
}
