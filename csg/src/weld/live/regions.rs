//! The half-edges of each region: which begin and end in a point, which are near a place.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::grid::{BoxGrid, Rectangle};
use super::numbers::Context;
use super::pieces::Pieces;
use super::{MANY, SHARE};
use crate::ids::{FaceId, HalfEdgeId, Id, PointId, PointOnLine, RegionId, number32};
use crate::weld::cancel::HalfEdge;
use crate::weld::nest::RegionPlane;
use crate::weld::pinches::PinchFinder;

/// Number of half-edges from which those of a region are looked up in an index, and that below which there is none any more.
const INDEXED: [usize; 2] = [64, 32];

/// Where more than one in this number of the half-edges of a region move, its index is made again when it is next needed.
const MOVED_SHARE: usize = 4;

/// Number of regions that a thread looks at in a row, where it looks at many.
const REGIONS_OF_CHUNK: usize = 1024;

/// The regions, by number.
#[derive(Clone, Default)]
pub(super) struct Regions {
    regions: Vec<Region>,
    changed: Vec<RegionId>,
    near: NearNew,
}

/// What is near new half-edges of a region: buffers.
#[derive(Clone, Default)]
struct NearNew {
    pieces: Vec<HalfEdgeId>,
    corners: Vec<PointId>,
}

#[derive(Clone, Default)]
pub(super) struct Region {
    /// Its half-edges, in no order.
    pieces: Vec<HalfEdgeId>,
    /// Where they are, where there are many.
    index: Option<Box<Index>>,
    /// What came since the last update, some of it gone by now, and what went.
    pub(super) new: SmallVec<[HalfEdgeId; 4]>,
    pub(super) gone: SmallVec<[HalfEdgeId; 4]>,
    /// Its faces, in no order.
    pub(super) faces: Vec<FaceId>,
    /// Where corners touch the inside of edges.
    pinches: Vec<PointOnLine>,
}

/// Where the half-edges of a region are.
#[derive(Clone, Default)]
pub(super) struct Index {
    /// Those that begin, and that end, in each point.
    at_point: FxHashMap<PointId, [Vec<HalfEdgeId>; 2]>,
    grid: BoxGrid,
}

impl Index {
    fn insert(&mut self, piece: &HalfEdge, number: HalfEdgeId, plane: &RegionPlane<'_>) {
        for (end, point) in [piece.from, piece.to].into_iter().enumerate() {
            self.at_point.entry(point).or_default()[end].push(number);
        }
        self.grid.insert(&rectangle(piece, plane), number);
    }

    fn remove(&mut self, piece: &HalfEdge, number: HalfEdgeId, plane: &RegionPlane<'_>) {
        for (end, point) in [piece.from, piece.to].into_iter().enumerate() {
            if let Some(ends) = self.at_point.get_mut(&point) {
                ends[end].retain(|other| *other != number);
                if ends.iter().all(Vec::is_empty) {
                    self.at_point.remove(&point);
                }
            }
        }
        self.grid.remove(&rectangle(piece, plane), number);
    }
}

fn rectangle(piece: &HalfEdge, plane: &RegionPlane<'_>) -> Rectangle {
    let (from, to) = (plane.position(piece.from), plane.position(piece.to));
    Rectangle { min: from.min(to), max: from.max(to) }
}

/// The half-edges of a region by where they begin and end, for some points.
pub(super) enum EndsAt<'a> {
    Indexed(&'a Index),
    /// Those that begin or end in one of the points, and perhaps a few more.
    Listed(SmallVec<[([PointId; 2], HalfEdgeId); 16]>),
}

impl EndsAt<'_> {
    /// Leaves in `found` the half-edges that begin in a point.
    pub(super) fn find_beginning(&self, point: PointId, found: &mut SmallVec<[HalfEdgeId; 8]>) {
        self.find(0, point, found);
    }

    /// The same of those that end there.
    pub(super) fn find_ending(&self, point: PointId, found: &mut SmallVec<[HalfEdgeId; 8]>) {
        self.find(1, point, found);
    }

    fn find(&self, end: usize, point: PointId, found: &mut SmallVec<[HalfEdgeId; 8]>) {
        found.clear();
        match self {
            Self::Indexed(index) => {
                found.extend_from_slice(index.at_point.get(&point).map_or(&[][..], |ends| &ends[end]));
            }
            Self::Listed(listed) => {
                let ending = listed.iter().filter(|(ends, _)| ends[end] == point);
                found.extend(ending.map(|(_, number)| *number));
            }
        }
    }
}

