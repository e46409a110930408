//! Where blocks end: at walls across the axes that go through all of the model, so that the edges on a wall end in the same
//! points on both sides.

use planecut_kernel::{DVec3, HalfSpace};
use rustc_hash::FxHashMap;

use crate::base::Bounds;
use crate::model::{Brush, BrushFace, MaterialId};
use crate::tolerances::SNAP_TOLERANCE;

/// Walls lie between multiples of a step so short that no grid of a few thousand steps has planes or corners there.
const STEPS: f64 = (1 << 18) as f64;

/// The shortest step, relative to the largest coordinate: many times the tolerance of planes that are nearly the same.
const LEAST_STEP: f64 = 4096.0 * SNAP_TOLERANCE;

/// Where between them, across each axis: fractions without a simple ratio, so that a plane along a diagonal of such a grid does not go
/// through the line in which two walls cross.
const FRACTIONS: [f64; 3] = [521.0 / 1024.0, 365.0 / 1024.0, 619.0 / 1024.0];

/// No more walls are put across an axis.
const MOST_WALLS: usize = 2047;

/// The place of a block along each axis; ordered by it.
pub type BlockPlace = [u32; 3];

/// The sides of a block, as bits: where a brush reaches over its box. The side of smaller coordinates across x, of larger, then y and z.
pub type BlockSides = u8;

/// The walls across each axis, ascending; the first and the last are the ends of the model.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BlockGrid {
    walls: [Vec<f64>; 3],
}

impl BlockGrid {
    /// Walls between which lie at most `most` of some points within a box, where walls can part them.
    pub(super) fn new(all: &Bounds, points: &[DVec3], most: usize) -> Self {
        let mut grid = Self { walls: [0, 1, 2].map(|axis| vec![all.min[axis], all.max[axis]]) };
        // far from the origin a wall next to a plane would be taken for it
        let least = (LEAST_STEP * all.min.abs().max(all.max.abs()).max_element()).log2().ceil().exp2();
        let steps = (all.max - all.min).to_array().map(|extent| (extent / STEPS).log2().floor().exp2().max(least));
        while let Some((axis, wall)) = grid.next_wall(points, most, steps) {
            let at = grid.walls[axis].partition_point(|other| *other < wall);
            grid.walls[axis].insert(at, wall);
        }
        grid
    }

    /// A wall through the fullest block, near the median of what lies in it along its longest axis that can be parted.
    fn next_wall(&self, points: &[DVec3], most: usize, steps: [f64; 3]) -> Option<(usize, f64)> {
        let mut counts: FxHashMap<BlockPlace, usize> = FxHashMap::default();
        for point in points {
            *counts.entry(self.place(*point)).or_default() += 1;
        }
        let (fullest, count) = counts.into_iter().max_by_key(|(place, count)| (*count, *place))?;
        if count <= most {
            return None;
        }
        let block = self.bounds(fullest);
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| (block.max - block.min)[*b].total_cmp(&(block.max - block.min)[*a]));
        axes.into_iter().filter(|axis| self.walls[*axis].len() < MOST_WALLS).find_map(|axis| {
            let within = points.iter().filter(|point| self.place(**point) == fullest);
            let mut along: Vec<f64> = within.map(|point| point[axis]).collect();
            let half = along.len() / 2;
            let (_, median, _) = along.select_nth_unstable_by(half, f64::total_cmp);
            let wall = ((*median / steps[axis]).floor() + FRACTIONS[axis]) * steps[axis];
            let parts = along.iter().any(|at| *at < wall) && along.iter().any(|at| *at > wall);
            (parts && block.min[axis] < wall && wall < block.max[axis]).then_some((axis, wall))
        })
    }

    /// The coordinates of the walls across an axis, ascending, the ends of the model among them.
    #[must_use]
    pub fn walls(&self, axis: usize) -> &[f64] {
        &self.walls[axis]
    }

    /// The block that a point is in.
    fn place(&self, at: DVec3) -> BlockPlace {
        [0, 1, 2].map(|axis| {
            let walls = &self.walls[axis];
            let place = walls.partition_point(|wall| *wall <= at[axis]).clamp(1, walls.len() - 1) - 1;
            u32::try_from(place).expect("a few thousand walls")
        })
    }

    /// The box of a block.
    #[must_use]
    pub fn bounds(&self, place: BlockPlace) -> Bounds {
        let at = |next: usize| DVec3::from_array([0, 1, 2].map(|axis| self.walls[axis][place[axis] as usize + next]));
        Bounds { min: at(0), max: at(1) }
    }

    /// The blocks into which a brush with a box reaches, with the sides over which it reaches there.
    pub fn reached(&self, bounds: &Bounds) -> impl Iterator<Item = (BlockPlace, BlockSides)> + use<> {
        let is_empty = bounds.min.cmpgt(bounds.max).any();
        let (low, high) = if is_empty { ([1; 3], [0; 3]) } else { (self.place(bounds.min), self.place(bounds.max)) };
        let places = (low[0]..=high[0])
            .flat_map(move |x| (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z])));
        places.map(move |place| {
            let side = |axis: usize| {
                u8::from(place[axis] > low[axis]) << (2 * axis) | u8::from(place[axis] < high[axis]) << (2 * axis + 1)
            };
            (place, side(0) | side(1) | side(2))
        })
    }
}

/// Adds to a brush the walls of a block over which it reaches.
pub(super) fn add_walls(brush: &mut Brush, sides: BlockSides, block: &Bounds, material: MaterialId) {
    for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
        let walls = [(-unit, -block.min[axis]), (unit, block.max[axis])];
        for (end, (normal, offset)) in walls.into_iter().enumerate() {
            if sides >> (2 * axis + end) & 1 == 1 {
                let half_space = HalfSpace::new(normal, offset).expect("a wall within the model");
                brush.faces.push(BrushFace { half_space, material });
            }
        }
    }
}
