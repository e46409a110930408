//! Volume, area and centroid of a bounded polytope.

use glam::DVec3;

use super::IncrementalPolytope;

/// Volume, area and centroid of a bounded polytope, in the units of its planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Volume; zero where the set is empty.
    pub volume: f64,
    /// Area of the boundary.
    pub area: f64,
    /// Centroid; the origin where the set is empty.
    pub centroid: DVec3,
}

impl IncrementalPolytope {
    /// Volume, area and centroid; `None` where the set is unbounded.
    ///
    /// Sums over the tetrahedra between a corner and the triangles of the faces that do not touch it, all of them positive,
    /// so that nothing cancels.
    #[must_use]
    pub fn measures(&self) -> Option<Measures> {
        if !self.is_bounded() {
            return None;
        }
        let (positions, faces) = self.to_mesh();
        let Some(&apex) = positions.first() else {
            return Some(Measures { volume: 0.0, area: 0.0, centroid: DVec3::ZERO });
        };
        let (mut six_volume, mut twice_area, mut moment) = (0.0, 0.0, DVec3::ZERO);
        for face in &faces {
            let p = positions[face[0]] - apex;
            for pair in face[1..].windows(2) {
                let (q, r) = (positions[pair[0]] - apex, positions[pair[1]] - apex);
                let normal = (q - p).cross(r - p);
                let weight = normal.dot(p);
                twice_area += normal.length();
                six_volume += weight;
                moment += weight * (p + q + r);
            }
        }
        let centroid = if six_volume > 0.0 { apex + moment / (4.0 * six_volume) } else { apex };
        Some(Measures { volume: six_volume / 6.0, area: twice_area / 2.0, centroid })
    }
}
