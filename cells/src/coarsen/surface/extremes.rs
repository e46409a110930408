//! The farthest of many points.

use planecut_kernel::DVec3;

use super::region::hull_volume;

/// The farthest points in some directions: to corners, edges and sides of a cube.
#[derive(Debug, Clone)]
pub(super) struct Extremes {
    points: [DVec3; 2 * DIRECTIONS.len()],
    reach: [f64; 2 * DIRECTIONS.len()],
}

const DIRECTIONS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
];

impl Default for Extremes {
    fn default() -> Self {
        Self { points: [DVec3::ZERO; 2 * DIRECTIONS.len()], reach: [f64::NEG_INFINITY; 2 * DIRECTIONS.len()] }
    }
}

impl Extremes {
    pub(super) fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let mut extremes = Self::default();
        points.for_each(|point| extremes.add(point));
        extremes
    }

    pub(super) fn add(&mut self, point: DVec3) {
        for (k, direction) in DIRECTIONS.iter().enumerate() {
            let along = DVec3::from_array(*direction).dot(point);
            for (place, along) in [(2 * k, along), (2 * k + 1, -along)] {
                if along > self.reach[place] {
                    self.reach[place] = along;
                    self.points[place] = point;
                }
            }
        }
    }

    /// The volume of the hull of these points: no more than that of all.
    pub(super) fn volume(&self) -> f64 {
        hull_volume(self.points())
    }

    /// The points, some of them several times.
    pub(super) fn points(&self) -> &[DVec3] {
        if self.reach[0] == f64::NEG_INFINITY { &[] } else { &self.points }
    }
}
