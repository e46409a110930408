//! What is connected to a corner of a grid.

use std::collections::VecDeque;

use super::grid::Voxels;

/// The voxels of a set that can be reached from the first voxel of the grid by steps within the set, to any of the 26 beside one.
pub(super) fn flooded(free: &Voxels) -> Voxels {
    let [_, rows, layers] = free.size;
    let mut reached = Voxels::none(free.size);
    if !free.has([0; 3]) {
        return reached;
    }
    reached.add([0; 3]);
    spread(&mut reached.words[..free.row], free.row(0, 0));
    let around = |(y, z): (usize, usize)| {
        let rows_beside = move |z| (y.saturating_sub(1)..(y + 2).min(rows)).map(move |y| (y, z));
        (z.saturating_sub(1)..(z + 2).min(layers)).flat_map(rows_beside)
    };
    // rows of which something may be reached that was not before
    let mut waiting: VecDeque<(usize, usize)> = around((0, 0)).collect();
    let mut is_waiting = vec![false; rows * layers];
    let mut entered = vec![0_u64; free.row];
    while let Some((y, z)) = waiting.pop_front() {
        is_waiting[z * rows + y] = false;
        entered.fill(0);
        for (y, z) in around((y, z)) {
            entered.iter_mut().zip(reached.row(y, z)).for_each(|(all, one)| *all |= one);
        }
        step_along(&mut entered);
        spread(&mut entered, free.row(y, z));
        if entered == reached.row(y, z) {
            continue;
        }
        let first = (z * rows + y) * free.row;
        reached.words[first..first + free.row].copy_from_slice(&entered);
        for (y, z) in around((y, z)) {
            if !std::mem::replace(&mut is_waiting[z * rows + y], true) {
                waiting.push_back((y, z));
            }
        }
    }
    reached
}

/// Adds the voxels beside those of a row.
fn step_along(row: &mut [u64]) {
    let mut carried = 0;
    for word in row.iter_mut() {
        let next = *word >> 63;
        *word |= *word << 1 | carried;
        carried = next;
    }
    let mut carried = 0;
    for word in row.iter_mut().rev() {
        let next = *word << 63;
        *word |= *word >> 1 | carried;
        carried = next;
    }
}

/// Spreads voxels of a row along the runs of free ones that they are in; those that are not free go.
fn spread(row: &mut [u64], free: &[u64]) {
    let mut carried = 0;
    for (word, free) in row.iter_mut().zip(free) {
        let seeds = (*word | carried) & free;
        // an addition carries from each seed to the end of its run
        *word = seeds | free & (free.wrapping_add(seeds) ^ free);
        carried = *word >> 63;
    }
    let mut carried = 0;
    for (word, free) in row.iter_mut().zip(free).rev() {
        let (seeds, free) = (((*word | carried) & free).reverse_bits(), free.reverse_bits());
        *word = (seeds | free & (free.wrapping_add(seeds) ^ free)).reverse_bits();
        carried = *word << 63;
    }
}
