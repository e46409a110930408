//! Regions of space between facets, as far as edges tell: sides of facets with nothing between them around an edge belong to one region.

use planecut_kernel::sign::Counts;

use crate::arrangement::Arrangement;
use crate::arrangement::around::{Around, half_planes};
use crate::arrangement::facets::{Facets, Side};
use crate::base::{DisjointSets, by_group, map_chunks};
use crate::ids::{FacetId, Id, number32};

/// One of the two sides of a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FacetSide {
    pub(super) facet: FacetId,
    /// Whether it is the side from which the facet's triangle is counter-clockwise.
    pub(super) is_above: bool,
}

impl FacetSide {
    fn number(self) -> u32 {
        2 * self.facet.number() + u32::from(self.is_above)
    }

    fn of_number(number: u32) -> Self {
        Self { facet: FacetId::from_index(number as usize / 2), is_above: number % 2 == 1 }
    }

    /// The other side of the facet.
    pub(super) fn across(self) -> Self {
        Self { is_above: !self.is_above, ..self }
    }
}

/// Regions of space, numbered from 0. Several numbers may belong to one region, the boundary of which has several parts.
#[derive(Debug)]
pub(super) struct Regions {
    /// The region on each side of each facet.
    of_side: Vec<u32>,
    /// The sides of each region: where they begin, and they.
    starts: Vec<u32>,
    sides: Vec<u32>,
}

impl Regions {
    pub(super) fn new(arrangement: &Arrangement<'_>, facets: &Facets) -> Self {
        let edges = 0..number32(facets.edge_ends.len());
        let crowded: Vec<u32> = edges.clone().filter(|edge| facets.sides_at(*edge).len() > 2).collect();
        let work = |edges: &[u32]| {
            let mut joined = Vec::new();
            for edge in edges {
                let sides = facets.sides_at(*edge);
                let mut members = half_planes(arrangement, facets, sides);
                Around::of_side(arrangement, &sides[0]).sort(&mut members);
                let after = members[1..].iter().chain(&members[..1]);
                joined.extend(members.iter().zip(after).map(|((_, this), (_, next))| between(this, next)));
            }
            joined
        };
        let (parts, _): (Vec<Vec<[u32; 2]>>, Counts) = map_chunks(&crowded, 64, work);
        let mut sets = DisjointSets::new(2 * facets.len());
        for edge in edges {
            if let sides @ ([_] | [_, _]) = facets.sides_at(edge) {
                let (first, last) = (&sides[0], &sides[sides.len() - 1]);
                for [a, b] in [between(first, last), between(last, first)] {
                    sets.join(a, b);
                }
            }
        }
        parts.iter().flatten().for_each(|[a, b]| sets.join(*a, *b));
        let (of_side, count) = sets.numbered();
        let (starts, sides) = by_group(count, of_side.len(), |side| of_side[side] as usize, number32);
        Self { of_side, starts, sides }
    }

    /// The number of regions.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The region on a side of a facet.
    pub(super) fn of(&self, side: FacetSide) -> usize {
        self.of_side[side.number() as usize] as usize
    }

    /// The sides of facets that bound a region.
    pub(super) fn sides(&self, region: usize) -> impl Iterator<Item = FacetSide> + '_ {
        let [start, end] = [region, region + 1].map(|k| self.starts[k] as usize);
        self.sides[start..end].iter().map(|number| FacetSide::of_number(*number))
    }
}

/// The sides of two facets that bound the space between them, where one follows the other counter-clockwise around an edge: from a facet that
/// runs forward one comes out above it.
fn between(this: &Side, next: &Side) -> [u32; 2] {
    let [this, next] = [(this, this.is_forward), (next, !next.is_forward)]
        .map(|(side, is_above)| FacetSide { facet: side.facet, is_above }.number());
    [this, next]
}
