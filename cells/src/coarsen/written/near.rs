//! Which of many points are near one, without asking each.

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

/// Points in the cells of a grid.
pub(super) struct Near {
    /// Twice the distance that is asked for, so that no rounding matters.
    cell: f64,
    numbers: FxHashMap<[i64; 3], Vec<usize>>,
}

impl Near {
    /// No points; `distance` is the largest that is asked for.
    pub(super) fn new(distance: f64) -> Self {
        Self { cell: (2.0 * distance).max(f64::MIN_POSITIVE), numbers: FxHashMap::default() }
    }

    /// Adds a point under a number.
    pub(super) fn insert(&mut self, number: usize, point: DVec3) {
        self.numbers.entry(self.cell_of(point)).or_default().push(number);
    }

    /// The numbers of all points within the distance of one, and of some others.
    pub(super) fn around(&self, point: DVec3) -> impl Iterator<Item = usize> {
        let cell = self.cell_of(point);
        let beside = (0..27).map(move |k| {
            let step = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
            [0, 1, 2].map(|axis| cell[axis].saturating_add(step[axis]))
        });
        beside.filter_map(|cell| self.numbers.get(&cell)).flatten().copied()
    }

    /// Numbers too large for the grid are all in its last cell.
    fn cell_of(&self, point: DVec3) -> [i64; 3] {
        (point / self.cell).floor().to_array().map(|v| v as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::probes::spread;
    use super::*;

    #[test]
    fn all_points_within_the_distance_are_found() {
        for (size, distance) in [(1.0, 0.1), (1e9, 3e8), (1e-9, 0.0), (1e300, 1e-300), (1.0, 5.0)] {
            // on a lattice too, so that points lie just on the borders of cells
            let at = |k: usize| if k.is_multiple_of(2) { spread(k) - 0.5 } else { (spread(k) * 20.0).round() / 20.0 };
            let points: Vec<DVec3> = (0..300).map(|k| at(k) * size).collect();
            let mut near = Near::new(distance);
            points.iter().enumerate().for_each(|(number, point)| near.insert(number, *point));
            for point in &points {
                let found: Vec<usize> = near.around(*point).collect();
                let mut expected = (0..300).filter(|k| points[*k].distance(*point) <= distance);
                assert!(expected.all(|k| found.contains(&k)), "{size} {distance} {point}");
            }
        }
    }
}
