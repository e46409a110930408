//! Volume, area and centroid of a triangle mesh.

use glam::DVec3;

use crate::sum::CompensatedSum;

/// Sizes of a closed mesh, in the units of its positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Signed volume enclosed, positive where triangles are counter-clockwise seen from outside. Of meshes that are not
    /// closed it has no meaning.
    pub volume: f64,
    /// Sum of the triangles' areas.
    pub area: f64,
    /// Centroid of the enclosed volume, or the centre of the bounding box where the volume is zero.
    pub centroid: [f64; 3],
    /// Least coordinates of all vertices that triangles use; zero where there are none.
    pub min: [f64; 3],
    /// Largest coordinates of all vertices that triangles use; zero where there are none.
    pub max: [f64; 3],
}

/// Volume, area and centroid of the given triangles; `None` where one names a position that there is not.
#[must_use]
pub fn measure_triangles<P: Copy + Into<[f64; 3]>>(positions: &[P], triangles: &[[u32; 3]]) -> Option<Measures> {
    let is_there = |corner: &u32| (*corner as usize) < positions.len();
    triangles.as_flattened().iter().all(is_there).then(|| measure(positions, triangles))
}

/// Measures of the given triangles, all of whose indices are in range.
///
/// Tetrahedra are formed with the centre of the bounding box, not with the origin, so that meshes far away lose no digits.
pub(crate) fn measure<P: Copy + Into<[f64; 3]>>(positions: &[P], triangles: &[[u32; 3]]) -> Measures {
    let position = |index: u32| DVec3::from_array(positions[index as usize].into());
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &index in triangles.as_flattened() {
        min = min.min(position(index));
        max = max.max(position(index));
    }
    if triangles.is_empty() {
        (min, max) = (DVec3::ZERO, DVec3::ZERO);
    }
    let centre = min + (max - min) * 0.5;
    let mut six_volume = CompensatedSum::default();
    let mut two_area = CompensatedSum::default();
    let mut moment = [CompensatedSum::default(); 3];
    for &triangle in triangles {
        let [a, b, c] = triangle.map(|v| position(v) - centre);
        let normal = (b - a).cross(c - a);
        let six = a.dot(normal);
        six_volume.add(six);
        two_area.add(normal.length());
        let corners = a + b + c;
        moment.iter_mut().zip(corners.to_array()).for_each(|(m, corner)| m.add(six * corner));
    }
    let six = six_volume.value();
    let offset = DVec3::from_array(moment.map(|m| m.value() / (4.0 * six)));
    let centroid = if offset.is_finite() { centre + offset } else { centre };
    Measures {
        volume: six / 6.0,
        area: two_area.value() / 2.0,
        centroid: centroid.to_array(),
        min: min.to_array(),
        max: max.to_array(),
    }
}
