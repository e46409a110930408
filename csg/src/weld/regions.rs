//! The regions of the boundary, and the half-edges of each in order.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;

use super::cancel::HalfEdge;
use super::pinches::PinchFinder;
use super::points::Points;
use crate::base::{by_group, counted, split_by, weighed_runs};
use crate::boundary::BoundaryEdge;
use crate::ids::{HalfEdgeId, Id, PointId, PointOnLine, RegionId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};

/// Least number of half-edges that a thread looks at in a row.
const PIECES_OF_CHUNK: usize = 512;

/// The regions of the boundary: oriented planes with a material.
pub(super) struct Regions {
    pub(super) planes: Vec<PlaneId>,
    pub(super) materials: Vec<MaterialId>,
    /// The places of the materials by name.
    ranks: Vec<u32>,
}

impl Regions {
    /// The regions, and the number of the region of each edge.
    pub(super) fn number(edges: &[BoundaryEdge], rank: &[u32]) -> (Self, Vec<RegionId>) {
        let key = |edge: &BoundaryEdge| (edge.face, rank[edge.material.0 as usize], edge.material);
        // the edges of a face follow one another
        let same_face = || edges.chunk_by(|a, b| (a.face, a.material) == (b.face, b.material));
        let mut keys: Vec<(PlaneId, u32, MaterialId)> = same_face().map(|edges| key(&edges[0])).collect();
        keys.sort_unstable();
        keys.dedup();
        let mut numbers = Vec::with_capacity(edges.len());
        for edges in same_face() {
            let number = keys.binary_search(&key(&edges[0])).expect("the region of each edge is among the keys");
            let number = RegionId::from_index(number);
            numbers.extend(std::iter::repeat_n(number, edges.len()));
        }
        let regions = Self {
            planes: keys.iter().map(|k| k.0).collect(),
            materials: keys.iter().map(|k| k.2).collect(),
            ranks: keys.iter().map(|k| k.1).collect(),
        };
        (regions, numbers)
    }

    /// Puts regions in an order that depends on the boundary alone, not on the bodies that it came from: by the first of
    /// their points, their planes and materials.
    pub(super) fn sort(&mut self, table: &PlaneTable, pieces: &mut [HalfEdge]) {
        let mut first = vec![PointId::NONE; self.planes.len()];
        for piece in pieces.iter() {
            let first = &mut first[piece.region.index()];
            *first = piece.from.min(*first);
        }
        let regions = RegionId::all(first.len());
        let mut order: Vec<(PointId, RegionId)> = first.into_iter().zip(regions.clone()).collect();
        let further = |region: RegionId| (table.order(self.planes[region.index()]), self.ranks[region.index()]);
        order.par_sort_unstable_by(|p, q| p.0.cmp(&q.0).then_with(|| further(p.1).cmp(&further(q.1))));
        let mut number = vec![RegionId::NONE; order.len()];
        for (new, (_, old)) in regions.zip(&order) {
            number[old.index()] = new;
        }
        self.planes = order.iter().map(|(_, old)| self.planes[old.index()]).collect();
        self.materials = order.iter().map(|(_, old)| self.materials[old.index()]).collect();
        self.ranks = order.iter().map(|(_, old)| self.ranks[old.index()]).collect();
        pieces.iter_mut().for_each(|piece| piece.region = number[piece.region.index()]);
    }
}

/// Half-edges, region by region.
pub(super) struct RegionPieces {
    /// Sorted by region and place.
    pub(super) pieces: Vec<HalfEdge>,
    /// Where those of each region that has any begin and end.
    pub(super) ranges: Vec<Range<usize>>,
}

impl RegionPieces {
    /// Sorts half-edges by region and place, keeping the pairs.
    pub(super) fn sort(table: &PlaneTable, points: &Points, planes: &[PlaneId], pieces: &[HalfEdge]) -> Self {
        Self::sort_and_search(table, points, planes, pieces, false).0
    }

