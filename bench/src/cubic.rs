//! The paper's slow baseline `reconstruct_old_cubic_approach` (§5.2, "brute-force local"): after a plane was taken away, try
//! every triple of the planes that were adjacent to it, O(A³·N).

use crate::inputs::{Plane, dot};

const EPSILON: f64 = 1e-7;

/// The planes that have a vertex in common with plane `removed`, given all vertices of the polytope.
#[must_use]
pub fn adjacent(planes: &[Plane], vertices: &[[f64; 3]], removed: usize) -> Vec<usize> {
    let passes = |plane: &Plane, v: &[f64; 3]| (dot(plane.normal, *v) - plane.offset).abs() < EPSILON;
    let corners: Vec<_> = vertices.iter().filter(|v| passes(&planes[removed], v)).collect();
    let meets = |i: &usize| *i != removed && corners.iter().any(|v| passes(&planes[*i], v));
    (0..planes.len()).filter(meets).collect()
}

/// All vertices without plane `removed` in which three of the `adjacent` planes meet; the unchanged ones among them
/// included, each once.
#[must_use]
pub fn reconstruct(planes: &[Plane], adjacent: &[usize], removed: usize) -> Vec<[f64; 3]> {
    let mut found: Vec<[f64; 3]> = Vec::new();
    for (i, &a) in adjacent.iter().enumerate() {
        for (j, &b) in adjacent.iter().enumerate().skip(i + 1) {
            for &c in &adjacent[j + 1..] {
                let Some(point) = meet(&planes[a], &planes[b], &planes[c]) else { continue };
                let violates = |(k, p): (usize, &Plane)| k != removed && dot(p.normal, point) > p.offset + EPSILON;
                let is_near = |q: &[f64; 3]| (0..3).all(|k| (q[k] - point[k]).abs() < 10.0 * EPSILON);
                if !planes.iter().enumerate().any(violates) && !found.iter().any(is_near) {
                    found.push(point);
                }
            }
        }
    }
    found
}

fn meet(a: &Plane, b: &Plane, c: &Plane) -> Option<[f64; 3]> {
    let (bc, ca, ab) = (cross(b.normal, c.normal), cross(c.normal, a.normal), cross(a.normal, b.normal));
    let determinant = dot(a.normal, bc);
    (determinant.abs() > EPSILON)
        .then(|| std::array::from_fn(|k| (a.offset * bc[k] + b.offset * ca[k] + c.offset * ab[k]) / determinant))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::fibonacci_sphere;
    use crate::library::{Library, Planecut};

    #[test]
    fn finds_the_vertices_that_the_removal_makes() {
        let planes = fibonacci_sphere(50);
        let half_spaces: Vec<_> = planes.iter().map(Planecut::half_space).collect();
        for removed in 0..planes.len() {
            let mut polytope = Planecut::build(&half_spaces);
            let before = polytope.mesh().0;
            let near = |v: &[f64; 3], w: &[f64; 3]| (0..3).all(|k| (v[k] - w[k]).abs() < 1e-6);
            let found = reconstruct(&planes, &adjacent(&planes, &before, removed), removed);
            polytope.remove(removed);
            let after = polytope.mesh().0;
            let is_new = |v: &&[f64; 3]| !before.iter().any(|w| near(v, w));
            let new: Vec<_> = after.iter().filter(is_new).collect();
            assert!(new.iter().all(|v| found.iter().any(|w| near(v, w))), "plane {removed}: one is missing");
            assert!(found.iter().all(|v| after.iter().any(|w| near(v, w))), "plane {removed}: one is no vertex");
            assert!(!new.is_empty(), "plane {removed}: the removal makes vertices");
        }
    }
}
