//! The oracle for lattice scenes: unit cells, counted.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::{GridBox, SIZE};

/// A direction along an axis: `(axis, ±1)`.
type Direction = (usize, i32);
type Cell = [i32; 3];
/// An exposed side of a filled cell.
type Quad = (Cell, Direction);

/// The exposed surface of a union of lattice boxes.
///
/// Quads are glued so that two meet at an edge where they bound one wedge of filled cells: what a manifold split of
/// the boundary must come out as. Nothing is glued across an edge or a corner at which filled cells merely touch.
pub(crate) struct Voxels {
    /// Filled cells.
    pub(crate) cells: Vec<Cell>,
    /// Exposed sides with the lowest-ranked material there.
    quads: BTreeMap<Quad, u32>,
}

fn step(cell: Cell, (axis, sign): Direction) -> Cell {
    let mut moved = cell;
    moved[axis] += sign;
    moved
}

fn back((axis, sign): Direction) -> Direction {
    (axis, -sign)
}

fn directions() -> impl Iterator<Item = Direction> {
    (0..3).flat_map(|axis| [(axis, 1), (axis, -1)])
}

impl Voxels {
    /// `rank` orders materials: where sides overlap, the lowest wins.
    pub(crate) fn new(boxes: &[GridBox], rank: impl Fn(u32) -> u32) -> Self {
        let around =
            |cell: Cell| boxes.iter().filter(move |b| (0..3).all(|k| b.low[k] <= cell[k] && cell[k] < b.high[k]));
        let range = 0..SIZE;
        let all = range.clone().flat_map(|x| range.clone().flat_map(move |y| (0..SIZE).map(move |z| [x, y, z])));
        let cells: Vec<Cell> = all.filter(|cell| around(*cell).next().is_some()).collect();
        let filled: BTreeSet<Cell> = cells.iter().copied().collect();
        let mut quads = BTreeMap::new();
        for &cell in &cells {
            for direction in directions().filter(|d| !filled.contains(&step(cell, *d))) {
                // The neighbour is empty, so every box around the cell ends here.
                let materials = around(cell).map(|b| b.material(direction));
                let material = materials.min_by_key(|m| rank(*m)).expect("a filled cell lies in a box");
                quads.insert((cell, direction), material);
            }
        }
        Self { cells, quads }
    }

    /// Number of exposed sides across each axis.
    pub(crate) fn sides(&self) -> [usize; 3] {
        std::array::from_fn(|axis| self.quads.keys().filter(|(_, direction)| direction.0 == axis).count())
    }

    /// Number of exposed sides of a material across each axis.
    pub(crate) fn sides_of(&self, material: u32) -> [usize; 3] {
        let of = |axis| self.quads.iter().filter(|((_, d), m)| d.0 == axis && **m == material).count();
        std::array::from_fn(of)
    }

    /// Number of planar regions of one material, connected through edges.
    pub(crate) fn faces(&self) -> usize {
        let mut sets = Sets::new(self.quads.keys().copied());
        self.for_glued(|quad, other, _| {
            if quad.1 == other.1 && self.quads[&quad] == self.quads[&other] {
                sets.join(&quad, &other);
            }
        });
        sets.count()
    }

    /// Number of closed surfaces.
    pub(crate) fn components(&self) -> usize {
        let mut sets = Sets::new(self.quads.keys().copied());
        self.for_glued(|quad, other, _| sets.join(&quad, &other));
        sets.count()
    }

    /// Vertices − edges + quads of the glued surface.
    pub(crate) fn euler_characteristic(&self) -> i64 {
        let corners = self.quads.keys().flat_map(|quad| {
            let [s, t] = across(quad.1);
            [(1, 1), (1, -1), (-1, 1), (-1, -1)].map(|(a, b)| (*quad, corner(*quad, (s, a), (t, b))))
        });
        let mut sets = Sets::new(corners);
        self.for_glued(|quad, other, side| {
            let along = across(quad.1).into_iter().find(|axis| *axis != side.0).expect("two axes lie across");
            for sign in [1, -1] {
                let at = corner(quad, side, (along, sign));
                sets.join(&(quad, at), &(other, at));
            }
        });
        // four edges a quad, each shared by two
        sets.count() as i64 - self.quads.len() as i64
    }

    /// Calls back with each quad, the one glued to it, and the side of the first across which that is.
    fn for_glued(&self, mut call: impl FnMut(Quad, Quad, Direction)) {
        for &(cell, direction) in self.quads.keys() {
            for side in directions().filter(|side| side.0 != direction.0) {
                // Turn through filled cells until a side is exposed.
                let next = step(cell, side);
                let diagonal = step(next, direction);
                let candidates = [(cell, side), (next, direction), (diagonal, back(side))];
                let is_filled = |c: Cell| self.cells.binary_search(&c).is_ok();
                let turned = if !is_filled(next) { 0 } else { 1 + usize::from(is_filled(diagonal)) };
                call((cell, direction), candidates[turned], side);
            }
        }
    }
}

/// The two axes across a direction.
fn across(direction: Direction) -> [usize; 2] {
    [(direction.0 + 1) % 3, (direction.0 + 2) % 3]
}

/// The lattice point at a corner of a quad.
fn corner((cell, direction): Quad, side: Direction, along: Direction) -> Cell {
    let mut at = cell;
    for (axis, sign) in [direction, side, along] {
        at[axis] += i32::from(sign > 0);
    }
    at
}

/// Disjoint sets.
struct Sets<T> {
    number: BTreeMap<T, usize>,
    parent: Vec<usize>,
}

impl<T: Ord> Sets<T> {
    fn new(items: impl Iterator<Item = T>) -> Self {
        let number: BTreeMap<T, usize> = items.enumerate().map(|(k, item)| (item, k)).collect();
        let parent = (0..number.len()).collect();
        Self { number, parent }
    }

    fn root(&mut self, mut k: usize) -> usize {
        while self.parent[k] != k {
            self.parent[k] = self.parent[self.parent[k]];
            k = self.parent[k];
        }
        k
    }

    fn join(&mut self, a: &T, b: &T) {
        let (a, b) = (self.number[a], self.number[b]);
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a] = b;
    }

    fn count(&self) -> usize {
        self.parent.iter().enumerate().filter(|(k, parent)| k == *parent).count()
    }
}
