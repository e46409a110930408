//! Measures of a solid from the facets of its boundary, before triangulation, and from the triangles that pass through.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::Arranged;
use super::facets::FacetKind;
use super::kept::Kept;
use super::slits::Edges;
use crate::base::{Bounds, CompensatedSum};
use crate::ids::PointId;
use crate::mesh::SolidMeasures;

/// Facets that are summed one after the other, so that sums do not depend on the number of threads.
const CHUNK: usize = 4096;

/// Sums over parts of a boundary, relative to a point near the middle so that little cancels.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) six_volume: CompensatedSum,
    pub(super) area: CompensatedSum,
    moment: [CompensatedSum; 3],
}

impl Sums {
    /// Adds a triangle between the origin of a facet and an edge of it; gives twice its area along its normal.
    fn add(&mut self, [origin, p, q]: [DVec3; 3]) -> DVec3 {
        let normal = (p - origin).cross(q - origin);
        let weight = origin.dot(normal);
        self.six_volume.add(weight);
        for (sum, term) in self.moment.iter_mut().zip((weight * (origin + p + q)).to_array()) {
            sum.add(term);
        }
        normal
    }

    fn and(&mut self, other: &Self) {
        self.six_volume.add(other.six_volume.value());
        self.area.add(other.area.value());
        for (sum, term) in self.moment.iter_mut().zip(&other.moment) {
            sum.add(term.value());
        }
    }

    /// The measures of the solid whose whole boundary this is.
    pub(super) fn solid(&self, middle: DVec3, bounds: &Bounds) -> SolidMeasures {
        let volume = self.six_volume.value() / 6.0;
        let moment = DVec3::from_array(self.moment.map(CompensatedSum::value));
        let centroid = middle + moment / (24.0 * volume);
        SolidMeasures { volume, area: self.area.value(), centroid, min: bounds.min, max: bounds.max }
    }
}

/// Sums over several parts.
pub(super) fn total(parts: &[Sums]) -> Sums {
    let mut all = Sums::default();
    parts.iter().for_each(|part| all.and(part));
    all
}

/// The box around places.
pub(super) fn bounds_of(positions: &[DVec3]) -> Bounds {
    let of_chunk = |chunk: &[DVec3]| {
        chunk.iter().fold(Bounds::EMPTY, |all, at| Bounds { min: all.min.min(*at), max: all.max.max(*at) })
    };
    let of_chunks: Vec<Bounds> = positions.par_chunks(CHUNK).map(of_chunk).collect();
    of_chunks.iter().fold(Bounds::EMPTY, |all, one| all.union(one))
}

/// Sums over triangles, whose corners are given relative to the middle.
pub(super) fn of_triangles<T: Sync>(triangles: &[T], corners: impl Fn(&T) -> [DVec3; 3] + Sync) -> Sums {
    let of_chunk = |chunk: &[T]| {
        let mut sums = Sums::default();
        for triangle in chunk {
            let twice_area = sums.add(corners(triangle));
            sums.area.add(0.5 * twice_area.length());
        }
        sums
    };
    let parts: Vec<Sums> = triangles.par_chunks(CHUNK).map(of_chunk).collect();
    total(&parts)
}

/// Sums over facets that are kept.
pub(super) fn of_facets(arranged: &Arranged<'_>, kept: &[Kept], middle: DVec3) -> Sums {
    let (surface, points) = (&arranged.arrangement.surface, &arranged.arrangement.points);
    let at = |point: PointId| points.at(surface, point) - middle;
    // slits have no area
    let none = Edges::default();
    let of_chunk = |chunk: &[Kept]| {
        let mut sums = Sums::default();
        for kept in chunk {
            let twice_area = match arranged.facets.kind(kept.facet) {
                FacetKind::Triangle(triangle) => {
                    let [a, b, c] = surface.corners(triangle).map(at);
                    sums.add(if kept.is_flipped { [a, c, b] } else { [a, b, c] })
                }
                _ => add_loops(&mut sums, &arranged.loops(kept, &none), at),
            };
            sums.area.add(0.5 * twice_area.length());
        }
        sums
    };
    let parts: Vec<Sums> = kept.par_chunks(CHUNK).map(of_chunk).collect();
    total(&parts)
}

fn add_loops(sums: &mut Sums, loops: &[Vec<PointId>], at: impl Fn(PointId) -> DVec3) -> DVec3 {
    let Some(first) = loops.first() else { return DVec3::ZERO };
    let origin = at(first[0]);
    let mut twice_area = DVec3::ZERO;
    for points in loops {
        for k in 0..points.len() {
            twice_area += sums.add([origin, at(points[k]), at(points[(k + 1) % points.len()])]);
        }
    }
    twice_area
}
