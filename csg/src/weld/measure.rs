//! Measures of a solid from the loops of its boundary, before triangulation.

use planecut_kernel::DVec3;

use super::cancel::HalfEdge;
use super::nest::FaceLoops;
use crate::evaluate::SolidMeasures;
use crate::sum::CompensatedSum;

/// Volume, area, centroid and box by the divergence theorem, relative to the middle of the box so that little cancels.
pub(super) fn measures(positions: &[DVec3], pieces: &[HalfEdge], faces: &[FaceLoops]) -> SolidMeasures {
    let used = || pieces.iter().map(|piece| positions[piece.from as usize]);
    if pieces.is_empty() {
        return SolidMeasures::default();
    }
    let min = used().fold(DVec3::INFINITY, DVec3::min);
    let max = used().fold(DVec3::NEG_INFINITY, DVec3::max);
    let middle = 0.5 * (min + max);
    let (mut six_volume, mut area, mut moment) =
        (CompensatedSum::default(), CompensatedSum::default(), [CompensatedSum::default(); 3]);
    for face in faces {
        let origin = positions[pieces[face.loops[0][0] as usize].from as usize] - middle;
        let mut twice_area = DVec3::ZERO;
        for piece in face.loops.iter().flatten().map(|k| &pieces[*k as usize]) {
            let (p, q) = (positions[piece.from as usize] - middle, positions[piece.to as usize] - middle);
            let normal = (p - origin).cross(q - origin);
            let weight = origin.dot(normal);
            twice_area += normal;
            six_volume.add(weight);
            let vector = weight * (origin + p + q);
            for axis in 0..3 {
                moment[axis].add(vector[axis]);
            }
        }
        area.add(0.5 * twice_area.length());
    }
    let volume = six_volume.value() / 6.0;
    let moment = DVec3::new(moment[0].value(), moment[1].value(), moment[2].value());
    SolidMeasures { volume, area: area.value(), centroid: middle + moment / (24.0 * volume), min, max }
}
