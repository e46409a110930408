//! Voxels in blocks of two by two by two, these in blocks again: what a body may touch is found without looking at all.

use planecut_csg::stages::Bounds;
use planecut_kernel::DVec3;

use super::grid::{Grid, Voxels};

/// A set of voxels, and blocks of them.
#[derive(Debug, Clone)]
pub(super) struct Octree {
    grid: Grid,
    /// From single voxels to one block that holds all of them.
    levels: Vec<Level>,
}

/// Blocks of one size.
#[derive(Debug, Clone)]
struct Level {
    /// Those with some voxel of the set, and those with no other.
    any: Voxels,
    all: Voxels,
}

/// A convex body in floating point: unit normals and offsets of its planes, and a box around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body<'a> {
    pub(super) planes: &'a [(DVec3, f64)],
    pub(super) bounds: &'a Bounds,
}

impl Octree {
    pub(super) fn new(grid: Grid, voxels: Voxels) -> Self {
        let mut levels = vec![Level { any: voxels.clone(), all: voxels }];
        while let Some(last) = levels.last().filter(|last| last.any.size.iter().any(|size| *size > 1)) {
            let next = Level { any: last.any.halved(false), all: last.all.halved(true) };
            levels.push(next);
        }
        Self { grid, levels }
    }

    /// Whether all of the grid holds a box.
    pub(super) fn covers(&self, bounds: &Bounds) -> bool {
        let grid = self.grid.bounds([0; 3], self.grid.size);
        bounds.min.cmpge(grid.min).all() && bounds.max.cmple(grid.max).all()
    }

    /// Whether some block of voxels of the set has interior in common with a body: by its planes where these tell, otherwise by a test that is given its box.
    pub(super) fn meets(&self, body: &Body<'_>, shares_interior: &mut impl FnMut(&Bounds) -> bool) -> bool {
        let mut planes = vec![Vec::new(); self.levels.len()];
        planes.push(body.planes.to_vec());
        self.meets_at(self.levels.len() - 1, [0; 3], body.bounds, &mut planes, shares_interior)
    }

    /// The same within a block; for the levels above it `planes` are those that cross the block there that it is in.
    fn meets_at(
        &self,
        number: usize,
        place: [usize; 3],
        within: &Bounds,
        planes: &mut [Vec<(DVec3, f64)>],
        shares_interior: &mut impl FnMut(&Bounds) -> bool,
    ) -> bool {
        let level = &self.levels[number];
        if !level.any.has(place) {
            return false;
        }
        let bounds = self.block(number, place);
        if bounds.min.cmpge(within.max).any() || bounds.max.cmple(within.min).any() {
            return false;
        }
        let (own, above) = planes.split_at_mut(number + 1);
        if !crossing(&above[0], &bounds, &mut own[number]) {
            return false;
        }
        if own[number].is_empty() {
            return true;
        }
        if level.all.has(place) {
            return shares_interior(&bounds);
        }
        (0..8).any(|k| {
            let inner = std::array::from_fn(|axis| 2 * place[axis] + (k >> axis & 1));
            self.meets_at(number - 1, inner, within, planes, shares_interior)
        })
    }

    fn block(&self, level: usize, place: [usize; 3]) -> Bounds {
        let corner =
            |more: usize| std::array::from_fn(|axis| ((place[axis] + more) << level).min(self.grid.size[axis]));
        self.grid.bounds(corner(0), corner(1))
    }
}

/// The planes of which it is not sure that they have all of a box inside; false where one is sure to have all of it outside.
fn crossing(planes: &[(DVec3, f64)], bounds: &Bounds, found: &mut Vec<(DVec3, f64)>) -> bool {
    found.clear();
    for (normal, offset) in planes {
        let (low, high) = bounds.extent_along(*normal, *offset);
        if low > 0.0 {
            return false;
        }
        if high >= 0.0 {
            found.push((*normal, *offset));
        }
    }
    true
}

impl Voxels {
    /// Blocks of eight of which some voxel is in the set, or all are; what is beyond the grid is not in the set.
    fn halved(&self, all: bool) -> Self {
        let mut halved = Self::none(self.size.map(|size| size.div_ceil(2)));
        let [_, rows, layers] = halved.size;
        let beyond = vec![0; self.row];
        for z in 0..layers {
            for y in 0..rows {
                let four: [&[u64]; 4] = std::array::from_fn(|k| {
                    let (y, z) = (2 * y + (k & 1), 2 * z + (k >> 1));
                    if y < self.size[1] && z < self.size[2] { self.row(y, z) } else { &beyond[..] }
                });
                let first = (z * rows + y) * halved.row;
                for k in 0..self.row {
                    let words = four.map(|row| row[k]).into_iter();
                    let pairs = if all {
                        let word = words.fold(u64::MAX, |all, word| all & word);
                        word & word >> 1
                    } else {
                        let word = words.fold(0, |any, word| any | word);
                        word | word >> 1
                    };
                    halved.words[first + k / 2] |= u64::from(even_bits(pairs)) << (32 * (k % 2));
                }
            }
        }
        halved
    }
}

/// Every second bit of a word, from the lowest on.
fn even_bits(word: u64) -> u32 {
    let mut bits = word & 0x5555_5555_5555_5555;
    bits = (bits | bits >> 1) & 0x3333_3333_3333_3333;
    bits = (bits | bits >> 2) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits >> 4) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits >> 8) & 0x0000_ffff_0000_ffff;
    (bits | bits >> 16) as u32
}
