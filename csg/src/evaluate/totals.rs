//! Measures of several solids that have no point in common.

use glam::DVec3;

use crate::base::CompensatedSum;
use crate::mesh::SolidMeasures;

/// Sums over solids.
#[derive(Debug, Clone, Copy)]
pub(super) struct Totals {
    volume: CompensatedSum,
    area: CompensatedSum,
    /// Volume times centroid.
    moment: [CompensatedSum; 3],
    min: DVec3,
    max: DVec3,
}

impl Default for Totals {
    fn default() -> Self {
        Self {
            volume: CompensatedSum::default(),
            area: CompensatedSum::default(),
            moment: [CompensatedSum::default(); 3],
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        }
    }
}

impl Totals {
    /// Those of one solid.
    pub(super) fn of(solid: &SolidMeasures) -> Self {
        let mut totals = Self::default();
        // the box of nothing is the origin
        if solid.volume != 0.0 || solid.area != 0.0 {
            totals.add_solid(solid.volume, solid.area, solid.volume * solid.centroid, [solid.min, solid.max]);
        }
        totals
    }

    /// Adds a solid: its volume, area, volume times centroid, and the smallest and largest coordinates.
    pub(super) fn add_solid(&mut self, volume: f64, area: f64, moment: DVec3, [min, max]: [DVec3; 2]) {
        self.volume.add(volume);
        self.area.add(area);
        self.moment.iter_mut().zip(moment.to_array()).for_each(|(sum, term)| sum.add(term));
        (self.min, self.max) = (self.min.min(min), self.max.max(max));
    }

    pub(super) fn add(&mut self, other: &Self) {
        let moment = DVec3::from_array(other.moment.map(CompensatedSum::value));
        self.add_solid(other.volume.value(), other.area.value(), moment, [other.min, other.max]);
    }

    pub(super) fn measures(&self) -> SolidMeasures {
        if self.min.x > self.max.x {
            return SolidMeasures::default();
        }
        let (volume, area) = (self.volume.value(), self.area.value());
        let centroid = DVec3::from_array(self.moment.map(CompensatedSum::value)) / volume;
        SolidMeasures { volume, area, centroid, min: self.min, max: self.max }
    }
}
