//! Numbers that are close for what is close in space, so that what is used together lies together in memory.
//!
//! The order is that of cells along a curve through space (Morton 1966), and depends on where things are alone, not on the
//! order in which they were given.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::{PlaneId, PlaneTable};
use crate::base::{Bounds, sortable};

/// A number that is close for places close to each other, and depends on the place alone: the highest bits of its coordinates,
/// interleaved.
#[must_use]
pub fn curve_number(place: DVec3) -> u64 {
    let [x, y, z] = place.to_array().map(|v| spread(sortable(v) >> (64 - BITS)));
    x | y << 1 | z << 2
}

/// Number of bits of each coordinate: its sign, its exponent and the first nine of its mantissa.
const BITS: u32 = 21;

/// The last [`BITS`] bits of a number, two zeros after each.
pub(crate) fn spread(v: u64) -> u64 {
    let mut v = v & 0x1F_FFFF;
    v = (v | v << 32) & 0x001F_0000_0000_FFFF;
    v = (v | v << 16) & 0x001F_0000_FF00_00FF;
    v = (v | v << 8) & 0x100F_00F0_0F00_F00F;
    v = (v | v << 4) & 0x10C3_0C30_C30C_30C3;
    (v | v << 2) & 0x1249_2492_4924_9249
}

/// Renumbers the planes of a table by where the brushes are that have them, as far as these are bodies; other planes come last.
pub(crate) fn renumber_planes(table: &mut PlaneTable, planes: &mut [Vec<PlaneId>], bounds: &[Option<Bounds>]) {
    let mut order: Vec<(u64, u32)> = (0..)
        .zip(bounds)
        .filter_map(|(number, bounds): (u32, _)| bounds.map(|bounds| (curve_number(bounds.center()), number)))
        .collect();
    order.par_sort_unstable();
    let sorted_planes = |number: u32| {
        let mut sorted = planes[number as usize].clone();
        sorted.sort_unstable();
        sorted
    };
    for cell in order.chunk_by_mut(|a, b| a.0 == b.0).filter(|cell| cell.len() > 1) {
        cell.sort_by_cached_key(|(_, number)| sorted_planes(*number));
    }
    let mut new_of_old: Vec<u32> = vec![u32::MAX; table.len()];
    let mut count = 0;
    let mut number = |old: usize| {
        if new_of_old[old] == u32::MAX {
            new_of_old[old] = count;
            count += 1;
        }
    };
    let mut of_body: Vec<u32> = Vec::new();
    for (_, body) in order {
        of_body.clear();
        of_body.extend(planes[body as usize].iter().map(|plane| plane.index()));
        of_body.sort_unstable();
        of_body.iter().for_each(|old| number(*old as usize));
    }
    (0..table.len()).for_each(number);
    table.renumber(&new_of_old);
    let renumbered = |plane: PlaneId| plane.with_index(new_of_old[plane.index() as usize]);
    planes.par_iter_mut().with_min_len(256).flatten_iter().for_each(|plane| *plane = renumbered(*plane));
}
