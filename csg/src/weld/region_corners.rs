//! The corners of a region, to be looked up.

use super::cancel::HalfEdge;
use crate::ids::{Id, PointId, number32};

/// Of fewer corners each is compared.
const FEW: usize = 64;

/// Corners that are compared at once.
const LANES: usize = 8;

/// The different points at which half-edges of a region begin, ascending.
#[derive(Debug, Default)]
pub(super) struct RegionCorners {
    points: Vec<PointId>,
    /// Where there are few, these and [`Id::NONE`], as many as can be compared at once.
    padded: Vec<PointId>,
    /// The place of the first half-edge that begins at each.
    first: Vec<u32>,
}

impl RegionCorners {
    /// Takes those of half-edges that are sorted by where they begin.
    pub(super) fn set(&mut self, region: &[HalfEdge]) {
        self.points.clear();
        self.first.clear();
        let mut last = PointId::NONE;
        for (place, piece) in region.iter().enumerate() {
            if piece.from != last {
                last = piece.from;
                self.points.push(last);
                self.first.push(number32(place));
            }
        }
        self.padded.clear();
        if self.points.len() < FEW {
            self.padded.extend_from_slice(&self.points);
            self.padded.resize(self.points.len().next_multiple_of(LANES), PointId::NONE);
        }
    }

    pub(super) fn points(&self) -> &[PointId] {
        &self.points
    }

    /// The place of a point among the corners.
    pub(super) fn place_of(&self, point: PointId) -> Option<usize> {
        let place = if self.points.len() < FEW {
            // without a branch
            let before = |some: &[PointId; LANES]| some.iter().map(|other| u32::from(*other < point)).sum::<u32>();
            self.padded.as_chunks().0.iter().map(before).sum::<u32>() as usize
        } else {
            self.points.partition_point(|other| *other < point)
        };
        (self.points.get(place) == Some(&point)).then_some(place)
    }

    /// The place of the first half-edge that begins at a point.
    pub(super) fn first_at(&self, point: PointId) -> Option<usize> {
        self.place_of(point).map(|place| self.first[place] as usize)
    }
}
