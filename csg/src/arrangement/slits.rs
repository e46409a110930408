//! Slits: segments that a cell has on both sides, so that its boundary runs along them both ways.
//!
//! A cut that ends within a triangle does not divide it, and the face is whole again without it. Other facets may end there, though: then the
//! face takes part in their order around the edge, as one sheet on either side of it. Where a single face passes through an edge, neighbours are
//! found across it; where two do, they cross in the edge, and are cut along it.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::Arranged;
use super::facets::{FacetKind, Side};
use super::fill::area;
use crate::ids::{FacetId, Id, PointId, number32};

/// Edges, by their ends in ascending order.
pub(super) type Edges = FxHashSet<[PointId; 2]>;

impl Arranged<'_> {
    /// Whether a facet is part of the boundary.
    fn is_kept(&self, values: &[bool], facet: FacetId) -> bool {
        let [above, below] = [&self.sheets.above, &self.sheets.below].map(|states| states[facet.index()]);
        values[above.index()] != values[below.index()]
    }

    /// The facets of the boundary that lie on both sides of an edge, of those that are at it.
    fn slit<'b>(&'b self, values: &'b [bool], sides: &'b [Side]) -> impl Iterator<Item = FacetId> + 'b {
        // sides of one facet follow one another
        let both = sides.windows(2).filter(|pair| pair[0].facet == pair[1].facet).map(|pair| pair[0].facet);
        both.filter(|facet| matches!(self.facets.kind(*facet), FacetKind::Cell(_)) && self.is_kept(values, *facet))
    }

    /// The facets of the boundary on both sides of the edge between two points.
    pub(super) fn slit_at(&self, values: &[bool], ends: [PointId; 2]) -> Vec<FacetId> {
        self.facets.edge_between(ends).map_or_else(Vec::new, |sides| self.slit(values, sides).collect())
    }

    /// The edges in which facets of the boundary cross that lie on both sides of them.
    pub(super) fn crossed(&self, values: &[bool]) -> Edges {
        let edges = (0..number32(self.facets.edge_ends.len())).map(|edge| self.facets.sides_at(edge));
        let is_crossed = |sides: &&[Side]| sides.len() >= 4 && self.slit(values, sides).nth(1).is_some();
        edges.filter(is_crossed).map(|sides| sides[0].ends).collect()
    }
}

/// The loops that are left of one without the segments that it runs along both ways, but for those that stay; the one around the others first.
pub(super) fn without_slits(
    points: &[PointId],
    at: impl Fn(PointId) -> DVec3,
    stays: impl Fn(PointId, PointId) -> bool,
) -> Vec<Vec<PointId>> {
    let count = points.len();
    let to = |k: usize| points[(k + 1) % count];
    let mut place: FxHashMap<(PointId, PointId), usize> = FxHashMap::default();
    place.extend((0..count).map(|k| ((points[k], to(k)), k)));
    let back = |k: usize| place.get(&(to(k), points[k])).copied().filter(|_| !stays(points[k], to(k)));
    let back: Vec<Option<usize>> = (0..count).map(back).collect();
    if back.iter().all(Option::is_none) {
        return vec![points.to_vec()];
    }
    let mut next: Vec<usize> = (0..count).map(|k| (k + 1) % count).collect();
    let mut previous: Vec<usize> = (0..count).map(|k| (k + count - 1) % count).collect();
    for (k, back) in back.iter().enumerate() {
        let Some(back) = back.filter(|back| *back > k) else { continue };
        for (one, other) in [(k, back), (back, k)] {
            let (before, after) = (previous[one], next[other]);
            (next[before], previous[after]) = (after, before);
        }
    }
    let mut is_done: Vec<bool> = back.iter().map(Option::is_some).collect();
    let mut loops = Vec::new();
    for start in 0..count {
        let mut members = Vec::new();
        let mut k = start;
        while !std::mem::replace(&mut is_done[k], true) {
            members.push(points[k]);
            k = next[k];
        }
        if !members.is_empty() {
            loops.push(members);
        }
    }
    loops.sort_by(|a, b| area(b, &at).total_cmp(&area(a, &at)));
    loops
}
