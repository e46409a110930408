//! Cutting a face polygon into triangles on its own corners.

use glam::DVec3;

pub(super) use planecut_shapes::polyhedron::MAX_CONCAVE_CORNERS;

/// The triangles of a polygon of at least three corners, whose indices are in range, by the places of their corners in it.
///
/// `None` for polygons that are not convex with more than [`MAX_CONCAVE_CORNERS`] corners.
pub(super) fn triangulate(corners: &[u32], positions: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let polygon: Vec<DVec3> = corners.iter().map(|&v| positions[v as usize]).collect();
    planecut_shapes::polyhedron::triangulate(&polygon)
}
