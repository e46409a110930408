//! Where the half-edges of a region are: cells by size, so that each lies in few of them whatever its length.

use planecut_kernel::DVec2;
use rustc_hash::FxHashMap;

use crate::ids::HalfEdgeId;

/// A rectangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rectangle {
    pub(super) min: DVec2,
    pub(super) max: DVec2,
}

impl Rectangle {
    fn size(&self) -> f64 {
        (self.max - self.min).max_element()
    }
}

/// The smallest cells are of this power of two; what is smaller lies in these.
const LEAST_POWER: i32 = -200;

/// Cells farther from the origin than this number of them are one.
const MOST_CELLS: f64 = 1e18;

type Cell = [i64; 2];

/// Half-edges by the cell of the lower corner of their box: cells of one level are of one size, and no box is larger than the cells of
/// its level.
#[derive(Debug, Clone, Default)]
pub(super) struct BoxGrid {
    levels: Vec<Level>,
}

#[derive(Debug, Clone)]
struct Level {
    power: i32,
    /// How many cells go on a unit of length.
    cells_of_unit: f64,
    cells: FxHashMap<Cell, Vec<HalfEdgeId>>,
    count: usize,
}

impl Level {
    fn new(power: i32) -> Self {
        Self { power, cells_of_unit: 2.0_f64.powi(-power), cells: FxHashMap::default(), count: 0 }
    }

    /// The cell of a place.
    #[expect(clippy::cast_possible_truncation, reason = "`as` saturates, and what lies so far away shares a cell")]
    fn cell(&self, at: DVec2) -> Cell {
        // `as` rounds towards zero
        let floor = |value: f64| value as i64 - i64::from((value as i64) as f64 > value);
        let cell = at * self.cells_of_unit;
        // room for the cells beside
        [cell.x, cell.y].map(|value| floor(value.clamp(-MOST_CELLS, MOST_CELLS)))
    }
}

/// The power of two of the cells of a box: the least that is no smaller than it.
#[expect(clippy::cast_possible_truncation, reason = "a power of two of a finite number")]
fn power_of(bounds: &Rectangle) -> i32 {
    let size = bounds.size();
    if size > 0.0 { (size.log2().ceil() as i32).max(LEAST_POWER) } else { LEAST_POWER }
}

impl BoxGrid {
    pub(super) fn insert(&mut self, bounds: &Rectangle, piece: HalfEdgeId) {
        let power = power_of(bounds);
        let place = self.levels.iter().position(|level| level.power == power).unwrap_or_else(|| {
            self.levels.push(Level::new(power));
            self.levels.len() - 1
        });
        let level = &mut self.levels[place];
        let cell = level.cell(bounds.min);
        level.cells.entry(cell).or_default().push(piece);
        level.count += 1;
    }

    /// Takes a half-edge out whose box is that with which it was put in.
    pub(super) fn remove(&mut self, bounds: &Rectangle, piece: HalfEdgeId) {
        let power = power_of(bounds);
        let Some(level) = self.levels.iter_mut().find(|level| level.power == power) else { return };
        let cell = level.cell(bounds.min);
        let Some(pieces) = level.cells.get_mut(&cell) else { return };
        if let Some(place) = pieces.iter().position(|other| *other == piece) {
            pieces.swap_remove(place);
            level.count -= 1;
        }
        if pieces.is_empty() {
            level.cells.remove(&cell);
        }
    }

    /// Leaves in `found` the half-edges whose boxes may touch a rectangle.
    pub(super) fn find(&self, bounds: &Rectangle, found: &mut Vec<HalfEdgeId>) {
        found.clear();
        for level in self.levels.iter().filter(|level| level.count > 0) {
            let ([left, low], [right, high]) = (level.cell(bounds.min), level.cell(bounds.max));
            let (left, low) = (left - 1, low - 1);
            let [columns, rows] = [right - left + 1, high - low + 1].map(|cells| cells as f64);
            if columns * rows > level.cells.len() as f64 {
                let is_near = |cell: &Cell| (left..=right).contains(&cell[0]) && (low..=high).contains(&cell[1]);
                let near = level.cells.iter().filter(|(cell, _)| is_near(cell));
                near.for_each(|(_, pieces)| found.extend_from_slice(pieces));
                continue;
            }
            for cell in (left..=right).flat_map(|x| (low..=high).map(move |y| [x, y])) {
                if let Some(pieces) = level.cells.get(&cell) {
                    found.extend_from_slice(pieces);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::ids::Id;

    #[test]
    fn all_boxes_that_touch_a_rectangle_are_found_whatever_their_sizes() {
        for seed in 0..20 {
            let mut random = Rng::spread(seed);
            let mut rectangle = |far: f64| {
                let size = 10.0_f64.powf(random.float(-6.0, 3.0)) * random.whole(0, 1);
                let min = DVec2::new(random.float(-far, far), random.float(-far, far));
                Rectangle { min, max: min + DVec2::new(size, size * random.float(0.0, 1.0)) }
            };
            let boxes: Vec<Rectangle> = (0..300).map(|_| rectangle(50.0)).collect();
            let mut grid = BoxGrid::default();
            boxes.iter().enumerate().for_each(|(k, bounds)| grid.insert(bounds, HalfEdgeId::from_index(k)));
            boxes.iter().enumerate().step_by(3).for_each(|(k, bounds)| grid.remove(bounds, HalfEdgeId::from_index(k)));
            let mut found = Vec::new();
            for _ in 0..100 {
                let query = rectangle(60.0);
                grid.find(&query, &mut found);
                for (k, bounds) in boxes.iter().enumerate() {
                    let touches = bounds.min.cmple(query.max).all() && bounds.max.cmpge(query.min).all();
                    let is_found = found.contains(&HalfEdgeId::from_index(k));
                    assert!(is_found <= (k % 3 != 0) && (k % 3 == 0 || is_found >= touches), "seed {seed}");
                }
            }
            boxes.iter().enumerate().for_each(|(k, bounds)| grid.remove(bounds, HalfEdgeId::from_index(k)));
            assert!(grid.levels.iter().all(|level| level.count == 0 && level.cells.is_empty()));
        }
    }
}
