//! Which tiles there are, and where their walls are.
//!
//! A tile of height `k` holds the blocks whose places are the same but for the lowest `k` bits. So tiles of one height are of like size, and
//! their walls go through all of the model as those of blocks do.

use std::ops::Range;

use super::{TileLeaf, TilesError};

/// A tile of one height.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tile {
    /// Its place among the tiles of its height.
    pub(super) place: [u32; 3],
    /// Its children among the tiles of the height below; of a leaf the one number of its block.
    pub(super) children: Range<usize>,
}

/// Tiles by height, leaves first.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) heights: Vec<Vec<Tile>>,
}

impl Tree {
    /// The tree over blocks, of which numbers are given; there is one at least.
    pub(super) fn new(leaves: &[TileLeaf], numbers: &[usize]) -> Self {
        let tile = |leaf: &usize| Tile { place: leaves[*leaf].place, children: *leaf..*leaf + 1 };
        let mut tiles: Vec<Tile> = numbers.iter().map(tile).collect();
        // children of one tile follow one another
        tiles.sort_by_key(|tile| interleaved(tile.place));
        let mut heights = vec![tiles];
        while let Some(below) = heights.last().filter(|below| below.len() > 1) {
            let mut start = 0;
            let parents = below.chunk_by(|a, b| above(a.place) == above(b.place)).map(|children| {
                start += children.len();
                Tile { place: above(children[0].place), children: start - children.len()..start }
            });
            let parents = parents.collect();
            heights.push(parents);
        }
        Self { heights }
    }

    /// How many tiles there are.
    pub(super) fn len(&self) -> usize {
        self.heights.iter().map(Vec::len).sum()
    }
}

fn above(place: [u32; 3]) -> [u32; 3] {
    place.map(|along| along >> 1)
}

/// The bits of all coordinates in turn: Morton's order.
fn interleaved(place: [u32; 3]) -> u128 {
    let bit = |at: u32, axis: usize| u128::from((place[axis] >> at) & 1) << (3 * at + axis as u32);
    (0..32).flat_map(|at| [0, 1, 2].map(|axis| bit(at, axis))).fold(0, |all, bit| all | bit)
}

/// Where walls across each axis are, and what they became as positions were rounded.
#[derive(Debug, Clone)]
pub(super) struct Walls {
    /// By the place of the block above the wall; `NAN` where no block is on either side.
    across: [Vec<f64>; 3],
}

/// The walls of a tile: below and above it across each axis.
pub(super) type TileWalls = [[Wall; 2]; 3];

/// A wall of a tile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wall {
    /// Its coordinate; `NAN` where no block ends.
    pub(super) at: f64,
    /// Whether rounding put it where another one is, so that coordinates do not tell which one a vertex is on.
    pub(super) is_shared: bool,
}

impl Walls {
    /// The walls of blocks.
    ///
    /// # Errors
    /// [`TilesError::Grid`] where these are not the blocks of one grid.
    pub(super) fn new(leaves: &[TileLeaf]) -> Result<Self, TilesError> {
        let wrong = |leaf: &TileLeaf, what| Err(TilesError::Grid { place: leaf.place, what });
        if let Some(pair) = leaves.windows(2).find(|pair| pair[0].place >= pair[1].place) {
            return wrong(
                &pair[1],
                "found it after one of the same place or a later one, expected places sorted and once each",
            );
        }
        let mut across = [const { Vec::<f64>::new() }; 3];
        for leaf in leaves {
            if !(leaf.min.is_finite() && leaf.max.is_finite() && leaf.min.cmple(leaf.max).all()) {
                return wrong(leaf, "found a box that is none, expected finite corners, the lesser one first");
            }
            for (axis, walls) in across.iter_mut().enumerate() {
                let place = leaf.place[axis] as usize;
                if place >= MOST_PLACES {
                    return wrong(leaf, "found a place beyond 2^20, expected a smaller grid");
                }
                walls.resize(walls.len().max(place + 2), f64::NAN);
                for (wall, at) in walls[place..place + 2].iter_mut().zip([leaf.min[axis], leaf.max[axis]]) {
                    if !wall.is_nan() && *wall != at {
                        return wrong(leaf, "found a wall that is elsewhere in another block, expected one grid");
                    }
                    *wall = at + 0.0;
                }
            }
        }
        Ok(Self { across })
    }