impl Region {
    /// What tells which half-edges begin and end in some points.
    pub(super) fn ends_at(&self, pieces: &Pieces, points: &[PointId]) -> EndsAt<'_> {
        if let Some(index) = &self.index {
            return EndsAt::Indexed(index);
        }
        // a bit for each point, which few others share
        let bit = |point: PointId| 1_u64 << (point.number() % u64::BITS);
        let bits = points.iter().fold(0, |bits, point| bits | bit(*point));
        let ends = |number: &HalfEdgeId| {
            let piece = &pieces.half_edges[number.index()];
            ([piece.from, piece.to], *number)
        };
        let is_near = |([from, to], _): &([PointId; 2], HalfEdgeId)| (bit(*from) | bit(*to)) & bits != 0;
        EndsAt::Listed(self.pieces.iter().map(ends).filter(is_near).collect())
    }
}

impl Regions {
    pub(super) fn get_mut(&mut self, region: RegionId) -> &mut Region {
        &mut self.regions[region.index()]
    }

    /// The faces of a region.
    pub(super) fn faces(&self, region: RegionId) -> &[FaceId] {
        self.regions.get(region.index()).map_or(&[], |region| &region.faces)
    }

    /// Those that changed since this was last called, in the place of what is listed there.
    pub(super) fn take_changed(&mut self, changed: &mut Vec<RegionId>) {
        changed.clear();
        std::mem::swap(&mut self.changed, changed);
    }

    /// The region of a half-edge that comes or goes.
    fn note(&mut self, number: RegionId) -> &mut Region {
        if number.index() >= self.regions.len() {
            self.regions.resize_with(number.index() + 1, Region::default);
        }
        let region = &mut self.regions[number.index()];
        if !region.is_changed() {
            self.changed.push(number);
        }
        region
    }

    pub(super) fn add_piece(
        &mut self,
        context: &Context<'_>,
        places: &mut [u32],
        piece: &HalfEdge,
        number: HalfEdgeId,
    ) {
        let region = self.note(piece.region);
        region.new.push(number);
        places[number.index()] = number32(region.pieces.len());
        region.pieces.push(number);
        if let Some(index) = &mut region.index {
            index.insert(piece, number, &context.plane(piece.region));
        }
    }

    pub(super) fn remove_piece(
        &mut self,
        context: &Context<'_>,
        places: &mut [u32],
        piece: &HalfEdge,
        number: HalfEdgeId,
    ) {
        let region = self.note(piece.region);
        region.gone.push(number);
        let place = places[number.index()] as usize;
        region.pieces.swap_remove(place);
        if let Some(moved) = region.pieces.get(place) {
            places[moved.index()] = number32(place);
        }
        if let Some(index) = &mut region.index {
            index.remove(piece, number, &context.plane(piece.region));
        }
    }

    /// Takes half-edges out of the index of their region that are about to move, or drops the index where that is less work.
    pub(super) fn lift(&mut self, context: &Context<'_>, pieces: &Pieces, moving: &[(RegionId, HalfEdgeId)]) {
        let Some((number, _)) = moving.first() else { return };
        let region = self.get_mut(*number);
        if moving.len() * MOVED_SHARE > region.pieces.len() {
            region.index = None;
        }
        self.for_indexed(context, pieces, moving, Index::remove);
    }

    /// Puts them into it again, once they have moved.
    pub(super) fn put_down(&mut self, context: &Context<'_>, pieces: &Pieces, moving: &[(RegionId, HalfEdgeId)]) {
        self.for_indexed(context, pieces, moving, Index::insert);
    }

