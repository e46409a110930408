//! Numbers that are close for what is close in space, so that what is used together lies together in memory.
//!
//! The order is that of cells along a curve through space (Morton 1966), and depends on where things are alone, not on the
//! order in which they were given.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::PlaneId;
use crate::base::{Bounds, map_chunks, sort_by_number, sortable};
use crate::ids::number32;

/// Least number of brushes that a thread looks at in a row.
const BRUSHES_OF_CHUNK: usize = 64;

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

/// The numbers of planes, of which there are `count`, in the order of the brushes that have them, as far as these are bodies; other planes come last. `brushes` is the number of
/// brushes, `bounds` gives the box of each that is a body, and `planes_of` its planes.
pub(crate) fn in_order_of_space<'a>(
    count: usize,
    brushes: usize,
    bounds: impl Fn(usize) -> Option<&'a Bounds> + Sync,
    planes_of: impl Fn(usize) -> &'a [PlaneId] + Sync,
) -> Vec<u32> {
    let place = |brush: usize| bounds(brush).map(|bounds| (curve_number(bounds.center()), number32(brush)));
    let mut brushes: Vec<(u64, u32)> =
        (0..brushes).into_par_iter().with_min_len(BRUSHES_OF_CHUNK).filter_map(place).collect();
    sort_by_number(&mut brushes, |brush| brush.0);
    let add_planes = |brush: u32, all: &mut Vec<u32>| {
        let first = all.len();
        all.extend(planes_of(brush as usize).iter().map(|plane| plane.index()));
        all[first..].sort_unstable();
    };
    let sorted_planes = |brush: u32| {
        let mut planes = planes_of(brush as usize).to_vec();
        planes.sort_unstable();
        planes
    };
    for cell in brushes.chunk_by_mut(|a, b| a.0 == b.0).filter(|cell| cell.len() > 1) {
        cell.sort_by_cached_key(|(_, brush)| sorted_planes(*brush));
    }
    let (parts, _) = map_chunks(&brushes, BRUSHES_OF_CHUNK, |chunk| {
        let mut planes = Vec::new();
        chunk.iter().for_each(|(_, brush)| add_planes(*brush, &mut planes));
        planes
    });
    let (mut order, mut is_there) = (Vec::with_capacity(count), vec![false; count]);
    for plane in parts.into_iter().flatten().chain(0..number32(count)) {
        if !std::mem::replace(&mut is_there[plane as usize], true) {
            order.push(plane);
        }
    }
    order
}
