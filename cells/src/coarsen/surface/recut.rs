//! Neighbouring groups of pieces cut apart again, by planes in any direction.
//!
//! Pieces come from cuts across the axes: where two groups meet there are stairs, so that their hulls overlap and add more than they need to. All that two groups hold is cut by the plane for
//! which the hulls of both sides are smallest ([`Dividing`]); the sides replace the groups where that costs less. When no pair gets better, cells go to where they save more ([`super::exchange`]), and what
//! is near those is cut apart again.

use std::collections::BTreeSet;
use std::sync::Arc;

use planecut_csg::MaterialId;
use planecut_csg::stages::Bounds;
use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::super::hull::Hull;
use super::super::part;
use super::super::probes::add;
use super::super::regroup::{cost, covered_beside, neighbours};
use super::super::search::{Group, Search};
use super::Pieces;
use super::body::Points;
use super::chunk::{Chunk, Place, rejoined};
use super::dividing_plane::Dividing;
use super::fragment::Plane;
use crate::tolerances::RECUT_MARGIN;

/// Budget of work for each group, and how many groups add to it: the number of corners in all hulls that are tried, about a third of a microsecond each.
const WORK: (usize, usize) = (150_000, 64);
/// Fewest pairs that are cut at the same time, whatever the number of threads, and the number of groups for each more.
const AT_A_TIME: (usize, usize) = (8, 16);
/// A pair is not cut where its hulls exceed what they hold by less than this share of what all do.
const LEAST_EMPTY: f64 = 1e-3;
/// Cells that add more than this share of what they added before are not worth making bodies twice to compare them.
const WORTH_IT: f64 = 0.98;
/// Cells that add no more than this share of what they added before are better for sure, although cells that overlap lose some of that when they are drawn in.
const CLEARLY_BETTER: f64 = 0.9;

/// Polygons in all pieces where cells are made twice to be compared, at most: with more that takes seconds.
const MOST_COMPARED: usize = 20_000;

/// Groups that were cut apart again.
pub(in super::super) struct Recut {
    /// For each group that became another, the points that its cell must hold, and its material.
    pub(in super::super) groups: Vec<Option<(Points, MaterialId)>>,
    /// Whether cells of them add so much less that they need not be compared.
    pub(in super::super) is_clearly_better: bool,
}

/// What a cell is to hold.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub(super) chunks: Vec<Arc<Chunk>>,
    pub(super) hull: Hull,
    /// What the hull exceeds its chunks by, each taken for its own hull.
    pub(super) empty: f64,
    is_new: bool,
}

/// What is found instead of a pair of cells.
struct Found {
    pair: [usize; 2],
    cells: Option<[Cell; 2]>,
    work: usize,
}

impl Pieces {
    /// Cuts neighbouring groups apart again where that pays; `None` where nothing was found, or pieces are not known well enough to be cut.
    pub(in super::super) fn recut(&self, search: &Search, groups: &[Group]) -> Option<Recut> {
        if self.regions.is_empty() {
            return None;
        }
        let chunk = |piece: &u32| {
            let number = *piece as usize;
            Arc::new(Chunk::of_region(*piece, &self.regions[number], &self.points[number], &self.frame))
        };
        let cell = |group: &Group| self.cell(group.parts.iter().map(chunk).collect(), false);
        let mut cells: Vec<Cell> = groups.par_iter().map(cell).collect();
        let before = added(search, &cells);
        self.cut(search, &mut cells);
        let share = f64::from(added(search, &cells)) / f64::from(before.max(1));
        let is_clearly_better = share <= CLEARLY_BETTER;
        let polygons: usize = self.regions.iter().map(|region| region.polygons.len()).sum();
        let may_compare = share <= WORTH_IT && polygons <= MOST_COMPARED;
        if !(is_clearly_better || may_compare) || !cells.iter().any(|cell| cell.is_new) {
            return None;
        }
        let groups = cells.into_iter().map(|cell| cell.is_new.then(|| held(search, &cell))).collect();
        Some(Recut { groups, is_clearly_better })
    }

    /// Cuts neighbours apart and divides cells in place of others until nothing gets better, or all work is done that may be.
    fn cut(&self, search: &Search, cells: &mut [Cell]) {
        let (of_group, most) = WORK;
        let mut work = of_group * cells.len().min(most);
        let worth_it = LEAST_EMPTY * cells.iter().map(|cell| cell.empty).sum::<f64>();
        let mut waiting = near_each_other(search, cells);
        while !waiting.is_empty() && work > 0 {
            self.cut_pairs(search, cells, waiting, worth_it, &mut work);
            let changed = self.exchange(search, cells, worth_it, &mut work);
            waiting = near_some(search, cells, &changed);
        }
    }

    /// Cuts pairs apart, and those near a cell that changes by that.
    fn cut_pairs(
        &self,
        search: &Search,
        cells: &mut [Cell],
        mut waiting: Vec<[usize; 2]>,
        worth_it: f64,
        work: &mut usize,
    ) {
        let (least, of_groups) = AT_A_TIME;
        let at_a_time = least + cells.len() / of_groups;
        while !waiting.is_empty() && *work > 0 {
            let empty = |pair: &[usize; 2]| pair.iter().map(|place| cells[*place].empty).sum::<f64>();
            waiting.retain(|pair| empty(pair) > worth_it);
            // those first where there is most to gain for the work
            let chunks = |pair: &[usize; 2]| pair.iter().map(|place| cells[*place].chunks.len()).sum::<usize>();
            let each = |pair: &[usize; 2]| empty(pair) / chunks(pair) as f64;
            waiting.sort_by(|a, b| each(b).total_cmp(&each(a)).then_with(|| a.cmp(b)));
            let taken = without_common(&mut waiting, at_a_time);
            let view: &[Cell] = cells;
            let found: Vec<Found> =
                taken.par_iter().with_max_len(1).map(|pair| self.found(search, view, *pair)).collect();
            let mut changed: BTreeSet<usize> = BTreeSet::new();
            for Found { pair, cells: new, work: done } in found {
                *work = work.saturating_sub(done);
                // others may have changed since it was found
                let Some(new) = new.filter(|new| gain(search, cells, pair, new) > search.least_gain()) else {
                    continue;
                };
                for (place, cell) in pair.into_iter().zip(new) {
                    cells[place] = cell;
                    changed.insert(place);
                }
            }
            if !changed.is_empty() {
                waiting.extend(near_some(search, cells, &changed));
                waiting.sort_unstable();
                waiting.dedup();
            }
        }
    }

