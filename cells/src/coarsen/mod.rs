//! Fewer convex cells for a solid, within a stated error: colliders.
//!
//! A [`Coarsener`] takes the convex parts of a solid (brushes of a union, else disjoint cells) and groups them; each group becomes the hull of its parts.
//! What a grouping costs is the volume of the *union* of its cells beyond the solid, not the sum of what single merges add.
//!
//! - `surface`: parts of a mesh, from the top down; `of_surface`: these instead of exact ones.
//! - `part`: a convex part; `point_tree`: many points and planes; `box_list`: boxes that change; `hull`, `probes`: hulls in floating point, and the points that say how much they add; `search`: what every
//!   group must fulfil; `clear`: where nothing may grow, `reachable`: because a ball can go there; `gaps`: what is far apart.
//! - `free` merges what adds nothing, `merge` what adds least, with `pairs`; `relocate` and `regroup` better the groups.
//! - `enclose` makes exact bodies of them, `shrink` draws these in where they overlap, with `subtract`; `limits` sees to engines' caps, with `lower`.
//! - `inner`: cells within the solid.
//! - `written`: cells as a file holds them.
//!
//! Floating point proposes; that the cells enclose the solid is decided by exact signs.

mod box_list;
mod clear;
mod enclose;
mod free;
mod gaps;
mod hull;
mod inner;
mod input;
mod limits;
mod lower;
mod merge;
mod of_surface;
mod options;
mod pairs;
mod part;
mod point_tree;
mod probes;
mod reachable;
mod regroup;
mod relocate;
mod search;
mod shrink;
mod subtract;
mod surface;
mod written;

use planecut_csg::stages::Boxes;
use planecut_csg::{Brush, Tree};
use planecut_kernel::DVec3;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

pub use lower::lower;
pub use options::{CoarsenError, CoarsenOptions, DEFAULT_OVERLAP_WEIGHT, LEAST_MAX_FACES, LEAST_MAX_VERTICES, Side};
pub use surface::{Bounded, Surface, Winding};
pub use written::{Writing, written_meshes};

use clear::Clear;
use gaps::Gaps;
use input::{give_points, held_exactly, parts_of, sum_of_volumes, triangles_of, union_volume};
use limits::Limits;
use merge::{Merge, Merger};
use part::{Part, boxes_of};
use probes::Probes;
use reachable::Reachable;
use regroup::regroup;
use relocate::{Clock, relocate};
use search::{Group, Hulls, MOST_PAIRS, Search};
use shrink::Shrinking;
use surface::Pieces;

/// Fewest and most probes, and how many for each part.
const PROBES: (usize, usize, usize) = (1 << 14, 1 << 17, 64);
/// Fewest and most rounds in which parts are moved and groups merged again, and what the number of parts times that of rounds is about.
const ROUNDS: (usize, usize, usize) = (2, 8, 2000);
/// Budget of work for merging groups again: the squares of how many parts are merged at once, summed up.
const REGROUPING: usize = 40_000;
/// Coarser cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Coarsened {
    /// Convex bodies, possibly overlapping. Each is of one material.
    pub cells: Vec<Brush>,
    /// How many parts the solid had.
    pub cells_in: usize,
    /// How many merges, of those that were done first, added nothing.
    pub exact_merges: usize,
    /// Volume of the solid.
    pub volume_in: f64,
    /// Volume of the union of the cells.
    pub volume_out: f64,
    /// Sum of the volumes of the parts.
    pub volume_sum_in: f64,
    /// Sum of the volumes of the cells.
    pub volume_sum_out: f64,
    /// Where [`CoarsenOptions::clear_radius`] is asked for: so much less than its radius is what the ball keeps clear around each point to which its middle can go. A quarter of the radius, and up
    /// to all of it where the solid is large.
    pub clear_tolerance: Option<f64>,
}

impl Coarsened {
    /// The volume that the union of the cells adds, relative to the solid's; negative for inner cells.
    #[must_use]
    pub fn excess(&self) -> f64 {
        (self.volume_out - self.volume_in) / self.volume_in
    }

    /// The same for the sum of the cells' volumes: what overlaps counts more than once.
    #[must_use]
    pub fn sum_excess(&self) -> f64 {
        (self.volume_sum_out - self.volume_in) / self.volume_in
    }
}

