//! Vertices around which triangles are sure to have nothing in common but their edges.
//!
//! The triangles around a vertex are one closed fan. Where all of them are counter-clockwise as they are projected along one direction, and
//! the fan goes around the vertex once, no two of them overlap in that projection, so none do in space. Most vertices of meshes are
//! of this kind; their triangles, which make up most of the pairs whose boxes touch, need not be compared with one another.

use glam::{DVec3, Vec3Swizzles};
use planecut_parallel::prelude::*;

use crate::closed_mesh::Star;
use crate::closed_mesh::connectivity::{NO_TWIN, next, previous};
use crate::ids::number32;

/// Vertices that one thread looks at in a row.
const CHUNK: usize = 1 << 12;

/// Stars of more triangles take memory of their own.
const FEW: usize = 32;

/// Bound on what is rounded in a component of a normal, in units of the magnitudes that it is a difference of.
const NORMAL_BOUND: f64 = 8.0 * f64::EPSILON;

/// Bound on what is rounded in a sum of two products, in units of the magnitudes of these.
const SIDE_BOUND: f64 = 8.0 * f64::EPSILON;

/// A direction of unit length.
const ASIDE: DVec3 = DVec3::new(0.726_312, 0.548_276, 0.414_684);

/// Whether the triangles around each vertex are sure to have nothing in common but their edges.
pub(super) fn simple_stars(positions: &[DVec3], triangles: &[[u32; 3]], twins: &[u32], stars: &[Star]) -> Vec<bool> {
    let work = |vertex: u32| is_simple(positions, triangles, twins, &stars[vertex as usize]);
    (0..number32(positions.len())).into_par_iter().with_min_len(CHUNK).map(work).collect()
}

fn is_simple(positions: &[DVec3], triangles: &[[u32; 3]], twins: &[u32], star: &Star) -> bool {
    let degree = star.degree as usize;
    if star.first == NO_TWIN {
        return false;
    }
    let corner = |half_edge: u32| triangles[half_edge as usize / 3][half_edge as usize % 3];
    let middle = positions[corner(star.first) as usize];
    // the other ends of edges around the vertex, seen from it
    let (mut few, mut many);
    let spokes = if degree <= FEW {
        few = [DVec3::ZERO; FEW + 1];
        &mut few[..=degree]
    } else {
        many = vec![DVec3::ZERO; degree + 1];
        &mut many[..]
    };
    let mut half_edge = star.first;
    for spoke in &mut spokes[..degree] {
        *spoke = positions[corner(next(half_edge)) as usize] - middle;
        // counter-clockwise around the vertex
        match twins[previous(half_edge) as usize] {
            NO_TWIN => return false,
            twin => half_edge = twin,
        }
    }
    if half_edge != star.first {
        return false;
    }
    spokes[degree] = spokes[0];
    let spokes = &*spokes;
    let normal = |pair: &[DVec3]| {
        let (left, right) = (pair[0].yzx() * pair[1].zxy(), pair[0].zxy() * pair[1].yzx());
        (left - right, left.abs() + right.abs())
    };
    let along: DVec3 = spokes.windows(2).map(|pair| normal(pair).0.normalize_or_zero()).sum();
    let are_upright = spokes.windows(2).all(|pair| {
        let (normal, permanent) = normal(pair);
        normal.dot(along) > NORMAL_BOUND * permanent.dot(along.abs())
    });
    are_upright && turns_once(spokes, along)
}

/// Whether spokes around a vertex, counter-clockwise each from the one before as seen against a direction, go around it once: of the steps
/// from one to the next one goes from below a line through the vertex to above.
fn turns_once(spokes: &[DVec3], along: DVec3) -> bool {
    // no direction that edges are likely to have, and not that of the projection
    let mut aside = ASIDE;
    if along.dot(aside).abs() > 0.8 * along.length() {
        aside.x = -aside.x;
    }
    let mut ups = 0;
    let mut last = None;
    for spoke in spokes {
        // the coordinate along the line's normal, which is perpendicular to the direction of the projection
        let (left, right) = (spoke.yzx() * along.zxy(), spoke.zxy() * along.yzx());
        let height = aside.dot(left - right);
        if height.abs() <= SIDE_BOUND * aside.abs().dot(left.abs() + right.abs()) {
            return false;
        }
        if last == Some(false) && height > 0.0 {
            ups += 1;
        }
        last = Some(height > 0.0);
    }
    ups == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_mesh::ClosedMesh;

    fn of(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<bool> {
        let mesh = ClosedMesh::new(positions, triangles, |_| 0).expect("it is closed");
        simple_stars(mesh.positions(), mesh.triangles(), mesh.twins(), mesh.stars())
    }

    /// A double cone over a loop around the z axis.
    fn double_cone(around: &[DVec3]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let count = number32(around.len());
        let mut positions = around.to_vec();
        positions.extend([DVec3::new(0.1, 0.2, 2.0), DVec3::new(0.1, 0.2, -2.0)]);
        let sides = (0..count).flat_map(|k| [[k, (k + 1) % count, count], [(k + 1) % count, k, count + 1]]);
        (positions, sides.collect())
    }

    #[test]
    fn corners_of_a_convex_body_are_simple() {
        let around: Vec<DVec3> =
            (0..7).map(|k| DVec3::new((f64::from(k) * 0.9).cos(), (f64::from(k) * 0.9).sin(), 0.0)).collect();
        let (positions, triangles) = double_cone(&around);
        assert!(of(&positions, &triangles).iter().all(|is_simple| *is_simple));
    }

    #[test]
    fn a_fan_that_goes_around_twice_is_not() {
        let around: Vec<DVec3> = (0..7)
            .map(|k| DVec3::new((f64::from(k) * 1.8).cos(), (f64::from(k) * 1.8).sin(), 0.01 * f64::from(k)))
            .collect();
        let (positions, triangles) = double_cone(&around);
        let simple = of(&positions, &triangles);
        assert!(!simple[7] && !simple[8]);
    }
}
