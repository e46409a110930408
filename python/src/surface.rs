//! A mesh with a tree of boxes around its triangles, for rays.

use glam::DVec3;
use planecut::csg::Mesh;
use planecut_csg::stages::{Bounds, Boxes, distance_along};

/// Triangles, and boxes around them.
#[derive(Debug)]
pub(crate) struct Surface {
    corners: Vec<[DVec3; 3]>,
    boxes: Boxes,
}

impl Surface {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
        let corners: Vec<[DVec3; 3]> = mesh.triangles.iter().map(corners).collect();
        let boxes = corners.iter().map(|[a, b, c]| Bounds { min: a.min(*b).min(*c), max: a.max(*b).max(*c) });
        Self { boxes: Boxes::new(boxes.collect()), corners }
    }

    /// The distance to the first triangle that a ray meets, infinite where it meets none. The direction has length 1.
    pub(crate) fn first_hit(&self, origin: DVec3, direction: DVec3, near: &mut Vec<u32>) -> f64 {
        let inverse = direction.recip();
        let size = (0..3).map(|axis| origin[axis].abs()).fold(0.0, f64::max);
        let meets = |bounds: &Bounds| {
            // rounding must not lose a box that the ray just touches
            let margin = 1e-12 * (size + bounds.min.abs().max(bounds.max.abs()).max_element());
            let (mut from, mut to) = (0.0_f64, f64::INFINITY);
            for axis in 0..3 {
                let (low, high) = (bounds.min[axis] - margin - origin[axis], bounds.max[axis] + margin - origin[axis]);
                if direction[axis] == 0.0 {
                    if low > 0.0 || high < 0.0 {
                        return false;
                    }
                    continue;
                }
                let (a, b) = (low * inverse[axis], high * inverse[axis]);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
            from <= to
        };
        self.boxes.find(meets, near);
        let distances = near.iter().filter_map(|k| distance_along(origin, direction, self.corners[*k as usize]));
        distances.fold(f64::INFINITY, f64::min)
    }
}