/// The convex parts of a solid, ready to be coarsened to any number of cells.
#[derive(Debug)]
pub struct Coarsener {
    options: CoarsenOptions,
    /// As they were given.
    parts: Vec<Part>,
    /// After merges that add nothing.
    free: Vec<Part>,
    free_boxes: Boxes,
    clear: Clear,
    probes: Probes,
    hulls: Hulls,
    gaps: Gaps,
    /// What the parts were made of, where they are pieces of a surface.
    pieces: Option<Pieces>,
    /// All merges of the free parts, one after another, until nothing can be merged, and the volume added after each, as far as probes tell.
    merges: Vec<(Merge, f64)>,
    volume: f64,
}

/// Coarsens the solid of a tree as the options say; `points` are points of the solid that its cells must hold exactly although
/// rounding may have left them outside, as vertices of a mesh that it was read from.
///
/// # Errors
/// [`CoarsenError`].
///
/// ```
/// use planecut_cells::coarsen::{CoarsenOptions, coarsen};
/// use planecut_csg::{Brush, MaterialId, Tree};
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), planecut_cells::coarsen::CoarsenError> {
/// let block = |min: [f64; 3], max: [f64; 3]| Tree::from(Brush::cuboid(min, max, MaterialId(0)));
/// let stairs = Tree::union((0..4).map(|k| f64::from(k)).map(|k| block([k, 0.0, 0.0], [k + 1.0, 1.0, k + 1.0])));
/// let ramp = coarsen(&stairs, &[], &CoarsenOptions { max_cells: Some(1), ..CoarsenOptions::default() })?;
/// assert_eq!(ramp.cells.len(), 1);
/// assert!((ramp.excess() - 0.15).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn coarsen(tree: &Tree, points: &[DVec3], options: &CoarsenOptions) -> Result<Coarsened, CoarsenError> {
    Coarsener::new(tree, points, options)?.coarsened()
}

impl Coarsener {
    /// Takes the solid of a tree apart and merges what can be merged without adding anything.
    ///
    /// # Errors
    /// [`CoarsenError`] for a solid that is empty or unbounded, for coordinates out of range, and for options that mean nothing.
    pub fn new(tree: &Tree, points: &[DVec3], options: &CoarsenOptions) -> Result<Self, CoarsenError> {
        options.check()?;
        let mut parts = parts_of(tree)?;
        if parts.is_empty() {
            return Err(CoarsenError::Empty);
        }
        give_points(&mut parts, points);
        let volume = union_volume(parts.iter().map(Part::brush))?;
        let boxes = boxes_of(&parts);
        let regions = options.keep_clear.as_ref().map_or(Ok(Vec::new()), parts_of)?;
        let reachable = options.clear_radius.filter(|_| options.side == Side::Outer);
        let reachable = reachable.map(|radius| Reachable::new(&triangles_of(&parts), 0.0, radius, None)).transpose()?;
        let clear = Clear::around(&parts, &boxes, &regions, reachable)?;
        let (least, most, each) = PROBES;
        // a single part that grows is merged with nothing
        let is_single = parts.len() == 1 && options.side == Side::Outer;
        let probes =
            if is_single { Probes::default() } else { Probes::around(&parts, (each * parts.len()).clamp(least, most)) };
        let free = match options.side {
            Side::Outer if is_single => parts.clone(),
            Side::Outer => {
                let hulls = Hulls::of(&parts, &probes);
                free::merge_freely(&Search::new(&parts, &hulls, &probes, &clear, &Gaps::default(), options))?
            }
            Side::Inner => inner::grown(&parts, &boxes, options)?,
        };
        let free_boxes = boxes_of(&free);
        let hulls = if is_single { Hulls::of_few(&free, &probes) } else { Hulls::of(&free, &probes) };
        let gaps = Gaps::new(&free, &free_boxes, options);
        let options = options.clone();
        let merges = Vec::new();
        let mut coarsener =
            Self { options, parts, free, free_boxes, clear, probes, hulls, gaps, pieces: None, merges, volume };
        coarsener.descend();
        Ok(coarsener)
    }

    /// How many convex parts the solid has.
    #[must_use]
    pub fn cells_in(&self) -> usize {
        self.parts.len()
    }

    /// How many are left when everything is merged that adds nothing.
    #[must_use]
    pub fn cells_free(&self) -> usize {
        self.free.len()
    }

