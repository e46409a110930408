//! A table of the planes of a model, all at once.
//!
//! Planes are sorted by a number that is the same for both sides of a plane and close for planes that are nearly the same: what equals another
//! plane, or is near it, follows it. Most have no other as close as that, and need not be compared with any.

use std::collections::hash_map::Entry;
use std::iter;
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Row;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::near::{NearPlanes, unit};
use super::same::{Key, compare_coefficients, first_side, is_exact, key, settling_order};
use super::{PlaneId, PlaneTable};
use crate::base::{WEIGHTS, by_parts, repeated, runs_apart, sort_by_number, starts_of};
use crate::ids::number32;
use crate::tolerances::SNAP_TOLERANCE;

/// Planes whose numbers differ by more are not within the tolerance: the sum of the weights times the tolerance, and room for rounding.
const APART: f64 = 3.0 * SNAP_TOLERANCE;

/// Least number of planes that a thread looks at in a row.
const CHUNK: usize = 256;

/// Least number of ids that a thread renumbers in a row.
const IDS_OF_CHUNK: usize = 1 << 11;

impl PlaneTable {
    /// Interns half-spaces; gives the table and the id of each half-space in the order given. `size` is the [`smallest_size`](super::smallest_size)
    /// of the bodies that they bound.
    ///
    /// The numbering depends on the planes alone, not on the order in which they were given.
    #[must_use]
    pub fn intern(half_spaces: &[HalfSpace], size: f64) -> (Self, Vec<PlaneId>) {
        let (interned, mut ids) = InternedPlanes::of(iter::once(half_spaces.len()), |_, k| &half_spaces[k], size);
        // in this order cells are cut and merged
        let mut order: Vec<u32> = (0..number32(interned.len())).collect();
        let place = |index: &u32| settling_order(interned.first_side(*index));
        order.par_sort_unstable_by(|p, q| place(p).cmp(&place(q)));
        (interned.into_table(&order, &mut ids), ids)
    }
}

/// The different planes among some half-spaces, before they have their places in a table.
pub(crate) struct InternedPlanes {
    /// Of each plane given the side with the positive first coefficient, and whether the other one was given.
    sides: Vec<(Row, bool)>,
    /// For each id the place, among those given, of the plane that stands for it.
    kept: Vec<u32>,
    /// Those that were replaced by another one, as in [`PlaneTable`].
    replaced: Vec<(Row, PlaneId)>,
    reach: f64,
    size: f64,
}

