//! What the search works on: the parts, how they may be grouped, and what a group costs.

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::clear::Clear;
use super::gaps::Gaps;
use super::hull::Hull;
use super::options::{CoarsenOptions, DEFAULT_OVERLAP_WEIGHT};
use super::part::{Part, sort_and_dedup};
use super::probes::Probes;

/// What a volume that is covered twice costs, relative to what it costs before, where nothing is left but to better what there is.
const LAST_OVERLAP: f64 = 1.0 / 8.0;
/// Maximum number of hulls of two parts that are kept, some kilobytes each.
pub(super) const MOST_PAIRS: usize = 10_000;

/// Parts, and what holds for every group of them.
#[derive(Debug)]
pub(super) struct Search<'a> {
    pub(super) parts: &'a [Part],
    pub(super) probes: &'a Probes,
    clear: &'a Clear,
    by_material: bool,
    hulls: &'a Hulls,
    gaps: &'a Gaps,
    overlap: f64,
}

/// Hulls that are asked for often.
#[derive(Debug, Default)]
pub(super) struct Hulls {
    /// Of each part.
    singles: Vec<Hull>,
    /// Of two parts; those that may not be joined are not among them.
    pairs: FxHashMap<[u32; 2], Hull>,
}

impl Hulls {
    pub(super) fn of(parts: &[Part], probes: &Probes) -> Self {
        Self::new(parts, probes, |part| Hull::of(&part.all_points().collect::<Vec<_>>()))
    }

    /// The same of those of their corners that are the farthest in some directions: a few say enough of parts that are small.
    pub(super) fn of_few(parts: &[Part], probes: &Probes) -> Self {
        Self::new(parts, probes, |part| Hull::of(&farthest(&part.corners)))
    }

    fn new(parts: &[Part], probes: &Probes, hull: impl Fn(&Part) -> Hull + Sync + Send) -> Self {
        let singles: Vec<Hull> = parts.par_iter().map(hull).collect();
        singles.par_iter().for_each(|hull| _ = hull.coverage(probes));
        Self { singles, pairs: FxHashMap::default() }
    }

    /// Keeps hulls of two parts.
    pub(super) fn keep(&mut self, pairs: Vec<([u32; 2], Hull)>) {
        self.pairs.extend(pairs);
    }
}

/// Parts that are to become one cell.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) parts: Vec<u32>,
    pub(super) hull: Hull,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        parts: &'a [Part],
        hulls: &'a Hulls,
        probes: &'a Probes,
        clear: &'a Clear,
        gaps: &'a Gaps,
        options: &CoarsenOptions,
    ) -> Self {
        let overlap = options.overlap_weight.unwrap_or(DEFAULT_OVERLAP_WEIGHT);
        Self { parts, probes, clear, by_material: options.by_material, hulls, gaps, overlap }
    }

    /// The same with overlaps of less weight.
    pub(super) fn last(&self) -> Self {
        Self { overlap: self.overlap * LAST_OVERLAP, ..*self }
    }

    /// The group of one part.
    pub(super) fn single(&self, part: u32) -> Group {
        Group { parts: vec![part], hull: self.hull(part).clone() }
    }

    /// The hull of a part.
    pub(super) fn hull(&self, part: u32) -> &Hull {
        &self.hulls.singles[part as usize]
    }

    /// The group of some parts.
    pub(super) fn group(&self, parts: Vec<u32>) -> Group {
        let points: Vec<DVec3> = parts.iter().flat_map(|part| self.hull(*part).corners.iter().copied()).collect();
        Group { hull: Hull::of(&points), parts }
    }

    /// The hull of two groups, and whether parts of both are near each other; `None` where it may not be.
    pub(super) fn joined_groups(&self, a: &Group, b: &Group) -> Option<(Hull, bool)> {
        let is_near = self.are_near(&a.parts, &b.parts);
        if !is_near && self.gaps.is_strict() {
            return None;
        }
        let known = match (&a.parts[..], &b.parts[..]) {
            ([a], [b]) => self.hulls.pairs.get(&[*a.min(b), *a.max(b)]).cloned(),
            _ => None,
        };
        let hull = known.or_else(|| self.joined(&a.hull, &b.hull))?;
        Some((hull, is_near))
    }

    /// Whether parts of two groups are near each other.
    pub(super) fn are_near(&self, some: &[u32], others: &[u32]) -> bool {
        self.gaps.are_near(some, others)
    }

    /// The parts that are near one; nothing where that does not matter.
    pub(super) fn near(&self, part: u32) -> Option<&[u32]> {
        self.gaps.near(part)
    }

    /// The hull of two hulls; `None` where it may not be.
    pub(super) fn joined(&self, a: &Hull, b: &Hull) -> Option<Hull> {
        let points: Vec<DVec3> = a.corners.iter().chain(&b.corners).copied().collect();
        let hull = Hull::of(&points);
        self.clear.allows_hull(&hull).then_some(hull)
    }

    /// Whether two groups are of one material, where that matters.
    pub(super) fn may_join(&self, a: u32, b: u32) -> bool {
        !self.by_material || self.parts[a as usize].material == self.parts[b as usize].material
    }

    /// What hulls cost that cover a number of probes which nothing else covers.
    pub(super) fn cost(&self, fresh: u32, volume: f64) -> f64 {
        self.probes.volume(fresh) + self.overlap * volume
    }

    /// The least difference in cost that is worth a change.
    pub(super) fn least_gain(&self) -> f64 {
        0.5 * self.probes.unit
    }
}

/// The farthest points in the directions to corners, edges and sides of a cube, each once.
pub(super) fn farthest(points: &[DVec3]) -> Vec<DVec3> {
    let way = |k: i32| DVec3::from_array([k % 3, k / 3 % 3, k / 9].map(|v| f64::from(v - 1)));
    let directions = (0..27).map(way).filter(|way| *way != DVec3::ZERO);
    let in_direction = |way: DVec3| points.iter().copied().max_by(|a, b| way.dot(*a).total_cmp(&way.dot(*b)));
    let mut found: Vec<DVec3> = directions.filter_map(in_direction).collect();
    sort_and_dedup(&mut found);
    found
}