    /// Does something with each of some half-edges of one region, where that has an index.
    fn for_indexed(
        &mut self,
        context: &Context<'_>,
        pieces: &Pieces,
        moving: &[(RegionId, HalfEdgeId)],
        work: impl Fn(&mut Index, &HalfEdge, HalfEdgeId, &RegionPlane<'_>),
    ) {
        let Some((number, _)) = moving.first() else { return };
        if let Some(index) = &mut self.get_mut(*number).index {
            let plane = context.plane(*number);
            moving.iter().for_each(|(_, piece)| work(index, &pieces.half_edges[piece.index()], *piece, &plane));
        }
    }

    /// Takes the pinches away that may be none any more, as something changed on their line or at their point; the region
    /// of each as well.
    pub(super) fn take_doubtful_pinches(&mut self, half_edges: &[HalfEdge]) -> Vec<(RegionId, PointOnLine)> {
        let mut doubtful = Vec::new();
        for &number in &self.changed {
            let Region { pinches, new, gone, .. } = &mut self.regions[number.index()];
            pinches.retain(|&pinch| {
                let PointOnLine { line, point } = pinch;
                let concerns = |piece: &HalfEdge| piece.line() == line || piece.from == point || piece.to == point;
                let is_doubtful = new.iter().chain(&*gone).any(|piece| concerns(&half_edges[piece.index()]));
                if is_doubtful {
                    doubtful.push((number, pinch));
                }
                !is_doubtful
            });
        }
        doubtful
    }

    /// Finds the pinches that new half-edges make in regions that have changed; they are noted, too.
    pub(super) fn find_pinches(&mut self, context: &Context<'_>, pieces: &Pieces) -> Vec<(RegionId, PointOnLine)> {
        let finder = || PinchFinder::new(context.table, context.numbers.points());
        let Self { regions, changed, near } = self;
        if changed.len() < MANY || changed.len() * SHARE < regions.len() {
            let (mut finder, mut found) = (finder(), Vec::new());
            for number in changed {
                regions[number.index()].find_pinches(context, pieces, *number, (&mut finder, near));
                found.extend(finder.found.drain(..).map(|pinch| (*number, pinch)));
            }
            return found;
        }
        let work = |(chunk, regions): (usize, &mut [Region])| {
            let (mut finder, mut near, mut found) = (finder(), NearNew::default(), Vec::new());
            let first = RegionId::from_index(chunk * REGIONS_OF_CHUNK);
            for (k, region) in regions.iter_mut().enumerate().filter(|(_, region)| region.is_changed()) {
                let number = first.plus(k);
                region.find_pinches(context, pieces, number, (&mut finder, &mut near));
                found.extend(finder.found.drain(..).map(|pinch| (number, pinch)));
            }
            found
        };
        regions.par_chunks_mut(REGIONS_OF_CHUNK).enumerate().flat_map_iter(work).collect()
    }
}

impl Region {
    fn is_changed(&self) -> bool {
        !self.new.is_empty() || !self.gone.is_empty()
    }

    /// Leaves in the finder the pinches that new half-edges make; they are noted, too.
    fn find_pinches(
        &mut self,
        context: &Context<'_>,
        pieces: &Pieces,
        number: RegionId,
        (finder, near): (&mut PinchFinder<'_>, &mut NearNew),
    ) {
        finder.found.clear();
        let plane = context.plane(number);
        self.settle_index(pieces, &plane);
        let half_edge = |number: &HalfEdgeId| pieces.half_edges[number.index()];
        let alive = |number: &&HalfEdgeId| !pieces.is_gone[number.index()];
        let NearNew { pieces: near, corners } = near;
        match &self.index {
            Some(index) => {
                for number in self.new.iter().filter(alive) {
                    let piece = half_edge(number);
                    index.grid.find(&rectangle(&piece, &plane), near);
                    corners.clear();
                    corners.extend(near.iter().map(|other| half_edge(other).from));
                    finder.touching(&piece, corners);
                    // what its corner touches is among these
                    near.iter().for_each(|other| finder.touching(&half_edge(other), &[piece.from]));
                }
            }
            None => {
                let reach = self.new.iter().filter(alive).map(|new| rectangle(&half_edge(new), &plane));
                let reach = reach.reduce(|a, b| Rectangle { min: a.min.min(b.min), max: a.max.max(b.max) });
                let Some(reach) = reach else { return };
                let touches = |number: &&HalfEdgeId| {
                    let other = rectangle(&half_edge(number), &plane);
                    other.min.cmple(reach.max).all() && other.max.cmpge(reach.min).all()
                };
                near.clear();
                near.extend(self.pieces.iter().filter(touches));
                corners.clear();
                corners.extend(self.new.iter().filter(alive).map(|number| half_edge(number).from));
                near.iter().for_each(|old| finder.touching(&half_edge(old), corners));
                corners.clear();
                corners.extend(near.iter().map(|number| half_edge(number).from));
                self.new.iter().filter(alive).for_each(|new| finder.touching(&half_edge(new), corners));
            }
        }
        finder.found.sort_unstable();
        finder.found.dedup();
        self.pinches.extend(finder.found.iter());
    }

    /// Makes an index where there are many half-edges, or drops it where there are few.
    fn settle_index(&mut self, pieces: &Pieces, plane: &RegionPlane<'_>) {
        if self.index.is_some() && self.pieces.len() < INDEXED[1] {
            self.index = None;
        } else if self.index.is_none() && self.pieces.len() >= INDEXED[0] {
            let mut index = Index::default();
            for number in &self.pieces {
                index.insert(&pieces.half_edges[number.index()], *number, plane);
            }
            self.index = Some(Box::new(index));
        }
    }
}
