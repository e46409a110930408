//! The points that share an edge with a point of a hull.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;

use crate::polytope::BoundingBox;

/// Of a point with more neighbours than this, this number at a time is kept in a box: the apex of a cone over n points is asked
/// about by each of its n facets.
const CHUNK: usize = 256;

/// The neighbours of each point, in their order around it.
#[derive(Debug)]
pub(super) struct Neighbours {
    /// Where those of a point stand in `ends`.
    ranges: Vec<Range<u32>>,
    ends: Vec<u32>,
    /// The boxes around the chunks of points that have more than one.
    boxes: HashMap<u32, Vec<BoundingBox>>,
}

/// The box around points.
fn box_around(points: impl Iterator<Item = DVec3>) -> BoundingBox {
    let nothing = BoundingBox { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    points.fold(nothing, |all, p| BoundingBox { min: all.min.min(p), max: all.max.max(p) })
}

/// Whether a point of the box may lie farther along a direction than another point.
fn may_reach_beyond(bounds: &BoundingBox, direction: DVec3, point: DVec3) -> bool {
    let (low, high) = (direction * (bounds.min - point), direction * (bounds.max - point));
    let terms = low.max(high);
    // difference, product and two sums: 4 roundings a term
    terms.element_sum() > -4.0 * f64::EPSILON * terms.abs().element_sum()
}

impl Neighbours {
    /// No neighbours yet, for this number of points.
    pub(super) fn of_none(points: usize) -> Self {
        Self { ranges: vec![0..0; points], ends: Vec::new(), boxes: HashMap::new() }
    }

    /// Whether a point has its neighbours.
    pub(super) fn has(&self, point: u32) -> bool {
        !self.ranges[point as usize].is_empty()
    }

    /// Gives a point its neighbours.
    pub(super) fn push(&mut self, points: &[DVec3], point: u32, ring: impl Iterator<Item = u32>) {
        let start = self.ends.len();
        self.ends.extend(ring);
        self.ranges[point as usize] = start as u32..self.ends.len() as u32;
        let ring = &self.ends[start..];
        if ring.len() > CHUNK {
            let at = |p: &u32| points[*p as usize];
            self.boxes.insert(point, ring.chunks(CHUNK).map(|chunk| box_around(chunk.iter().map(at))).collect());
        }
    }

    /// The neighbours of a point, all that lie farther along a direction among them.
    pub(super) fn that_may_be_farther(
        &self,
        points: &[DVec3],
        point: u32,
        direction: DVec3,
    ) -> impl Iterator<Item = u32> + '_ {
        let Range { start, end } = self.ranges[point as usize];
        let all = &self.ends[start as usize..end as usize];
        let boxes = if all.len() > CHUNK { self.boxes.get(&point) } else { None };
        let from = points[point as usize];
        let may_be = move |chunk: usize| boxes.is_none_or(|boxes| may_reach_beyond(&boxes[chunk], direction, from));
        all.chunks(CHUNK).enumerate().filter(move |(chunk, _)| may_be(*chunk)).flat_map(|(_, chunk)| chunk).copied()
    }
}
