//! Boxes that are cut in two, the worst one first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::bounds;
use super::cut::best_cut;
use super::inside::Inside;
use super::polygons::Polygons;
use super::region::{Region, hull_volume};
use crate::tolerances::{FACE_OFFSET, WORTH_CUTTING};

/// Boxes that are cut at the same time, whatever the number of threads.
const AT_A_TIME: usize = 8;

/// A box in the queue, the one whose hull exceeds it most first.
struct Waiting {
    excess: f64,
    number: usize,
    region: Region,
}

impl Waiting {
    fn new(region: Region) -> Self {
        Self { excess: hull_volume(&region.points()) - region.filled, number: 0, region }
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.excess.total_cmp(&other.excess).then(other.number.cmp(&self.number))
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
pub(super) fn divided(polygons: Polygons, inside: &impl Inside, wanted: usize) -> Vec<Region> {
    let (low, high) = bounds(polygons.corners().iter().copied());
    // beyond everything, so that no polygon lies in a side
    let room = DVec3::splat(16.0 * FACE_OFFSET);
    let first = Waiting::new(Region::new(low - room, high + room, polygons, inside));
    let least = WORTH_CUTTING * first.excess.abs();
    let (mut waiting, mut done, mut number) = (BinaryHeap::from([first]), Vec::new(), 0);
    while waiting.len() + done.len() < wanted {
        let room = (wanted - waiting.len() - done.len()).min(AT_A_TIME);
        let taken: Vec<Waiting> = (0..room).map_while(|_| waiting.pop()).collect();
        if taken.is_empty() {
            break;
        }
        let cut: Vec<Cut> = taken.into_par_iter().with_max_len(1).map(|one| in_two(one, least, inside)).collect();
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
fn in_two(one: Waiting, least: f64, inside: &impl Inside) -> Cut {
    if one.excess <= least {
        return Cut::Whole(one);
    }
    let Some(cut) = best_cut(&one.region, inside) else { return Cut::Whole(one) };
    let parts = one.region.split(cut.axis, cut.at, inside);
    Cut::Parts(parts.into_iter().filter(|part| !part.is_empty()).map(Waiting::new).collect())
}
