//! Convex polyhedra in floating point, and what is left of one outside of others.

use planecut_kernel::{DVec3, hull_triangles};

use super::polygons::clip_by;

/// Fragments of one polyhedron, at most: what is in more is taken whole.
const MOST: usize = 64;

/// A convex polyhedron by its faces, each a convex polygon.
#[derive(Debug, Clone)]
pub(super) struct Fragment {
    faces: Vec<Vec<DVec3>>,
}

/// A half-space by its normal and offset.
pub(super) type Plane = (DVec3, f64);

impl Fragment {
    /// The hull of points; none where it has no interior.
    pub(super) fn hull_of(points: &[DVec3]) -> Option<Self> {
        let triangles = hull_triangles(points).ok()?;
        let faces = triangles.iter().map(|triangle| triangle.map(|corner| points[corner as usize]).to_vec());
        Some(Self { faces: faces.collect() })
    }

    /// The corners of all faces.
    pub(super) fn corners(&self) -> impl Iterator<Item = &DVec3> {
        self.faces.iter().flatten()
    }

    /// What lies within a half-space; none where nothing does.
    fn within(&self, (normal, offset): Plane) -> Option<Self> {
        let height = |p: DVec3| normal.dot(p) - offset;
        let (mut faces, mut rim): (Vec<Vec<DVec3>>, Vec<DVec3>) = (Vec::new(), Vec::new());
        for face in &self.faces {
            let mut kept = Vec::new();
            clip_by(face, height, |a, b| crossing(a, b, height), &mut kept, &mut rim);
            if kept.len() >= 3 {
                faces.push(kept);
            }
        }
        if faces.is_empty() {
            return None;
        }
        if rim.len() >= 3 {
            faces.push(around(normal, rim));
        }
        Some(Self { faces })
    }

    /// What lies outside of a convex body given by its planes; itself as it is where the body has nothing of it.
    fn outside(self, planes: &[Plane]) -> Vec<Self> {
        let mut crossed = Vec::new();
        for plane in planes {
            let (low, high) = self.corners().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                let height = plane.0.dot(*p) - plane.1;
                (low.min(height), high.max(height))
            });
            if low >= 0.0 {
                return vec![self];
            }
            if high > 0.0 {
                crossed.push((high, *plane));
            }
        }
        // what cuts off most goes first
        crossed.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (mut rest, mut fragments) = (self.clone(), Vec::new());
        for (_, (normal, offset)) in crossed {
            fragments.extend(rest.within((-normal, -offset)));
            match rest.within((normal, offset)) {
                Some(within) => rest = within,
                None => return vec![self],
            }
        }
        fragments
    }

    /// What lies outside of several bodies.
    pub(super) fn outside_all(self, bodies: &[&[Plane]]) -> Vec<Self> {
        let mut fragments = vec![self];
        for body in bodies {
            let before = fragments.len();
            let next: Vec<Self> = fragments.iter().flat_map(|fragment| fragment.clone().outside(body)).collect();
            // many small fragments are worth no more work
            if next.len() <= MOST || next.len() <= before {
                fragments = next;
            }
        }
        fragments
    }
}

/// The point of a segment that lies in a plane, the same from both ends.
pub(super) fn crossing(a: DVec3, b: DVec3, height: impl Fn(DVec3) -> f64) -> DVec3 {
    let (a, b) = if height(a) <= height(b) { (a, b) } else { (b, a) };
    let (low, high) = (height(a), height(b));
    a + (-low / (high - low)) * (b - a)
}

/// The corners of a convex polygon in the order in which they lie around it.
fn around(normal: DVec3, mut corners: Vec<DVec3>) -> Vec<DVec3> {
    let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let (x, y) = normal.normalize_or(DVec3::Z).any_orthonormal_pair();
    let angle = |p: &DVec3| (*p - center).dot(y).atan2((*p - center).dot(x));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners.dedup();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: f64, high: f64) -> Fragment {
        let corner = |k: u32| DVec3::from_array([k & 1, k >> 1 & 1, k >> 2].map(|v| if v == 1 { high } else { low }));
        Fragment::hull_of(&(0..8).map(corner).collect::<Vec<_>>()).expect("it has interior")
    }

    fn planes(low: f64, high: f64) -> Vec<Plane> {
        DVec3::AXES.into_iter().flat_map(|axis| [(axis, high), (-axis, -low)]).collect()
    }

    fn volume(fragment: &Fragment) -> f64 {
        super::super::region::hull_volume(&fragment.corners().copied().collect::<Vec<_>>())
    }

    #[test]
    fn what_is_outside_adds_up() {
        let outside = cube(0.0, 2.0).outside(&planes(1.0, 3.0));
        assert_eq!(outside.iter().map(volume).sum::<f64>(), 7.0);
        assert_eq!(cube(0.0, 1.0).outside(&planes(2.0, 3.0)).len(), 1);
        assert!(cube(0.0, 1.0).outside(&planes(-1.0, 3.0)).is_empty());
        let both = cube(0.0, 2.0).outside_all(&[&planes(1.0, 3.0), &planes(-1.0, 1.0)]);
        assert_eq!(both.iter().map(volume).sum::<f64>(), 6.0);
    }
}
