//! Where blocks end: at walls across the axes that go through all of the model, so that the edges on a wall end in the same
//! points on both sides.

use planecut_kernel::{DVec3, HalfSpace};
use rustc_hash::FxHashMap;

use crate::base::Bounds;
use crate::body::{BrushBody, build_bodies};
use crate::model::{Brush, BrushFace, MaterialId};

/// Number of brushes that are built at a time to know where they are.
const AT_A_TIME: usize = 1 << 13;

/// Walls lie at odd multiples of a step so short that no grid of a few thousand steps has planes or corners there.
const STEPS: f64 = (1 << 18) as f64;

/// No more walls are put across an axis.
const MOST_WALLS: usize = 255;

/// The boxes of brushes, those of empty ones empty; the number of one that is not bounded where there is one.
pub(super) fn bounds_of(brushes: &[Brush]) -> Result<Vec<Bounds>, usize> {
    let mut bounds = Vec::with_capacity(brushes.len());
    for some in brushes.chunks(AT_A_TIME) {
        for body in build_bodies(some).bodies {
            bounds.push(match body {
                BrushBody::Bounded(body, _) => body.bounds,
                BrushBody::Empty => Bounds::EMPTY,
                BrushBody::Unbounded => return Err(bounds.len()),
            });
        }
    }
    Ok(bounds)
}

/// The walls across each axis, ascending; the first and the last are the ends of the model.
pub(super) struct Grid {
    walls: [Vec<f64>; 3],
}

/// The place of a cell along each axis; ordered by it.
type Place = [usize; 3];

/// A cell with the brushes that reach into it, ascending.
pub(super) struct Cell {
    pub(super) bounds: Bounds,
    pub(super) members: Vec<u32>,
}

impl Grid {
    /// Walls between which lie the middles of at most `most` brushes, where walls can part them.
    pub(super) fn new(bounds: &[Bounds], most: usize) -> Self {
        let all = bounds.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
        let mut grid = Self { walls: [0, 1, 2].map(|axis| vec![all.min[axis], all.max[axis]]) };
        let steps = (all.max - all.min).to_array().map(|extent| (extent / STEPS).log2().floor().exp2());
        let middles: Vec<DVec3> =
            bounds.iter().filter(|bounds| **bounds != Bounds::EMPTY).map(Bounds::center).collect();
        while let Some((axis, wall)) = grid.next_wall(&middles, most, steps) {
            let at = grid.walls[axis].partition_point(|other| *other < wall);
            grid.walls[axis].insert(at, wall);
        }
        grid
    }

    /// A wall through the fullest cell, near the median of what lies in it along its longest axis that can be parted.
    fn next_wall(&self, middles: &[DVec3], most: usize, steps: [f64; 3]) -> Option<(usize, f64)> {
        let mut counts: FxHashMap<Place, usize> = FxHashMap::default();
        for middle in middles {
            *counts.entry(self.place(*middle)).or_default() += 1;
        }
        let (fullest, count) = counts.into_iter().max_by_key(|(place, count)| (*count, *place))?;
        if count <= most {
            return None;
        }
        let cell = self.bounds(fullest);
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| (cell.max - cell.min)[*b].total_cmp(&(cell.max - cell.min)[*a]));
        axes.into_iter().filter(|axis| self.walls[*axis].len() < MOST_WALLS).find_map(|axis| {
            let within = middles.iter().filter(|middle| self.place(**middle) == fullest);
            let mut along: Vec<f64> = within.map(|middle| middle[axis]).collect();
            let half = along.len() / 2;
            let (_, median, _) = along.select_nth_unstable_by(half, f64::total_cmp);
            let wall = ((*median / steps[axis]).floor() + 0.5) * steps[axis];
            let parts = along.iter().any(|at| *at < wall) && along.iter().any(|at| *at > wall);
            (parts && cell.min[axis] < wall && wall < cell.max[axis]).then_some((axis, wall))
        })
    }

    /// The cell that a place is in.
    fn place(&self, at: DVec3) -> Place {
        [0, 1, 2].map(|axis| {
            let walls = &self.walls[axis];
            walls.partition_point(|wall| *wall <= at[axis]).clamp(1, walls.len() - 1) - 1
        })
    }

    fn bounds(&self, place: Place) -> Bounds {
        let at = |next: usize| DVec3::from_array([0, 1, 2].map(|axis| self.walls[axis][place[axis] + next]));
        Bounds { min: at(0), max: at(1) }
    }

    /// The cells into which a brush reaches, in their order.
    pub(super) fn cells(&self, bounds: &[Bounds]) -> impl Iterator<Item = Cell> + use<'_> {
        let mut members: FxHashMap<Place, Vec<u32>> = FxHashMap::default();
        for (member, bounds) in (0..).zip(bounds).filter(|(_, bounds)| **bounds != Bounds::EMPTY) {
            let (low, high) = (self.place(bounds.min), self.place(bounds.max));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        members.entry([x, y, z]).or_default().push(member);
                    }
                }
            }
        }
        let mut cells: Vec<(Place, Vec<u32>)> = members.into_iter().collect();
        cells.sort_unstable_by_key(|(place, _)| *place);
        cells.into_iter().map(|(place, members)| Cell { bounds: self.bounds(place), members })
    }
}

impl Cell {
    /// Adds the walls to a brush that it reaches over.
    pub(super) fn add_walls(&self, brush: &mut Brush, bounds: &Bounds, material: MaterialId) {
        let mut add = |normal: DVec3, offset: f64| {
            let half_space = HalfSpace::new(normal, offset).expect("a wall within the model");
            brush.faces.push(BrushFace { half_space, material });
        };
        for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
            if bounds.max[axis] > self.bounds.max[axis] {
                add(unit, self.bounds.max[axis]);
            }
            if bounds.min[axis] < self.bounds.min[axis] {
                add(-unit, -self.bounds.min[axis]);
            }
        }
    }
}