impl InternedPlanes {
    /// Interns half-spaces in parts of some lengths, for instance one for each brush: `half_space` gives one from the number of its part and its place
    /// there; `size` is the [`smallest_size`](super::smallest_size) of the bodies that they bound. Gives the id of each half-space, too, in the order given.
    ///
    /// The numbering depends on the planes alone, not on the order in which they were given.
    pub(crate) fn of<'a>(
        lengths: impl Iterator<Item = usize>,
        half_space: impl Fn(usize, usize) -> &'a HalfSpace + Sync,
        size: f64,
    ) -> (Self, Vec<PlaneId>) {
        let sides = by_parts(lengths, CHUNK, |part, k| first_side(&Row::new(half_space(part, k))));
        let (sorted, reach) = sort(&sides, size);
        let may_be_near = |a: &(u64, u32), b: &(u64, u32)| f64::from_bits(b.0) - f64::from_bits(a.0) <= APART;
        let runs = runs_apart(&sorted, CHUNK, |a, b| !may_be_near(a, b));
        let settle = |run: &&[(u64, u32)]| {
            let mut settled = Settled::default();
            run.chunk_by(may_be_near).for_each(|chain| settled.add(chain, &sides, size));
            settled
        };
        let parts: Vec<Settled> = runs.par_iter().with_max_len(1).map(settle).collect();
        let firsts = starts_of(parts.iter().map(|part| part.planes.len()));
        let ids = repeated(sides.len(), || AtomicU32::new(0));
        let by_run = || runs.par_iter().zip(&parts).zip(&firsts).with_max_len(1);
        by_run().for_each(|((run, part), first)| {
            for ((_, place), local) in run.iter().zip(&part.ids) {
                ids[*place as usize].store(local.after(*first).0, Ordering::Relaxed);
            }
        });
        let number = |(id, side): (AtomicU32, &(Row, bool))| {
            let id = PlaneId(id.into_inner());
            if side.1 { id.flipped() } else { id }
        };
        let ids = ids.into_par_iter().zip(&sides).with_min_len(CHUNK).map(number).collect();
        let kept = parts.iter().flat_map(|part| &part.planes).copied().collect();
        let replaced = parts.iter().zip(&firsts).flat_map(|(part, first)| part.replaced(*first)).collect();
        (Self { sides, kept, replaced, reach, size }, ids)
    }

    /// How many different planes there are.
    pub(crate) fn len(&self) -> usize {
        self.kept.len()
    }

    /// How many were replaced by one that was nearly the same.
    pub(crate) fn snapped(&self) -> usize {
        self.replaced.len()
    }

    /// The exact coefficients of a plane.
    pub(crate) fn row(&self, plane: PlaneId) -> Row {
        let first = self.first_side(plane.index());
        if plane == plane.unsided() { *first } else { first.flipped() }
    }

    /// The side of a plane with a positive first coefficient.
    fn first_side(&self, index: u32) -> &Row {
        &self.sides[self.kept[index as usize] as usize].0
    }

    /// The table of the planes in an order, which holds the number of each; the planes of some ids get those that they have in the table.
    pub(crate) fn into_table(self, order: &[u32], ids: &mut [PlaneId]) -> PlaneTable {
        let mut new_of_old = vec![0; order.len()];
        (0..).zip(order).for_each(|(new, old)| new_of_old[*old as usize] = new);
        let renumbered = |id: PlaneId| id.with_index(new_of_old[id.index() as usize]);
        let row = |side: usize| self.row(PlaneId::new(order[side / 2] as usize, !side.is_multiple_of(2)));
        ids.par_iter_mut().with_min_len(IDS_OF_CHUNK).for_each(|id| *id = renumbered(*id));
        PlaneTable {
            rows: (0..2 * order.len()).into_par_iter().with_min_len(CHUNK).map(row).collect(),
            replaced: self.replaced.iter().map(|(row, id)| (*row, renumbered(*id))).collect(),
            reach: self.reach,
            size: self.size,
            index: None,
        }
    }
}

impl PlaneId {
    /// The same side of the plane that has this index after `first` others.
    fn after(self, first: usize) -> Self {
        self.with_index(number32(self.index() as usize + first))
    }
}

/// The places of planes in the order of their numbers, with these, and the largest distance of any from the origin.
fn sort(sides: &[(Row, bool)], size: f64) -> (Vec<(u64, u32)>, f64) {
    // the part of the normal, and the distance
    let parts = |(row, _): &(Row, bool)| {
        let [x, y, z, d] = unit(row);
        ([x, y, z].iter().zip(WEIGHTS).map(|(v, w)| v * w).sum::<f64>(), d)
    };
    let parts: Vec<(f64, f64)> = sides.par_iter().with_min_len(CHUNK).map(parts).collect();
    let reach = parts.iter().map(|part| part.1.abs()).fold(0.0, f64::max);
    let largest = reach.max(size).max(f64::MIN_POSITIVE);
    // numbers that are not negative are in the order of their bits
    let number = |(place, (normal, d)): (usize, &(f64, f64))| {
        ((normal + d / largest * WEIGHTS[3]).abs().to_bits(), number32(place))
    };
    let mut sorted: Vec<(u64, u32)> = parts.par_iter().enumerate().with_min_len(CHUNK).map(number).collect();
    sort_by_number(&mut sorted, |plane| plane.0);
    (sorted, reach)
}

/// The different planes among some that follow one another.
#[derive(Default)]
struct Settled {
    /// The places of those that are kept.
    planes: Vec<u32>,
    /// For each plane given the side of the one that stands for it, by its place among those kept.
    ids: Vec<PlaneId>,
    /// Those that were replaced by another one, as in [`PlaneTable`].
    replaced: Vec<(Row, PlaneId)>,
}

