//! Boxes that are cut in two, the worst one first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use planecut_kernel::DVec3;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::bounds;
use super::cut::{best_cut, middle_cut};
use super::inside::Inside;
use super::polygons::Polygons;
use super::region::{Region, hull_volume};
use crate::tolerances::{FACE_OFFSET, WORTH_CUTTING};

/// Boxes that are cut at the same time, whatever the number of threads.
const AT_A_TIME: usize = 8;

/// Maximum number of boxes beyond those that are wanted: then something is not as it should be.
const MOST_MORE: usize = 1 << 15;

/// When boxes are small enough.
pub(super) struct Wanted<'a> {
    /// How many boxes there are to be, about.
    pub(super) pieces: usize,
    /// Whether the hull of what a box holds reaches where nothing may be; such boxes are cut however many there are.
    pub(super) is_blocked: &'a (dyn Fn(&Region) -> bool + Sync),
}

/// A box in the queue, those that are blocked first, then the one whose hull exceeds it most.
struct Waiting {
    is_blocked: bool,
    excess: f64,
    number: usize,
    region: Region,
}

impl Waiting {
    fn new(region: Region, wanted: &Wanted<'_>) -> Self {
        let is_blocked = (wanted.is_blocked)(&region);
        Self { is_blocked, excess: hull_volume(&region.points()) - region.filled, number: 0, region }
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        let blocked_first = self.is_blocked.cmp(&other.is_blocked);
        blocked_first.then(self.excess.total_cmp(&other.excess)).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

/// Boxes that together hold all of a surface and what it bounds.
pub(super) fn divided(polygons: Polygons, inside: &impl Inside, wanted: &Wanted<'_>) -> Vec<Region> {
    let (low, high) = bounds(polygons.corners().iter().copied());
    // beyond everything, so that no polygon lies in a side
    let room = DVec3::splat(16.0 * FACE_OFFSET);
    let first = Waiting::new(Region::new(low - room, high + room, polygons, inside), wanted);
    let least = WORTH_CUTTING * first.excess.abs();
    let (mut waiting, mut done, mut number) = (BinaryHeap::from([first]), Vec::new(), 0);
    loop {
        let count = waiting.len() + done.len();
        let room = wanted.pieces.saturating_sub(count).min(AT_A_TIME);
        let may_be_taken = |k: usize, one: &Waiting| k < room || one.is_blocked && count < wanted.pieces + MOST_MORE;
        let take = |k: usize| waiting.peek().is_some_and(|one| may_be_taken(k, one)).then(|| waiting.pop()).flatten();
        let taken: Vec<Waiting> = (0..AT_A_TIME).map_while(take).collect();
        if taken.is_empty() {
            break;
        }
        let cut: Vec<Cut> =
            taken.into_par_iter().with_max_len(1).map(|one| in_two(one, least, inside, wanted)).collect();
        for parts in cut {
            match parts {
                Cut::Parts(parts) => {
                    waiting.extend(parts.into_iter().zip(number..).map(|(part, number)| Waiting { number, ..part }));
                }
                Cut::Whole(whole) => done.push(whole),
            }
            number += 2;
        }
    }
    done.into_iter().chain(waiting.into_sorted_vec()).map(|one| one.region).collect()
}

/// What became of a box.
enum Cut {
    Parts(Vec<Waiting>),
    Whole(Waiting),
}

/// The parts of a box that are not empty; the box itself where it is not worth cutting.
fn in_two(one: Waiting, least: f64, inside: &impl Inside, wanted: &Wanted<'_>) -> Cut {
    job::check();
    if one.excess <= least && !one.is_blocked {
        return Cut::Whole(one);
    }
    // to get out of where nothing may be, halves do better than slices whose hulls are small
    let cut = if one.is_blocked { middle_cut(&one.region) } else { best_cut(&one.region, inside) };
    let Some(cut) = cut else { return Cut::Whole(one) };
    let parts = one.region.split(cut.axis, cut.at, inside);
    Cut::Parts(parts.into_iter().filter(|part| !part.is_empty()).map(|part| Waiting::new(part, wanted)).collect())
}
