//! Cutting a face polygon into triangles on its own corners.

use glam::DVec3;

pub(super) use planecut_shapes::polyhedron::MAX_CONCAVE_CORNERS;

/// Appends the triangles of a polygon of at least three corners, whose indices are in range.
///
/// Gives `false`, and appends nothing, for polygons that are not convex with more than [`MAX_CONCAVE_CORNERS`] corners.
pub(super) fn triangulate(corners: &[u32], positions: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> bool {
    let polygon: Vec<DVec3> = corners.iter().map(|&v| positions[v as usize]).collect();
    let cut = planecut_shapes::polyhedron::triangulate(&polygon);
    triangles.extend(cut.iter().flatten().map(|triangle| triangle.map(|k| corners[k])));
    cut.is_some()
}