    fn cell(&self, chunks: Vec<Arc<Chunk>>, is_new: bool) -> Cell {
        let points: Vec<DVec3> = chunks.iter().flat_map(|chunk| chunk.points.all().copied()).collect();
        let hull = Hull::of(&points);
        let filled: f64 = chunks.iter().map(|chunk| chunk.volume).sum();
        Cell { empty: (hull.volume - filled / self.frame.scale.powi(3)).max(0.0), hull, chunks, is_new }
    }

    /// Two cells instead of a pair, by the best plane that is found.
    fn found(&self, search: &Search, cells: &[Cell], pair: [usize; 2]) -> Found {
        let sides = pair.map(|place| &cells[place].chunks[..]);
        let chunks = rejoined(sides.concat());
        let mut dividing = Dividing::new(&chunks, sides);
        let new = dividing.best().and_then(|plane| self.divided(&chunks, plane));
        let cells = new.filter(|new| gain(search, cells, pair, new) > search.least_gain());
        Found { pair, cells, work: dividing.work }
    }

    /// What lies on either side of a plane; `None` where that is nothing.
    pub(super) fn divided(&self, chunks: &[Arc<Chunk>], plane: Plane) -> Option<[Cell; 2]> {
        let margin = RECUT_MARGIN + self.growth.rounding * self.frame.scale;
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for chunk in chunks {
            match chunk.place(plane, margin) {
                Place::Below => below.push(Arc::clone(chunk)),
                Place::Above => above.push(Arc::clone(chunk)),
                Place::Across => {
                    let [low, high] = chunk.split(plane, margin, &self.frame);
                    below.push(low);
                    above.push(high);
                }
            }
        }
        let is_divided = !below.is_empty() && !above.is_empty();
        is_divided.then(|| [below, above].map(|chunks| self.cell(chunks, true)))
    }

    /// Two cells as one.
    pub(super) fn united(&self, a: &Cell, b: &Cell) -> Cell {
        self.cell(rejoined([&a.chunks[..], &b.chunks].concat()), true)
    }
}

/// What a cell must hold, and its material.
fn held(search: &Search, cell: &Cell) -> (Points, MaterialId) {
    let points = Points::joined(cell.chunks.iter().map(|chunk| &chunk.points));
    let pieces: BTreeSet<u32> = cell.chunks.iter().map(|chunk| chunk.piece).collect();
    (points, part::material_of_most(pieces.iter().map(|piece| &search.parts[*piece as usize])))
}

/// How many probes all cells cover.
fn added(search: &Search, cells: &[Cell]) -> u32 {
    let mut covered = vec![0_u64; search.probes.words()];
    cells.iter().for_each(|cell| add(&mut covered, cell.hull.coverage(search.probes)));
    covered.iter().map(|word| word.count_ones()).sum()
}

/// What a pair, or one cell named twice, costs less when it is replaced.
pub(super) fn gain(search: &Search, cells: &[Cell], [a, b]: [usize; 2], new: &[Cell]) -> f64 {
    let old = [a, b].into_iter().take(if a == b { 1 } else { 2 }).map(|place| &cells[place].hull);
    let new = new.iter().map(|cell| &cell.hull);
    let bounds = old.clone().chain(new.clone()).fold(Bounds::EMPTY, |all, hull| all.union(&hull.bounds));
    let covered = covered_beside(search, cells.iter().map(|cell| &cell.hull), &[a, b], &bounds);
    cost(search, &covered, old) - cost(search, &covered, new)
}

/// Pairs of cells that are near each other and may exchange what they hold.
pub(super) fn near_each_other(search: &Search, cells: &[Cell]) -> Vec<[usize; 2]> {
    let bounds: Vec<Bounds> = cells.iter().map(|cell| cell.hull.bounds).collect();
    let mut pairs = neighbours(&bounds);
    pairs.retain(|pair| {
        let [a, b] = pair.map(|place| cells[place].chunks[0].piece);
        search.may_join(a, b)
    });
    pairs
}

/// The same of pairs of which one cell is among some.
fn near_some(search: &Search, cells: &[Cell], some: &BTreeSet<usize>) -> Vec<[usize; 2]> {
    let mut pairs = near_each_other(search, cells);
    pairs.retain(|pair| pair.iter().any(|place| some.contains(place)));
    pairs
}

/// Takes out the first pairs of which no two have a cell in common, up to a number.
fn without_common(waiting: &mut Vec<[usize; 2]>, most: usize) -> Vec<[usize; 2]> {
    let (mut used, mut taken) = (BTreeSet::new(), Vec::new());
    waiting.retain(|pair| {
        let is_taken = taken.len() < most && !pair.iter().any(|place| used.contains(place));
        if is_taken {
            used.extend(*pair);
            taken.push(*pair);
        }
        !is_taken
    });
    taken
}
