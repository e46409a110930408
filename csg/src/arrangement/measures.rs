//! Measures of a solid from the facets of its boundary, before triangulation.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::Arranged;
use super::boundary::Kept;
use crate::base::{Bounds, CompensatedSum};
use crate::mesh::SolidMeasures;

/// Facets that are summed one after the other, so that sums do not depend on the number of threads.
const CHUNK: usize = 4096;

/// Sums over facets, relative to a point near the middle so that little cancels.
#[derive(Clone, Copy)]
struct Sums {
    six_volume: CompensatedSum,
    area: CompensatedSum,
    moment: [CompensatedSum; 3],
}

/// The measures of the solid that some facets bound.
pub(super) fn of_facets(arranged: &Arranged, kept: &[Kept]) -> SolidMeasures {
    let (surface, points) = (&arranged.arrangement.surface, &arranged.arrangement.points);
    let chunks = || kept.par_chunks(CHUNK);
    let bounds = |kept: &Kept| {
        let places = arranged.loops(kept).concat();
        places
            .iter()
            .map(|point| points.at(surface, *point))
            .fold(Bounds::EMPTY, |all, at| all.union(&Bounds { min: at, max: at }))
    };
    let of_chunk = |chunk: &[Kept]| chunk.iter().map(bounds).fold(Bounds::EMPTY, |all, one| all.union(&one));
    let of_chunks: Vec<Bounds> = chunks().map(of_chunk).collect();
    let Bounds { min, max } = of_chunks.iter().fold(Bounds::EMPTY, |all, one| all.union(one));
    if kept.is_empty() {
        return SolidMeasures::default();
    }
    let middle = 0.5 * min + 0.5 * max;
    let sum = |chunk: &[Kept]| {
        let mut sums =
            Sums { six_volume: CompensatedSum::default(), area: CompensatedSum::default(), moment: Default::default() };
        for kept in chunk {
            let mut twice_area = DVec3::ZERO;
            let loops = arranged.loops(kept);
            let origin = points.at(surface, loops[0][0]) - middle;
            for points_of_loop in &loops {
                for k in 0..points_of_loop.len() {
                    let ends = [points_of_loop[k], points_of_loop[(k + 1) % points_of_loop.len()]];
                    let [p, q] = ends.map(|point| points.at(surface, point) - middle);
                    let normal = (p - origin).cross(q - origin);
                    let weight = origin.dot(normal);
                    twice_area += normal;
                    sums.six_volume.add(weight);
                    for (sum, term) in sums.moment.iter_mut().zip((weight * (origin + p + q)).to_array()) {
                        sum.add(term);
                    }
                }
            }
            sums.area.add(0.5 * twice_area.length());
        }
        sums
    };
    let parts: Vec<Sums> = chunks().map(sum).collect();
    let (mut six_volume, mut area, mut moment) =
        (CompensatedSum::default(), CompensatedSum::default(), [CompensatedSum::default(); 3]);
    for part in &parts {
        six_volume.add(part.six_volume.value());
        area.add(part.area.value());
        for (sum, term) in moment.iter_mut().zip(&part.moment) {
            sum.add(term.value());
        }
    }
    let volume = six_volume.value() / 6.0;
    let moment = DVec3::from_array(moment.map(CompensatedSum::value));
    SolidMeasures { volume, area: area.value(), centroid: middle + moment / (24.0 * volume), min, max }
}
