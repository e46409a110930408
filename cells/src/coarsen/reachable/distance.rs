//! What lies within a distance of voxels.

use planecut_parallel::prelude::*;

use super::grid::{Voxels, is_set, set};

/// A square that does not matter. Numbers with a sign: the least of two takes one instruction on every x86-64 processor.
const FAR: i16 = i16::MAX;

/// The voxels whose middles are no farther from that of some voxel of a set than the root of `most`, in voxels.
///
/// Squared distances are made one axis after another (Felzenszwalb, Huttenlocher 2012), only as far as they matter: then a window along
/// each axis, a few instructions for many voxels, is faster than lower envelopes of parabolas. Rows without any voxel are passed over.
pub(super) fn near(voxels: &Voxels, most: i16) -> Voxels {
    let [width, rows, layers] = voxels.size;
    let reach = usize::from(most.unsigned_abs().isqrt());
    let window = |middle: usize, count: usize| middle.saturating_sub(reach)..(middle + reach + 1).min(count);
    let is_used = |y: usize, z: usize| voxels.row(y, z).iter().any(|word| *word != 0);
    // of each voxel the squared distance in its layer
    let mut squares = vec![FAR; width * rows * layers];
    squares.par_chunks_mut(width * rows).enumerate().for_each_init(Vec::new, |along: &mut Vec<i16>, (z, layer)| {
        let used: Vec<usize> = (0..rows).filter(|y| is_used(*y, z)).collect();
        along.clear();
        along.resize(width * used.len(), FAR);
        for (y, along) in used.iter().zip(along.chunks_mut(width)) {
            along_row(voxels.row(*y, z), reach, along);
        }
        for (y, squares) in layer.chunks_mut(width).enumerate() {
            let window = window(y, rows);
            let first = used.partition_point(|other| *other < window.start);
            let near = used[first..].iter().take_while(|other| **other < window.end);
            for (other, along) in near.zip(along[first * width..].chunks(width)) {
                lower(squares, along, other.abs_diff(y));
            }
        }
    });
    let is_near_used: Vec<bool> = (0..rows * layers)
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|place| window(place % rows, rows).any(|y| is_used(y, place / rows)))
        .collect();
    let mut found = Voxels::none(voxels.size);
    let (row, layer) = (found.row, found.layer());
    found.words.par_chunks_mut(layer).enumerate().for_each_init(
        || vec![FAR; width],
        |own, (z, words)| {
            for y in 0..rows {
                own.fill(FAR);
                for other in window(z, layers).filter(|z| is_near_used[z * rows + y]) {
                    let place = (other * rows + y) * width;
                    lower(own, &squares[place..place + width], other.abs_diff(z));
                }
                let words = &mut words[y * row..(y + 1) * row];
                own.iter().enumerate().filter(|(_, square)| **square <= most).for_each(|(x, _)| set(words, x));
            }
        },
    );
    found
}

/// Squared distances within a row.
fn along_row(row: &[u64], reach: usize, squares: &mut [i16]) {
    let square = |distance: usize| if distance <= reach { (distance * distance) as i16 } else { FAR };
    let mut last = None;
    for (x, found) in squares.iter_mut().enumerate() {
        if is_set(row, x) {
            last = Some(x);
        }
        *found = last.map_or(FAR, |last| square(x - last));
    }
    last = None;
    for (x, found) in squares.iter_mut().enumerate().rev() {
        if is_set(row, x) {
            last = Some(x);
        }
        *found = last.map_or(*found, |last| square(last - x).min(*found));
    }
}

/// Lowers squared distances to those by way of another row, some voxels away.
fn lower(squares: &mut [i16], others: &[i16], away: usize) {
    let square = (away * away) as i16;
    for (own, other) in squares.iter_mut().zip(others) {
        *own = (*own).min(other.saturating_add(square));
    }
}