impl Settled {
    fn replaced(&self, first: usize) -> impl Iterator<Item = (Row, PlaneId)> {
        self.replaced.iter().map(move |(row, id)| (*row, id.after(first)))
    }

    /// Adds planes that may be equal or near one another, and are near no others, in the [`settling_order`]: each that is not exact is taken for one
    /// before that it is near.
    fn add(&mut self, chain: &[(u64, u32)], sides: &[(Row, bool)], size: f64) {
        if let [(_, only)] = chain {
            self.ids.push(self.next());
            self.planes.push(*only);
            return;
        }
        let row = |place: u32| &sides[place as usize].0;
        if let Some(least) = least_of_equal(chain, row) {
            self.ids.extend(iter::repeat_n(self.next(), chain.len()));
            self.planes.push(least);
            return;
        }
        let groups = EqualPlanes::of(chain, row);
        let mut order: Vec<usize> = (0..groups.least.len()).collect();
        order.sort_by_cached_key(|group| settling_order(row(groups.least[*group])));
        let mut ids = vec![PlaneId(0); order.len()];
        let mut near = NearPlanes::new(size);
        for group in order {
            let row = row(groups.least[group]);
            let at = unit(row);
            let found = if is_exact(row) { None } else { near.find(&at) };
            ids[group] = found.unwrap_or_else(|| {
                let id = self.next();
                self.planes.push(groups.least[group]);
                near.insert(at, id);
                id
            });
            self.replaced.extend(found.map(|id| (*row, id)));
        }
        self.ids.extend(groups.of_plane.iter().map(|group| ids[*group as usize]));
    }

    /// The id of the plane that is kept next.
    fn next(&self) -> PlaneId {
        PlaneId::new(self.planes.len(), false)
    }
}

/// Of planes that are all exactly the same the place of the least row, as most are that are close to one another; nothing where they are not.
fn least_of_equal<'a>(chain: &[(u64, u32)], row: impl Fn(u32) -> &'a Row) -> Option<u32> {
    let (_, mut least) = *chain.first()?;
    for (_, place) in &chain[1..] {
        let (this, known) = (row(*place), row(least));
        if this != known && !(key(this) == key(known) && this.is_same_plane(known)) {
            return None;
        }
        if compare_coefficients(this, known).is_lt() {
            least = *place;
        }
    }
    Some(least)
}

/// Planes that are exactly the same, among some.
struct EqualPlanes {
    /// Of rows of different scale the place of the least, so that the order of the input does not matter.
    least: Vec<u32>,
    /// The group of each plane.
    of_plane: Vec<u32>,
}

impl EqualPlanes {
    fn of<'a>(chain: &[(u64, u32)], row: impl Fn(u32) -> &'a Row) -> Self {
        let mut groups = Self { least: Vec::new(), of_plane: Vec::with_capacity(chain.len()) };
        // by key the last group that has it, and for each group the one before it with the same key
        let mut by_key: FxHashMap<Key, u32> = FxHashMap::default();
        let mut before: Vec<Option<u32>> = Vec::new();
        let mut last: Option<(&Row, u32)> = None;
        for (_, place) in chain {
            let this = row(*place);
            let known = last.filter(|(other, _)| *other == this).map(|(_, group)| group);
            let group = known.unwrap_or_else(|| {
                let new = number32(groups.least.len());
                let entry = by_key.entry(key(this));
                let known = match &entry {
                    Entry::Occupied(last) => Some(*last.get()),
                    Entry::Vacant(_) => None,
                };
                let is_same = |group: &u32| row(groups.least[*group as usize]).is_same_plane(this);
                let mut with_key = iter::successors(known, |group| before[*group as usize]);
                with_key.find(is_same).unwrap_or_else(|| {
                    groups.least.push(*place);
                    before.push(known);
                    entry.insert_entry(new);
                    new
                })
            });
            let least = &mut groups.least[group as usize];
            if compare_coefficients(this, row(*least)).is_lt() {
                *least = *place;
            }
            groups.of_plane.push(group);
            last = Some((this, group));
        }
        groups
    }
}
