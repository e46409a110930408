//! The regions of the boundary, and the half-edges of each in order.

use std::cmp::Reverse;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;

use super::cancel::HalfEdge;
use super::nest::Projection;
use super::pinches::PinchFinder;
use super::points::Points;
use crate::base::{
    Workers, by_group, concat_owned, made_by_place, map_owned, number_of_two, repeated, runs_apart, sort_by_number,
    sort_few, split_by, takes_much_memory, weighed_runs,
};
use crate::boundary::BoundaryEdge;
use crate::ids::{HalfEdgeId, Id, PointId, PointOnLine, RegionId, number32};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};

/// Least number of boundary edges or half-edges that a thread looks at in a row.
const PIECES_OF_CHUNK: usize = 512;

/// Least number of regions that a thread looks at in a row.
const REGIONS_OF_CHUNK: usize = 1 << 11;

/// The regions of the boundary: oriented planes with a material.
pub(super) struct Regions {
    pub(super) planes: Vec<PlaneId>,
    pub(super) materials: Vec<MaterialId>,
    /// The places of the materials by name.
    ranks: Vec<u32>,
}

impl Regions {
    /// The regions, and the number of the region of each edge.
    pub(super) fn number<'a>(edges: &'a [BoundaryEdge], rank: &[u32]) -> (Self, Vec<RegionId>) {
        type Key = (PlaneId, u32, MaterialId);
        let key = |edges: &[BoundaryEdge]| {
            let BoundaryEdge { face, material, .. } = edges[0];
            (face, rank[material.0 as usize], material)
        };
        // the edges of a face follow one another
        let is_apart = |a: &BoundaryEdge, b: &BoundaryEdge| (a.face, a.material) != (b.face, b.material);
        let same_face = |edges: &'a [BoundaryEdge]| edges.chunk_by(move |a, b| !is_apart(a, b));
        let runs = runs_apart(edges, PIECES_OF_CHUNK, is_apart);
        let keys_of = |run: usize| same_face(runs[run]).map(key).collect::<Vec<Key>>();
        let mut keys = concat_owned(planecut_parallel::map_parts(runs.len(), keys_of));
        sort_by_number(&mut keys, |(plane, rank, _)| number_of_two(plane.sided_index(), *rank));
        keys.dedup();
        // those of a plane are few
        let mut first_of_plane = vec![0_u32; keys.last().map_or(0, |key| key.0.index() as usize + 1)];
        for (number, key) in keys.iter().enumerate().rev() {
            first_of_plane[key.0.index() as usize] = number32(number);
        }
        let mut numbers = repeated(edges.len(), || RegionId::NONE);
        let parts = split_by(&mut numbers, runs.iter().map(|run| run.len()));
        runs.par_iter().zip(parts).with_max_len(1).for_each(|(run, mut numbers)| {
            for edges in same_face(run) {
                let key = key(edges);
                let first = first_of_plane[key.0.index() as usize] as usize;
                let place = keys[first..].iter().position(|other| *other == key);
                let number = first + place.expect("the region of each edge is among the keys");
                let own = numbers.split_off_mut(..edges.len()).expect("there is room for each edge");
                own.fill(RegionId::from_index(number));
            }
        });
        let regions = Self {
            planes: keys.iter().map(|k| k.0).collect(),
            materials: keys.iter().map(|k| k.2).collect(),
            ranks: keys.iter().map(|k| k.1).collect(),
        };
        (regions, numbers)
    }

    /// Puts regions in an order that depends on the boundary alone, not on the bodies that it came from: by the first of
    /// their points, their planes and materials.
    pub(super) fn sort(&mut self, table: &PlaneTable, by_region: &mut ByRegion) {
        let first = |region: RegionId| by_region.of_region(region).first().map_or(PointId::NONE, |piece| piece.0);
        let placed = |region: &RegionId| (first(*region), *region);
        let mut order: Vec<(PointId, RegionId)> =
            by_region.order.par_iter().with_min_len(REGIONS_OF_CHUNK).map(placed).collect();
        sort_by_number(&mut order, |(first, region)| number_of_two(first.number(), region.number()));
        let further =
            |(_, region): &(PointId, RegionId)| (table.order(self.planes[region.index()]), self.ranks[region.index()]);
        // at a corner three regions meet at least, of all of which it may be the first
        order.par_chunk_by_mut(|p, q| p.0 == q.0).for_each(|alike| {
            if alike.len() > 1 {
                alike.sort_by_cached_key(further);
            }
        });
        by_region.order = order.into_iter().map(|(_, region)| region).collect();
        let order = || by_region.order.par_iter().with_min_len(REGIONS_OF_CHUNK);
        self.planes = order().map(|old| self.planes[old.index()]).collect();
        self.materials = order().map(|old| self.materials[old.index()]).collect();
        self.ranks = order().map(|old| self.ranks[old.index()]).collect();
    }
}

