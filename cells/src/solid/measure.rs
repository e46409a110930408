//! Volume, centroid, inertia and bounds.

use planecut_csg::stages::CompensatedSum;
use planecut_kernel::{BoundingBox, DMat3, DVec3, Measures};
use planecut_parallel::prelude::*;

use super::{Cell, Solid};

impl Solid {
    /// The volume, to a unit or two in the last place; `None` where the solid is unbounded.
    #[must_use]
    pub fn volume(&self) -> Option<f64> {
        let volume = |cell: &Cell| Some(cell.polytope().measures()?.volume);
        let volumes: Vec<f64> = self.cells.par_iter().map(volume).collect::<Option<_>>()?;
        let mut sum = CompensatedSum::default();
        volumes.into_iter().for_each(|volume| sum.add(volume));
        Some(sum.value())
    }

    /// The centroid; the origin where the solid is empty, `None` where it is unbounded.
    #[must_use]
    pub fn centroid(&self) -> Option<DVec3> {
        Some(self.moments()?.1)
    }

    /// The inertia tensor about the centroid for unit density, `∫ (|r|²·I − r·rᵀ) dV`: moments on the diagonal, products
    /// `−∫ x·y dV` beside it. Zero where the solid is empty, `None` where it is unbounded.
    ///
    /// The tensors of the cells, moved to the common centroid (Steiner).
    #[must_use]
    pub fn inertia(&self) -> Option<DMat3> {
        let (cells, centroid) = self.moments()?;
        let mut sums = [CompensatedSum::default(); 9];
        for cell in cells {
            let r = cell.centroid - centroid;
            let outer = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
            let moved = (DMat3::from_diagonal(DVec3::splat(r.length_squared())) - outer) * cell.volume;
            for (k, sum) in sums.iter_mut().enumerate() {
                sum.add(cell.inertia.to_cols_array()[k]);
                sum.add(moved.to_cols_array()[k]);
            }
        }
        Some(DMat3::from_cols_array(&sums.map(CompensatedSum::value)))
    }

    /// The measures of the cells, and the common centroid.
    fn moments(&self) -> Option<(Vec<Measures>, DVec3)> {
        let cells: Vec<Measures> =
            self.cells.par_iter().map(|cell| cell.polytope().measures()).collect::<Option<_>>()?;
        let mut volume = CompensatedSum::default();
        cells.iter().for_each(|cell| volume.add(cell.volume));
        if volume.value() == 0.0 {
            return Some((cells, DVec3::ZERO));
        }
        let mean = |axis: usize| {
            let mut sum = CompensatedSum::default();
            cells.iter().for_each(|cell| sum.add(cell.centroid[axis] * cell.volume));
            sum.value() / volume.value()
        };
        let centroid = DVec3::new(mean(0), mean(1), mean(2));
        Some((cells, centroid))
    }

    /// The smallest box around the solid, each bound correctly rounded and infinite where the solid goes on for ever; `None`
    /// where it is empty.
    #[must_use]
    pub fn bounding_box(&self) -> Option<BoundingBox> {
        let boxes = self.cells.iter().filter_map(|cell| cell.polytope().bounding_box());
        boxes.reduce(|a, b| BoundingBox { min: a.min.min(b.min), max: a.max.max(b.max) })
    }

    /// Whether there is nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.iter().all(|cell| cell.polytope().is_empty())
    }

    /// Whether all of it lies within some box.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.cells.iter().all(|cell| cell.polytope().is_bounded())
    }
}