    /// The walls of a tile of a height.
    pub(super) fn of_tile(&self, place: [u32; 3], height: usize) -> TileWalls {
        [0, 1, 2].map(|axis| {
            [0, 1].map(|side| {
                let at = |number: u32| {
                    let at = self.across[axis].get((number as usize) << height);
                    at.copied().unwrap_or(f64::NAN)
                };
                let number = place[axis] + side;
                let others = [number.wrapping_sub(1), number + 1]
                    .map(|other| if other == u32::MAX { f64::NAN } else { at(other) });
                Wall { at: at(number), is_shared: others.contains(&at(number)) }
            })
        })
    }

    /// Rounds all coordinates.
    pub(super) fn round(&mut self, rounded: impl Fn(f64) -> f64) {
        self.across.iter_mut().flatten().for_each(|at| *at = rounded(*at));
    }
}

/// No grid has more blocks along an axis.
const MOST_PLACES: usize = 1 << 20;

#[cfg(test)]
mod tests {
    use planecut_kernel::DVec3;

    use super::*;

    fn leaf(place: [u32; 3]) -> TileLeaf {
        let min = DVec3::from_array(place.map(f64::from));
        TileLeaf { place, min, max: min + 1.0 }
    }

    #[test]
    fn tiles_hold_eight_of_the_height_below_and_skip_what_is_empty() {
        let mut leaves = Vec::new();
        for x in 3..8 {
            for y in [1, 2, 9] {
                leaves.push(leaf([x, y, 4]));
            }
        }
        let all: Vec<usize> = (0..leaves.len()).collect();
        let tree = Tree::new(&leaves, &all);
        assert_eq!(tree.heights.iter().map(Vec::len).collect::<Vec<_>>(), [15, 9, 4, 2, 1]);
        for (height, tiles) in tree.heights.iter().enumerate().skip(1) {
            let mut next = 0;
            for tile in tiles {
                assert_eq!(tile.children.start, next);
                next = tile.children.end;
                for child in &tree.heights[height - 1][tile.children.clone()] {
                    assert_eq!(child.place.map(|along| along / 2), tile.place);
                }
            }
            assert_eq!(next, tree.heights[height - 1].len());
        }
        let walls = Walls::new(&leaves).expect("a grid");
        let of_tile = walls.of_tile([1, 0, 0], 1);
        assert!(of_tile[0][0].at.is_nan() && of_tile[0][1].at == 4.0);
        assert!(of_tile[1][0].at.is_nan() && of_tile[1][1].at == 2.0);
        let of_tile = walls.of_tile([2, 4, 2], 1);
        assert_eq!(
            of_tile.map(|pair| pair.map(|wall| wall.at.to_bits())),
            [[4.0, 6.0], [f64::NAN, 10.0], [4.0, f64::NAN]].map(|pair| pair.map(f64::to_bits))
        );
        assert!(!of_tile[0][0].is_shared);
        let mut rounded = walls;
        rounded.round(|at| (at / 8.0).round() * 8.0);
        assert!(rounded.of_tile([2, 4, 2], 1)[0].iter().all(|wall| wall.is_shared || wall.at == 0.0));
    }

    #[test]
    fn blocks_that_are_no_grid_are_refused() {
        let refused = |leaves: &[TileLeaf], words: &str| {
            let message = Walls::new(leaves).expect_err(words).to_string();
            assert!(message.contains(words), "{message}");
        };
        refused(&[leaf([1, 0, 0]), leaf([0, 0, 0])], "block (0, 0, 0): found it after");
        refused(&[leaf([1, 0, 0]), leaf([1, 0, 0])], "once each");
        let moved = TileLeaf { min: DVec3::new(1.25, 0.0, 0.0), ..leaf([1, 0, 0]) };
        refused(&[leaf([0, 0, 0]), moved], "elsewhere");
        refused(&[TileLeaf { max: DVec3::NAN, ..leaf([0, 0, 0]) }], "box");
        refused(&[leaf([0, 0, 0]), leaf([1 << 20, 0, 0])], "smaller grid");
    }
}
