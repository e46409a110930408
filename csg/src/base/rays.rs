//! Rays, and where they meet boxes and triangles.

use glam::DVec3;

use super::{Bounds, Boxes};
use crate::tolerances::ON_FACE;

/// A ray that misses the box of a triangle, or of a face, by more than this share of the coordinates misses what is in it: [`Ray::distance_to`] takes no place that is outside of the
/// box by more than [`ON_FACE`] of the coordinates of the triangle and of the origin.
pub(crate) const IN_BOX: f64 = 2.0 * ON_FACE;

/// A ray: all places `origin + t·direction`, `t ≥ 0`. The direction has length 1.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
}

impl Ray {
    /// A ray in a direction of any length. `None` where it is zero, or a number is not finite.
    #[must_use]
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        let longest = direction.abs().max_element();
        if !(origin.is_finite() && direction.is_finite() && longest > 0.0) {
            return None;
        }
        // twice, as the square of what is tiny is zero
        let direction = (direction / longest).normalize();
        Some(Self { origin, direction, inverse: direction.recip() })
    }

    /// Where it begins.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Where it goes, of length 1.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// How far it goes until it meets a box, 0 where it begins within. `None` where it misses the box by more than a share of the coordinates.
    #[inline]
    #[must_use]
    pub fn distance_to_box(&self, bounds: &Bounds, share: f64) -> Option<f64> {
        let size = self.origin.abs().max_element().max(bounds.min.abs().max(bounds.max.abs()).max_element());
        let margin = share * size;
        let (mut from, mut to) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let low = bounds.min[axis] - margin - self.origin[axis];
            let high = bounds.max[axis] + margin - self.origin[axis];
            if self.direction[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low * self.inverse[axis], high * self.inverse[axis]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        (from <= to).then_some(from)
    }

    /// How far it goes until it meets a triangle, from either side. Rays through an edge meet one of its triangles at least: signs of the volumes between ray and edges
    /// are the same from both, as they are computed from the same numbers (Woop, Benthin, Wald 2013).
    #[must_use]
    pub fn distance_to(&self, corners: [DVec3; 3]) -> Option<f64> {
        let Self { origin, direction, .. } = *self;
        let axis = direction.abs().max_position();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let shear = [direction[u] / direction[axis], direction[v] / direction[axis]];
        let [a, b, c] = corners.map(|corner| {
            let p = corner - origin;
            [p[u] - shear[0] * p[axis], p[v] - shear[1] * p[axis], p[axis] / direction[axis]]
        });
        let area = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let weights = [area(b, c), area(c, a), area(a, b)];
        if weights.iter().any(|w| *w < 0.0) && weights.iter().any(|w| *w > 0.0) {
            return None;
        }
        let sum: f64 = weights.iter().sum();
        let distance = (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) / sum;
        // a triangle along the ray has no area seen from there
        if sum == 0.0 || distance < 0.0 {
            return None;
        }
        // of one that has next to none, the weights are noise: the place tells
        let place = origin + direction * distance;
        let [low, high] = [DVec3::min, DVec3::max].map(|farther| corners.into_iter().reduce(farther).unwrap_or(place));
        let margin = ON_FACE * (low.abs().max(high.abs()).max_element() + origin.abs().max_element());
        (place.cmpge(low - margin).all() && place.cmple(high + margin).all()).then_some(distance)
    }
}

/// Triangles with boxes around them, for rays.
#[derive(Debug, Clone)]
pub struct RayCaster {
    corners: Vec<[DVec3; 3]>,
    boxes: Boxes,
}

impl RayCaster {
    /// Triangles are numbered in the order given.
    #[must_use]
    pub fn new(corners: Vec<[DVec3; 3]>) -> Self {
        let boxes = corners.iter().map(|[a, b, c]| Bounds { min: a.min(*b).min(*c), max: a.max(*b).max(*c) });
        Self { boxes: Boxes::new(boxes.collect()), corners }
    }

    /// The first triangle that a ray meets, from either side, and how far away that is; of several at one distance the first.
    #[must_use]
    pub fn first_hit(&self, ray: &Ray) -> Option<(u32, f64)> {
        let enters = |bounds: &Bounds| ray.distance_to_box(bounds, IN_BOX);
        self.boxes.nearest(enters, |number| ray.distance_to(self.corners[number as usize]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of triangles that share their corners.
    fn sphere(rows: u32) -> Vec<[DVec3; 3]> {
        let place = |i: u32, j: u32| {
            let (theta, phi) = (f64::from(i) / f64::from(rows), f64::from(j % (2 * rows)) / f64::from(rows));
            let (sine, cosine) = (theta * std::f64::consts::PI).sin_cos();
            let (y, x) = (phi * std::f64::consts::PI).sin_cos();
            DVec3::new(sine * x, sine * y, cosine)
        };
        let square = |k: u32| {
            let (i, j) = (k / (2 * rows), k % (2 * rows));
            let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        (0..2 * rows * rows).flat_map(square).collect()
    }

    #[test]
    fn the_first_hit_is_that_of_all_triangles() {
        let triangles = sphere(12);
        let caster = RayCaster::new(triangles.clone());
        let mut state = 11_u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        let mut hits = 0;
        for k in 0..2000 {
            let [mut origin, mut direction] = [0; 2].map(|_| DVec3::new(number(), number(), number()));
            if k % 4 == 0 {
                // to a corner, or along an axis
                let at = triangles[k % triangles.len()][k % 3];
                (origin, direction) =
                    if k % 8 == 0 { (3.0 * origin, at - 3.0 * origin) } else { (at + DVec3::Z, -DVec3::Z) };
            }
            let Some(ray) = Ray::new(origin, direction) else { continue };
            let all = (0..).zip(&triangles).filter_map(|(k, corners)| Some((k, ray.distance_to(*corners)?)));
            let first = all.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            assert_eq!(caster.first_hit(&ray), first, "{origin} {direction}");
            hits += usize::from(first.is_some());
        }
        assert!(hits > 1000, "{hits}");
    }

    #[test]
    fn rays_have_a_direction() {
        assert!(Ray::new(DVec3::ZERO, DVec3::ZERO).is_none());
        assert!(Ray::new(DVec3::new(0.0, f64::NAN, 0.0), DVec3::X).is_none());
        assert!(Ray::new(DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0)).is_none());
        let tiny = Ray::new(DVec3::ZERO, DVec3::new(0.0, -3e-320, 0.0)).unwrap();
        assert_eq!(tiny.direction(), -DVec3::Y);
        assert_eq!(Ray::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 1e300)).unwrap().direction(), DVec3::Z);
    }

    #[test]
    fn boxes_are_met_where_they_are() {
        let bounds = Bounds { min: DVec3::new(1.0, -1.0, -1.0), max: DVec3::new(2.0, 1.0, 1.0) };
        let distance = |origin: [f64; 3], direction: [f64; 3]| {
            Ray::new(origin.into(), direction.into()).unwrap().distance_to_box(&bounds, 0.0)
        };
        assert_eq!(distance([0.0; 3], [2.0, 0.0, 0.0]), Some(1.0));
        assert_eq!(distance([1.5, 0.0, 0.0], [0.0, 1.0, 0.0]), Some(0.0));
        assert_eq!(distance([0.0; 3], [-1.0, 0.0, 0.0]), None);
        assert_eq!(distance([0.0, 2.0, 0.0], [1.0, 0.0, 0.0]), None);
        assert_eq!(distance([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), Some(1.0));
    }
}
