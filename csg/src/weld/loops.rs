//! Chains the half-edges of each region into loops.
//!
//! Where several loops meet in a point, the next edge is the first outgoing one clockwise from the reversed incoming one:
//! the turn stays tight around the inside, so that each wedge of the region has a corner of its own.

use planecut_kernel::sign::Sign;

use super::WeldError;
use super::cancel::HalfEdge;
use crate::ids::{HalfEdgeId, Id, PointId};
use crate::plane_table::{PlaneId, PlaneTable};

/// Finds the half-edge that follows each half-edge around one region, numbered from `base`; those that begin at one point follow one
/// another in `region`, and `first` gives the place of the first of them, or that of any other where there is none.
pub(super) fn follow(
    table: &PlaneTable,
    plane: PlaneId,
    region: &[HalfEdge],
    base: usize,
    first: impl Fn(PointId) -> usize,
    following: &mut [HalfEdgeId],
) -> Result<(), WeldError> {
    for (piece, following) in region.iter().zip(following) {
        let start = first(piece.to);
        let candidates = (start..region.len()).map(|k| (k, &region[k])).take_while(|(_, next)| next.from == piece.to);
        let next = first_clockwise(table, plane, piece, candidates).ok_or_else(|| WeldError::open(piece))?;
        *following = HalfEdgeId::from_index(base + next);
    }
    Ok(())
}

/// What follows a half-edge among those that begin where it ends, each given with a number; nothing where there is none.
pub(super) fn first_clockwise<'a, T>(
    table: &PlaneTable,
    plane: PlaneId,
    incoming: &HalfEdge,
    candidates: impl Iterator<Item = (T, &'a HalfEdge)>,
) -> Option<T> {
    let earlier = |best: (T, &'a HalfEdge), other: (T, &'a HalfEdge)| {
        if is_earlier(table, plane, incoming, other.1, best.1) { other } else { best }
    };
    candidates.reduce(earlier).map(|(number, _)| number)
}

/// Whether outgoing edge `a` comes before `b`, turning clockwise from the reversed `incoming` edge.
///
/// Directions are `n × e`, edge normals turned by a right angle, so the edge normals are compared instead.
fn is_earlier(table: &PlaneTable, plane: PlaneId, incoming: &HalfEdge, a: &HalfEdge, b: &HalfEdge) -> bool {
    let quarter = |piece: &HalfEdge| {
        if piece.line() == incoming.line() {
            // straight on is half a turn from the reversed edge; straight back is a whole one
            return if piece.is_forward() == incoming.is_forward() { 1 } else { 3 };
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
