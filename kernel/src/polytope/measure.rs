//! Volume, area and centroid of a bounded polytope.

use glam::DVec3;

use super::IncrementalPolytope;
use crate::double_double::DoubleDouble;

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
    /// Sums over the tetrahedra between a corner and the triangles of the faces. From correctly rounded corners every one
    /// of them is positive but for rounding, so that little cancels.
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
            let a = positions[face[0]];
            for pair in face[1..].windows(2) {
                let (b, c) = (positions[pair[0]], positions[pair[1]]);
                let weight = six_times_tetrahedron(apex, a, b, c);
                twice_area += (b - a).cross(c - a).length();
                six_volume += weight;
                moment += weight * ((a - apex) + (b - apex) + (c - apex));
            }
        }
        let centroid = if six_volume > 0.0 { apex + moment / (4.0 * six_volume) } else { apex };
        Some(Measures { volume: six_volume / 6.0, area: twice_area / 2.0, centroid })
    }
}

/// `(b − a) × (c − a) · (a − apex)`; where nearly all of it cancels, as for a needle, in about 106 bits.
fn six_times_tetrahedron(apex: DVec3, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    const CANCELLED: f64 = 1.0 / (1 << 20) as f64;
    let (u, v, w) = (b - a, c - a, a - apex);
    let value = u.cross(v).dot(w);
    if value.abs() > CANCELLED * u.length() * v.length() * w.length() {
        return value;
    }
    let difference =
        |p: DVec3, q: DVec3| -> [DoubleDouble; 3] { std::array::from_fn(|axis| DoubleDouble::sum(p[axis], -q[axis])) };
    let (u, v, w) = (difference(b, a), difference(c, a), difference(a, apex));
    let mut total = DoubleDouble::default();
    for (axis, height) in w.into_iter().enumerate() {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let minor = u[i].times_sum(v[j]).plus(u[j].times_sum(v[i]).negated());
        total = total.plus(minor.times_sum(height));
    }
    total.high
}
