//! A grid of cubes, voxels, over all of a solid, and sets of its voxels.

use planecut_csg::stages::Bounds;
use planecut_kernel::DVec3;

/// Voxels in a word of a set.
const WORD: usize = 64;

/// Where the voxels are.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub(super) origin: DVec3,
    /// The length of a voxel's edge.
    pub(super) step: f64,
    /// How many there are along each axis.
    pub(super) size: [usize; 3],
}

impl Grid {
    /// The grid of voxels that covers a box and a margin around it of a number of voxels.
    pub(super) fn around(bounds: &Bounds, step: f64, margin: usize) -> Self {
        let size = (bounds.max - bounds.min).to_array().map(|extent| (extent / step).ceil() as usize + 2 * margin);
        Self { origin: bounds.min - DVec3::splat(margin as f64 * step), step, size }
    }

    /// How many voxels such a grid has, in floating point: there may be more than an integer counts.
    pub(super) fn count_around(bounds: &Bounds, step: f64, margin: usize) -> f64 {
        let along = |extent: f64| (extent / step).ceil() + 2.0 * margin as f64;
        (bounds.max - bounds.min).to_array().into_iter().map(along).product()
    }

    /// The box from one corner of voxels to another. Voxels that share a side have the same number there.
    pub(super) fn bounds(&self, from: [usize; 3], to: [usize; 3]) -> Bounds {
        let at = |corner: [usize; 3]| self.origin + DVec3::from_array(corner.map(|k| k as f64)) * self.step;
        Bounds { min: at(from), max: at(to) }
    }

    /// The voxels, from the first to before the last along an axis, that may touch an interval, widened by half a voxel.
    pub(super) fn span(&self, axis: usize, low: f64, high: f64) -> (usize, usize) {
        let number = |value: f64| (value - self.origin[axis]) / self.step;
        let last = self.size[axis];
        ((number(low) - 0.5).max(0.0) as usize, ((number(high) + 1.5).max(0.0) as usize).min(last))
    }
}

/// A set of voxels: a bit for each, in rows along the first axis that begin with a new word.
#[derive(Debug, Clone)]
pub(super) struct Voxels {
    pub(super) size: [usize; 3],
    /// Words of a row.
    pub(super) row: usize,
    pub(super) words: Vec<u64>,
}

impl Voxels {
    pub(super) fn none(size: [usize; 3]) -> Self {
        let row = size[0].div_ceil(WORD);
        Self { size, row, words: vec![0; row * size[1] * size[2]] }
    }

    /// Words of all voxels with one number along the last axis.
    pub(super) fn layer(&self) -> usize {
        (self.row * self.size[1]).max(1)
    }

    /// The voxels of a row.
    pub(super) fn row(&self, y: usize, z: usize) -> &[u64] {
        let first = (z * self.size[1] + y) * self.row;
        &self.words[first..first + self.row]
    }

    /// Whether a voxel is in the set; those beyond the grid are not.
    pub(super) fn has(&self, [x, y, z]: [usize; 3]) -> bool {
        x < self.size[0] && y < self.size[1] && z < self.size[2] && is_set(self.row(y, z), x)
    }

    /// All others of the grid.
    pub(super) fn complement(mut self) -> Self {
        let rest = self.size[0] % WORD;
        for row in self.words.chunks_mut(self.row.max(1)) {
            row.iter_mut().for_each(|word| *word = !*word);
            if let Some(last) = row.last_mut().filter(|_| rest > 0) {
                *last &= (1 << rest) - 1;
            }
        }
        self
    }

    /// Adds a voxel.
    pub(super) fn add(&mut self, [x, y, z]: [usize; 3]) {
        self.words[(z * self.size[1] + y) * self.row + x / WORD] |= 1 << (x % WORD);
    }
}

/// Whether a bit of a row is set.
pub(super) fn is_set(row: &[u64], x: usize) -> bool {
    row[x / WORD] >> (x % WORD) & 1 == 1
}

/// Sets a bit of a row.
pub(super) fn set(row: &mut [u64], x: usize) {
    row[x / WORD] |= 1 << (x % WORD);
}