    /// Coarsens as the options say.
    ///
    /// # Errors
    /// [`CoarsenError::Blocked`], [`CoarsenError::Evaluate`].
    pub fn coarsened(&self) -> Result<Coarsened, CoarsenError> {
        match (self.options.max_cells, self.options.max_excess) {
            (None, None) => self.to_cells(self.free.len()),
            (Some(cells), None) => self.to_cells(cells),
            (cells, Some(excess)) => self.to_excess(excess, cells.unwrap_or(1)),
        }
    }

    /// At most this number of cells, with as little added as can be found; more only where parts are kept apart by the options.
    ///
    /// # Errors
    /// As [`Coarsener::coarsened`].
    pub fn to_cells(&self, count: usize) -> Result<Coarsened, CoarsenError> {
        if count >= self.parts.len() {
            return self.finished(self.parts.iter().map(held_exactly).collect::<Result<_, _>>()?, 0);
        }
        let exact_merges = self.parts.len() - self.free.len();
        if self.options.side == Side::Inner {
            return self.finished(inner::chosen(&self.free, count), exact_merges);
        }
        let search = self.search();
        let mut groups = self.groups_at(&search, count);
        if groups.len() < self.free.len() {
            better(&search, &mut groups);
        }
        let is_free = self.clear.is_empty() && !self.gaps.is_strict();
        let pieces = self.pieces.as_ref().filter(|_| is_free && groups.len() < self.free.len());
        let Some((pieces, recut)) = pieces.and_then(|pieces| Some((pieces, pieces.recut(&search, &groups)?))) else {
            return self.enclosed(&groups, |group, _| self.body_around(group), exact_merges);
        };
        let body = |group: &Group, place: usize| match &recut.groups[place] {
            Some((points, material)) => pieces.body_of(points, *material),
            None => self.body_around(group),
        };
        let found = self.enclosed(&groups, body, exact_merges)?;
        if recut.is_clearly_better {
            return Ok(found);
        }
        // what is left of cells when they are drawn in, no cut foresees
        let without = self.enclosed(&groups, |group, _| self.body_around(group), exact_merges)?;
        Ok(if found.volume_out <= without.volume_out { found } else { without })
    }

    /// Cells of groups, by the body for each group and its place.
    fn enclosed(
        &self,
        groups: &[Group],
        body: impl Fn(&Group, usize) -> Result<Part, CoarsenError> + Sync,
        exact_merges: usize,
    ) -> Result<Coarsened, CoarsenError> {
        let bodies: Vec<Result<Part, _>> =
            groups.par_iter().enumerate().map(|(place, group)| body(group, place)).collect();
        let mut bodies = bodies.into_iter().collect::<Result<Vec<_>, _>>()?;
        let shrinking = Shrinking {
            parts: &self.free,
            boxes: &self.free_boxes,
            clear: &self.clear,
            by_material: self.options.by_material,
        };
        if groups.len() < self.free.len() {
            match &self.pieces {
                Some(pieces) => {
                    pieces.draw_in(
                        &mut bodies,
                        &self.free,
                        &self.free_boxes,
                        &self.probes,
                        self.options.by_material,
                    )?;
                }
                None => shrinking.shrink(&mut bodies, &self.probes)?,
            }
        }
        self.finished(bodies, exact_merges)
    }

    /// As few cells as can be found, but at least `least`, that add no more than `excess`, measured exactly.
    ///
    /// # Errors
    /// As [`Coarsener::coarsened`].
    pub fn to_excess(&self, excess: f64, least: usize) -> Result<Coarsened, CoarsenError> {
        let mut found: Option<Coarsened> = None;
        // the most cells that are known to add too much, the fewest that are known not to
        let (mut low, mut high) = (least.saturating_sub(1), self.free.len());
        let mut next = self.guess(excess).clamp(least.min(high), high);
        while low < high {
            let tried = self.to_cells(next)?;
            if tried.excess().abs() <= excess {
                high = next.min(tried.cells.len());
                found = Some(tried);
            } else {
                low = next;
            }
            if high - low <= 1 {
                break;
            }
            // near the guess at first, then by halves
            let middle = low + (high - low) / 2;
            next = if found.is_some() {
                middle.max(high - high.div_ceil(8)).min(high - 1)
            } else {
                middle.min(low + high.div_ceil(8)).max(low + 1)
            };
        }
        match found {
            Some(found) => Ok(found),
            None => self.to_cells(self.free.len()),
        }
    }

