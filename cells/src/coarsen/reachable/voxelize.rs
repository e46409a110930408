//! The voxels that triangles touch.

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::grid::{Grid, Voxels, set};

/// Edge of the cubes of voxels that are filled as one.
const BLOCK: usize = 4;
/// Layers that are filled together.
const LAYERS: usize = 8;
/// How much larger voxels are taken, relatively: more than the rounding of all that is computed of them.
const WIDER: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// All voxels that some triangle touches, and none that is farther from all than rounding.
///
/// A triangle and a cube have no point in common where one of 13 directions separates them (Akenine-Möller 2001).
pub(super) fn touched(grid: &Grid, triangles: &[[DVec3; 3]]) -> Voxels {
    let mut voxels = Voxels::none(grid.size);
    let (row, rows, layer) = (voxels.row, grid.size[1], voxels.layer());
    let spans: Vec<(usize, usize)> =
        triangles.iter().map(|[a, b, c]| grid.span(2, a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z))).collect();
    let chunks = voxels.words.par_chunks_mut(LAYERS * layer).enumerate();
    chunks.for_each(|(chunk, words)| {
        let (first, last) = (chunk * LAYERS, (chunk * LAYERS + words.len() / layer).min(grid.size[2]));
        for (triangle, (low, high)) in triangles.iter().zip(&spans) {
            for z in first.max(*low)..last.min(*high) {
                let layer = &mut words[(z - first) * rows * row..];
                add(grid, triangle, z, layer, row);
            }
        }
    });
    voxels
}

/// Adds all voxels of blocks whose middles are filled.
pub(super) fn fill(voxels: &mut Voxels, grid: &Grid, is_filled: &(dyn Fn(DVec3) -> bool + Sync)) {
    let [width, rows, layers] = grid.size;
    let layer = voxels.layer();
    let row = voxels.row;
    voxels.words.par_chunks_mut(BLOCK * layer).enumerate().for_each(|(block, words)| {
        let z = block * BLOCK;
        for (y, x) in (0..rows).step_by(BLOCK).flat_map(|y| (0..width).step_by(BLOCK).map(move |x| (y, x))) {
            let last = [(x + BLOCK).min(width), (y + BLOCK).min(rows), (z + BLOCK).min(layers)];
            if is_filled(grid.bounds([x, y, z], last).center()) {
                for (z, y) in (0..last[2] - z).flat_map(|z| (y..last[1]).map(move |y| (z, y))) {
                    let first = z * layer + y * row;
                    (x..last[0]).for_each(|x| set(&mut words[first..first + row], x));
                }
            }
        }
    });
}

/// The voxels of a layer that a triangle touches.
fn add(grid: &Grid, triangle: &[DVec3; 3], z: usize, layer: &mut [u64], row: usize) {
    let [a, b, c] = *triangle;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let half = 0.5 * grid.step * WIDER;
    let directions = Directions::of(triangle, half);
    let (first, last) = grid.span(1, low.y, high.y);
    for y in first..last {
        let middle = |x: usize| grid.origin + (DVec3::new(x as f64, y as f64, z as f64) + 0.5) * grid.step;
        let (begin, end) = grid.span(0, low.x, high.x);
        let (begin, end) = directions.within(middle(begin), grid.step, begin, end);
        let words = &mut layer[y * row..(y + 1) * row];
        (begin..end).filter(|x| !directions.separate(middle(*x))).for_each(|x| set(words, x));
    }
}

/// Directions in which a triangle and cubes of a size are compared: for each the interval in which the middle of a cube is that touches it.
struct Directions {
    all: [(DVec3, f64, f64); 13],
}

impl Directions {
    fn of(triangle: &[DVec3; 3], half: f64) -> Self {
        let [a, b, c] = *triangle;
        let edges = [b - a, c - b, a - c];
        let normal = edges[0].cross(edges[1]);
        let crossed = |k: usize| edges[k / 3].cross(DVec3::AXES[k % 3]);
        let all = std::array::from_fn(|k| {
            let direction = match k {
                0 => normal,
                1..=3 => DVec3::AXES[k - 1],
                _ => crossed(k - 4),
            };
            let reach = half * direction.abs().element_sum();
            let along = [a, b, c].map(|p| direction.dot(p));
            let (low, high) = (along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2]));
            (direction, low - reach, high + reach)
        });
        Self { all }
    }

    /// Whether a cube around a point has nothing in common with the triangle.
    fn separate(&self, middle: DVec3) -> bool {
        self.all.iter().any(|(direction, low, high)| {
            let at = direction.dot(middle);
            at < *low || at > *high
        })
    }

    /// Those of a row of cubes, from the first to before the last, whose middles the first direction, across the triangle, leaves: of a
    /// large triangle a few in each row.
    fn within(&self, middle: DVec3, step: f64, first: usize, last: usize) -> (usize, usize) {
        let (direction, low, high) = self.all[0];
        let (at, slope) = (direction.dot(middle), direction.x * step);
        let ends = [(low - at) / slope, (high - at) / slope];
        let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        if !from.is_finite() || !to.is_finite() {
            return (first, last);
        }
        // one more on each side, for rounding
        let from = first + (from - 1.0).clamp(0.0, (last - first) as f64) as usize;
        let to = first + (to + 2.0).clamp(0.0, (last - first) as f64) as usize;
        (from, to)
    }
}
