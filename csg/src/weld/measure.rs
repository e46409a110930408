//! Measures of a solid from the loops of its boundary, before triangulation.

use planecut_kernel::DVec3;

use super::cancel::HalfEdge;
use super::nest::{Face, Faces};
use crate::base::{CompensatedSum, map_chunks, with_room};
use crate::ids::Id;
use crate::mesh::SolidMeasures;

/// The part of one face in the measures of a solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct FaceMeasures {
    six_volume: f64,
    area: f64,
    moment: DVec3,
}

/// Least number of half-edges that a thread looks at in a row.
const PIECES_OF_CHUNK: usize = 1 << 12;

/// The box around some half-edges.
pub(super) fn extent(positions: &[DVec3], pieces: &[HalfEdge]) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (parts, _) = map_chunks(pieces, PIECES_OF_CHUNK, |chunk| {
        let positions = chunk.iter().map(|piece| positions[piece.from.index()]);
        positions.fold(none, |(min, max), at| (min.min(at), max.max(at)))
    });
    parts.into_iter().fold(none, |(min, max), part| (min.min(part.0), max.max(part.1)))
}

/// The parts of faces by the divergence theorem, relative to a point near the middle so that little cancels; there are about `of_all` faces in all.
pub(super) fn of_faces(
    positions: &[DVec3],
    pieces: &[HalfEdge],
    faces: &Faces,
    of_all: usize,
    middle: DVec3,
) -> Vec<FaceMeasures> {
    let of_face = |face: Face<'_>| {
        let mut origin = None;
        let mut twice_area = DVec3::ZERO;
        let mut six_volume = CompensatedSum::default();
        let mut moment = [CompensatedSum::default(); 3];
        for piece in face.loops().flatten().map(|k| &pieces[k.index()]) {
            let (p, q) = (positions[piece.from.index()] - middle, positions[piece.to.index()] - middle);
            let origin = *origin.get_or_insert(p);
            let normal = (p - origin).cross(q - origin);
            let weight = origin.dot(normal);
            twice_area += normal;
            six_volume.add(weight);
            let vector = weight * (origin + p + q);
            for axis in 0..3 {
                moment[axis].add(vector[axis]);
            }
        }
        let moment = DVec3::from_array(moment.map(CompensatedSum::value));
        FaceMeasures { six_volume: six_volume.value(), area: 0.5 * twice_area.length(), moment }
    };
    let mut measures = with_room(faces.len(), of_all);
    measures.extend(faces.iter().map(of_face));
    measures
}

/// Volume, area and centroid of a solid within a box.
pub(super) fn sum<'a>(faces: impl Iterator<Item = &'a FaceMeasures>, (min, max): (DVec3, DVec3)) -> SolidMeasures {
    let (mut six_volume, mut area, mut moment) =
        (CompensatedSum::default(), CompensatedSum::default(), [CompensatedSum::default(); 3]);
    for face in faces {
        six_volume.add(face.six_volume);
        area.add(face.area);
        for (sum, term) in moment.iter_mut().zip(face.moment.to_array()) {
            sum.add(term);
        }
    }
    let volume = six_volume.value() / 6.0;
    let moment = DVec3::from_array(moment.map(CompensatedSum::value));
    let centroid = 0.5 * (min + max) + moment / (24.0 * volume);
    SolidMeasures { volume, area: area.value(), centroid, min, max }
}