    /// How many cells there may be where greedy merging adds this volume.
    fn guess(&self, excess: f64) -> usize {
        let within = self.merges.partition_point(|(_, added)| *added <= excess * self.volume);
        let gone: usize = self.merges[..within].iter().map(|(merge, _)| merge.gone.len()).sum();
        self.free.len() - gone
    }

    /// Merges greedily, to the number of cells that is asked for or else to the end, and notes how.
    fn descend(&mut self) {
        if self.options.side == Side::Inner {
            return;
        }
        let search = self.search();
        let groups = (0..self.free.len() as u32).map(|part| search.single(part)).collect();
        let mut merger = Merger::new(&search, groups, vec![0; self.probes.words()]);
        let mut merges = Vec::new();
        let pairs = merger.hulls().take(MOST_PAIRS).collect();
        let least = if self.options.max_excess.is_none() { self.options.max_cells.unwrap_or(1) } else { 1 };
        while merger.count() > least {
            let Some(merge) = merger.step() else { break };
            merges.push((merge, merger.added()));
            job::progress(self.free.len() - merger.count(), self.free.len() - least);
        }
        self.merges = merges;
        self.hulls.keep(pairs);
    }

    /// The groups of greedy merging when there are no more than this number.
    fn groups_at(&self, search: &Search, count: usize) -> Vec<Group> {
        let mut members: Vec<Vec<u32>> = (0..self.free.len() as u32).map(|part| vec![part]).collect();
        let mut left = members.len();
        for (Merge { kept, gone }, _) in &self.merges {
            if left <= count {
                break;
            }
            for place in gone {
                let moved = std::mem::take(&mut members[*place as usize]);
                members[*kept as usize].extend(moved);
            }
            left -= gone.len();
        }
        let members = members.into_iter().filter(|parts| !parts.is_empty()).collect::<Vec<_>>();
        let groups: Vec<Group> = members.into_par_iter().map(|parts| search.group(parts)).collect();
        if left <= count {
            return groups;
        }
        // fewer than were asked for at first
        let mut merger = Merger::new(search, groups, vec![0; self.probes.words()]);
        while merger.count() > count && merger.step().is_some() {}
        merger.into_groups()
    }

    fn search(&self) -> Search<'_> {
        Search::new(&self.free, &self.hulls, &self.probes, &self.clear, &self.gaps, &self.options)
    }

    fn body_around(&self, group: &Group) -> Result<Part, CoarsenError> {
        if let Some(pieces) = &self.pieces {
            return pieces.body_around(&self.free, &group.parts);
        }
        let parts: Vec<&Part> = group.parts.iter().map(|part| &self.free[*part as usize]).collect();
        Part::around(&parts, &self.clear)
    }

    /// The result of cells.
    fn finished(&self, bodies: Vec<Part>, exact_merges: usize) -> Result<Coarsened, CoarsenError> {
        let limits = Limits { options: &self.options, clear: &self.clear };
        let bodies: Vec<Result<Part, _>> = bodies.into_par_iter().map(|body| limits.fulfil(body)).collect();
        // the first error, whichever came first
        let bodies = bodies.into_iter().collect::<Result<Vec<Part>, _>>()?;
        let cells: Vec<Brush> = bodies.iter().map(Part::brush).collect();
        Ok(Coarsened {
            cells_in: self.parts.len(),
            exact_merges,
            volume_in: self.volume,
            volume_out: union_volume(cells.iter().cloned())?,
            volume_sum_in: sum_of_volumes(&self.parts),
            volume_sum_out: sum_of_volumes(&bodies),
            clear_tolerance: self.clear.tolerance(),
            cells,
        })
    }
}

/// Moves parts between groups and merges groups again as long as that pays.
fn better(search: &Search, groups: &mut [Group]) {
    let mut clock = Clock::new(groups.len(), search.parts.len());
    let mut regrouped = 0;
    let mut work = REGROUPING;
    let (fewest, most, moved) = ROUNDS;
    let rounds = (moved / search.parts.len()).clamp(fewest, most);
    for _ in 0..rounds {
        relocate(search, groups, &mut clock, rounds);
        let now = clock.now();
        let is_new = regroup(search, groups, &mut clock, regrouped, &mut work);
        regrouped = now;
        if !is_new {
            break;
        }
    }
    let mut clock = Clock::new(groups.len(), search.parts.len());
    relocate(&search.last(), groups, &mut clock, rounds);
}