    /// The same, and where corners lie inside edges of their region, by line.
    pub(super) fn with_pinches(
        table: &PlaneTable,
        points: &Points,
        planes: &[PlaneId],
        pieces: &[HalfEdge],
    ) -> (Self, Vec<PointOnLine>, Counts) {
        Self::sort_and_search(table, points, planes, pieces, true)
    }

    fn sort_and_search(
        table: &PlaneTable,
        points: &Points,
        planes: &[PlaneId],
        pieces: &[HalfEdge],
        searches: bool,
    ) -> (Self, Vec<PointOnLine>, Counts) {
        let (starts, mut order) =
            by_group(planes.len(), pieces.iter().map(|piece| piece.region.index()), HalfEdgeId::from_index);
        let ranges: Vec<Range<usize>> = starts
            .windows(2)
            .map(|ends| ends[0] as usize..ends[1] as usize)
            .filter(|range| !range.is_empty())
            .collect();
        let mut sorted: Vec<HalfEdge> = pieces.first().map_or_else(Vec::new, |first| vec![*first; pieces.len()]);
        let place: Vec<AtomicU32> = pieces.par_iter().with_min_len(1 << 14).map(|_| AtomicU32::new(0)).collect();
        let runs = weighed_runs(ranges.len(), PIECES_OF_CHUNK, |k| ranges[k].len());
        let lengths = || runs.iter().map(|run| ranges[run.end - 1].end - ranges[run.start].start);
        let (orders, slices) = (split_by(&mut order, lengths()), split_by(&mut sorted, lengths()));
        let jobs: Vec<_> = runs.iter().zip(orders.into_iter().zip(slices)).collect();
        let work = |(run, (order, sorted)): (&Range<usize>, (&mut [HalfEdgeId], &mut [HalfEdge]))| {
            let mut finder = PinchFinder::new(table, points);
            let (first, mut keys) = (ranges[run.start].start, Vec::new());
            for range in &ranges[run.clone()] {
                let own = range.start - first..range.end - first;
                sort_region(pieces, &mut order[own.clone()], &mut sorted[own.clone()], &mut keys);
                for (new, old) in range.clone().zip(&order[own.clone()]) {
                    place[old.index()].store(HalfEdgeId::from_index(new).number(), Ordering::Relaxed);
                }
                let region = &sorted[own];
                if searches {
                    finder.search(region, planes[region[0].region.index()]);
                }
            }
            finder.found
        };
        let parts: Vec<(Vec<PointOnLine>, Counts)> =
            jobs.into_par_iter().with_max_len(1).map(|job| counted(|| work(job))).collect();
        let new_place = |old: HalfEdgeId| HalfEdgeId::from_index(place[old.index()].load(Ordering::Relaxed) as usize);
        sorted.par_iter_mut().with_min_len(1 << 13).for_each(|piece| piece.twin = new_place(piece.twin));
        let (mut pinches, mut counts) = (Vec::new(), Counts::default());
        for (found, counted) in parts {
            pinches.extend(found);
            counts += counted;
        }
        pinches.sort_unstable();
        pinches.dedup();
        (Self { pieces: sorted, ranges }, pinches, counts)
    }
}

/// Sorts the half-edges of a region by their places; `keys` is a buffer.
fn sort_region(
    pieces: &[HalfEdge],
    order: &mut [HalfEdgeId],
    sorted: &mut [HalfEdge],
    keys: &mut Vec<(PointId, PointId, HalfEdgeId)>,
) {
    keys.clear();
    keys.extend(order.iter().map(|number| {
        let HalfEdge { from, to, .. } = pieces[number.index()];
        (from, to, *number)
    }));
    keys.sort_unstable();
    for ((order, sorted), (.., number)) in order.iter_mut().zip(sorted).zip(keys) {
        *order = *number;
        *sorted = pieces[number.index()];
    }
}