/// Where a half-edge begins, and its number.
type PlacedPiece = (PointId, HalfEdgeId);

/// Half-edges, listed by region, those of each sorted by their places.
pub(super) struct ByRegion {
    /// Where the half-edges of each region begin in the list, and their end.
    starts: Vec<u32>,
    members: Vec<PlacedPiece>,
    /// The regions in their order. Half-edges keep the numbers that regions had before they were sorted.
    order: Vec<RegionId>,
}

impl ByRegion {
    /// Lists half-edges whose regions are in the order of their numbers.
    pub(super) fn of(pieces: &[HalfEdge], regions: usize) -> Self {
        let order: Vec<RegionId> = RegionId::all(regions).collect();
        let region = |piece: usize| pieces[piece].region.index();
        let placed = |piece: usize| (pieces[piece].from, HalfEdgeId::from_index(piece));
        let (starts, mut members) = by_group(order.len(), pieces.len(), region, placed);
        let lengths: Vec<usize> = starts.windows(2).map(|ends| (ends[1] - ends[0]) as usize).collect();
        let runs = weighed_runs(lengths.len(), PIECES_OF_CHUNK, |region| lengths[region]);
        let parts = split_by(&mut members, runs.iter().map(|run| lengths[run.clone()].iter().sum()));
        let sort_region = |members: &mut [PlacedPiece]| {
            // they are listed in the order of their numbers
            sort_few(members, &|(from, _): &PlacedPiece| u64::from(from.number()));
            for alike in members.chunk_by_mut(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
                alike.sort_unstable_by_key(|(_, number)| (pieces[number.index()].to, *number));
            }
        };
        let sort = |(run, part): (&Range<usize>, &mut [PlacedPiece])| {
            split_by(part, lengths[run.clone()].iter().copied()).into_iter().for_each(sort_region);
        };
        runs.par_iter().zip(parts).with_max_len(1).for_each(sort);
        Self { starts, members, order }
    }

    fn of_region(&self, region: RegionId) -> &[PlacedPiece] {
        let region = region.index();
        &self.members[self.starts[region] as usize..self.starts[region + 1] as usize]
    }

    /// What it takes to put the half-edges in order.
    fn into_order(self) -> Order {
        let count = self.order.len();
        let (mut regions, mut ranges, mut end) = (Vec::with_capacity(count), Vec::with_capacity(count), 0);
        for (new, old) in RegionId::all(self.order.len()).zip(&self.order) {
            let count = self.of_region(*old).len();
            if count > 0 {
                regions.push(new);
                ranges.push(end..end + count);
                end += count;
            }
        }
        let runs = weighed_runs(ranges.len(), PIECES_OF_CHUNK, |k| ranges[k].len());
        let mut order = Order { regions, ranges, runs, old: repeated(end, || HalfEdgeId::NONE) };
        let parts = split_by(&mut order.old, lengths_of(&order.ranges, &order.runs));
        let fill = |(run, part): (&Range<usize>, &mut [HalfEdgeId])| {
            let members = order.regions[run.clone()].iter().flat_map(|new| self.of_region(self.order[new.index()]));
            part.iter_mut().zip(members).for_each(|(old, (.., number))| *old = *number);
        };
        order.runs.par_iter().zip(parts).with_max_len(1).for_each(fill);
        order
    }
}

/// The order of half-edges by region and place.
struct Order {
    /// The regions that have any, and where those of each begin and end.
    regions: Vec<RegionId>,
    ranges: Vec<Range<usize>>,
    /// Regions that a thread looks at in a row.
    runs: Vec<Range<usize>>,
    /// The number that each half-edge had before.
    old: Vec<HalfEdgeId>,
}

/// How many half-edges the regions of each run have.
fn lengths_of(ranges: &[Range<usize>], runs: &[Range<usize>]) -> impl Iterator<Item = usize> {
    runs.iter().map(|run| ranges[run.end - 1].end - ranges[run.start].start)
}

/// Half-edges, region by region.
pub(super) struct RegionPieces {
    /// Sorted by region and place.
    pub(super) pieces: Vec<HalfEdge>,
    /// Where those of each region that has any begin and end.
    pub(super) ranges: Vec<Range<usize>>,
}

