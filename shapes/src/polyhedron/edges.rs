//! Which pieces of a part share edges, and where the solid is folded inward.

use planecut_csg::stages::DisjointSets;

use super::part::{Part, Points};

/// The pieces of a part in connected sheets, and the edges at which they are not convex.
pub(super) struct Edges {
    /// For each piece the number of its sheet.
    pub(super) sheet_of: Vec<u32>,
    /// How many sheets there are.
    pub(super) sheets: usize,
    /// The ends of each reflex edge and its two pieces.
    pub(super) reflex: Vec<([u32; 2], [u32; 2])>,
}

impl Edges {
    pub(super) fn of(part: &Part, points: &Points<'_>) -> Self {
        let mut sides: Vec<((u32, u32), u32)> = Vec::with_capacity(4 * part.pieces.len());
        for (number, piece) in (0..).zip(&part.pieces) {
            sides.extend(piece.edges().map(|(a, b)| ((a.min(b), a.max(b)), number)));
        }
        sides.sort_unstable();
        let mut sets = DisjointSets::new(part.pieces.len());
        let mut reflex = Vec::new();
        for at_edge in sides.chunk_by(|a, b| a.0 == b.0) {
            at_edge.windows(2).for_each(|pair| sets.join(pair[0].1, pair[1].1));
            // where sheets touch it is not known which pieces are neighbours
            if let &[((a, b), p), (_, q)] = at_edge
                && is_reflex(part, points, p, q)
            {
                reflex.push(([a, b], [p, q]));
            }
        }
        let (sheet_of, sheets) = sets.numbered();
        Self { sheet_of, sheets, reflex }
    }
}

/// Whether one of two neighbours reaches beyond the other's plane.
fn is_reflex(part: &Part, points: &Points<'_>, p: u32, q: u32) -> bool {
    let [p, q] = [p, q].map(|piece| &part.pieces[piece as usize]);
    let reaches = |p: &super::part::Piece, q: &super::part::Piece| p.corners.iter().any(|v| points.is_beyond(*v, q));
    p.plane != q.plane && (reaches(p, q) || reaches(q, p))
}