impl RegionPieces {
    /// Sorts half-edges by region and place, keeping the pairs; and tells where corners lie inside edges of their region, by line.
    pub(super) fn sort(
        table: &PlaneTable,
        points: &Points,
        planes: &[PlaneId],
        mut pieces: Vec<HalfEdge>,
        by_region: ByRegion,
    ) -> (Self, Vec<PointOnLine>, Counts) {
        let Order { regions, ranges, runs, old } = by_region.into_order();
        let mut sorted: Vec<HalfEdge> = Vec::new();
        if takes_much_memory::<HalfEdge>(pieces.len()) {
            permute(&mut pieces, &old);
            std::mem::swap(&mut sorted, &mut pieces);
        } else if let Some(first) = pieces.first() {
            sorted = repeated(pieces.len(), || *first);
        }
        let place = repeated(old.len(), || AtomicU32::new(0));
        let slices = split_by(&mut sorted, lengths_of(&ranges, &runs));
        // the longest ones first, so that no thread comes to one of them when the others have nothing left to do
        let mut jobs: Vec<(&Range<usize>, &mut [HalfEdge])> = runs.iter().zip(slices).collect();
        jobs.sort_by_key(|(_, sorted)| Reverse(sorted.len()));
        let finders = Workers::new(|| PinchFinder::new(table, points));
        let work = |(run, sorted): (&Range<usize>, &mut [HalfEdge]), finder: &mut PinchFinder<'_>| {
            let first = ranges[run.start].start;
            // planes and half-edges lie anywhere in memory: in loops of their own several are on their way at once
            let projection = |number: &RegionId| Projection::of_plane(table, planes[number.index()]);
            let projections: Vec<Projection> = regions[run.clone()].iter().map(projection).collect();
            for (number, range) in regions[run.clone()].iter().zip(&ranges[run.clone()]) {
                let sorted = &mut sorted[range.start - first..range.end - first];
                for ((sorted, old), new) in sorted.iter_mut().zip(&old[range.clone()]).zip(range.clone()) {
                    // where there is one list, it is there already
                    let piece = pieces.get(old.index()).copied().unwrap_or(*sorted);
                    *sorted = HalfEdge { region: *number, ..piece };
                    place[old.index()].store(HalfEdgeId::from_index(new).number(), Ordering::Relaxed);
                }
            }
            for (projection, range) in projections.into_iter().zip(&ranges[run.clone()]) {
                finder.search(&sorted[range.start - first..range.end - first], projection);
            }
            std::mem::take(&mut finder.found)
        };
        let (parts, counts) = map_owned(jobs, |job| finders.with(|finder| work(job, finder)));
        drop((pieces, old));
        let new_place = |old: HalfEdgeId| HalfEdgeId::from_index(place[old.index()].load(Ordering::Relaxed) as usize);
        sorted.par_iter_mut().with_min_len(1 << 11).for_each(|piece| piece.twin = new_place(piece.twin));
        let mut pinches = parts.concat();
        pinches.sort_unstable();
        pinches.dedup();
        (Self { pieces: sorted, ranges }, pinches, counts)
    }
}

/// Puts half-edges in the order of their `old` numbers, but for their regions: a part of each at a time, so that they are not there twice.
fn permute(pieces: &mut [HalfEdge], old: &[HalfEdgeId]) {
    let first = |piece: &HalfEdge| (piece.along, piece.edge, piece.from);
    permute_part(pieces, old, first, |piece, part| (piece.along, piece.edge, piece.from) = part);
    let second = |piece: &HalfEdge| (piece.to, piece.twin);
    permute_part(pieces, old, second, |piece, part| (piece.to, piece.twin) = part);
}

fn permute_part<P: Send>(
    pieces: &mut [HalfEdge],
    old: &[HalfEdgeId],
    get: impl Fn(&HalfEdge) -> P + Sync,
    set: impl Fn(&mut HalfEdge, P) + Sync,
) {
    let parts: Vec<P> = made_by_place(old.len(), 1 << 13, |new| get(&pieces[old[new].index()]));
    pieces.par_iter_mut().with_min_len(1 << 13).zip(parts).for_each(|(piece, part)| set(piece, part));
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::ids::{DirectedLine, LineId};

    #[test]
    fn half_edges_change_places_in_one_list() {
        for seed in 0..20 {
            let mut rng = Rng::spread(seed);
            let count = rng.below(5_000);
            let mut number = || rng.below(1 << 20);
            let made = |_| HalfEdge {
                region: RegionId::from_index(7),
                along: DirectedLine::new(LineId::from_index(number()), number() % 2 == 0),
                edge: PlaneId::of_index(number32(number())),
                from: PointId::from_index(number()),
                to: PointId::from_index(number()),
                twin: HalfEdgeId::from_index(number()),
            };
            let pieces: Vec<HalfEdge> = (0..count).map(made).collect();
            let mut order: Vec<(usize, HalfEdgeId)> = HalfEdgeId::all(count).map(|old| (number(), old)).collect();
            order.sort_unstable();
            let old: Vec<HalfEdgeId> = order.into_iter().map(|(_, old)| old).collect();
            let mut permuted = pieces.clone();
            permute(&mut permuted, &old);
            let expected: Vec<String> = old.iter().map(|old| format!("{:?}", pieces[old.index()])).collect();
            let found: Vec<String> = permuted.iter().map(|piece| format!("{piece:?}")).collect();
            assert!(found == expected, "seed {seed}");
        }
    }
}
