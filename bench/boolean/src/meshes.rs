//! The scenes of closed meshes that are timed, each made of a file, or of plain numbers and a seed.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};

use planecut_kernel::{DMat3, DVec3};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

use crate::scene::{Body, Entry, Matrix, Scene};
use crate::stl;
use crate::workloads::{Task, rotation};

/// Two files, each moved by a matrix, and the volume of the first without the second.
pub(crate) struct Pair {
    pub(crate) files: [PathBuf; 2],
    pub(crate) matrices: [Matrix; 2],
    pub(crate) volume: f64,
}

/// The first of two meshes minus the second; the kernels move them.
pub(crate) fn pair(pair: &Pair) -> Result<Task, String> {
    let body = |k: usize| -> Result<Body, String> {
        Ok(Body { matrix: Some(pair.matrices[k]), ..stl::read(&pair.files[k])? })
    };
    let bodies = vec![body(0)?, body(1)?];
    Ok(Task::of_volume(Scene::batch(bodies, Entry::Difference), pair.volume))
}

/// What is taken away from a mesh: a copy of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Copied {
    /// Moved by (0.31, 0.17, 0.23) of its box.
    Moved,
    /// Where it is; nothing must be left.
    Itself,
    /// Moved along x by 0.31 of its box: what is parallel to x lies upon itself.
    Flat,
    /// Turned by 90° about the vertical edge of its box at the least x and y.
    Turned,
}

/// A mesh minus a copy of it.
pub(crate) fn minus_copy(file: &Path, copied: Copied) -> Result<Task, String> {
    let body = stl::read(file)?;
    let positions = || body.positions.iter().map(|place| DVec3::from_array(*place));
    let (min, max) = positions().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)));
    let shift = |share: DVec3| move |place: DVec3| place + share * (max - min);
    let copy = match copied {
        Copied::Moved => moved(&body, shift(DVec3::new(0.31, 0.17, 0.23))),
        Copied::Itself => body.clone(),
        Copied::Flat => moved(&body, shift(DVec3::new(0.31, 0.0, 0.0))),
        Copied::Turned => {
            moved(&body, |place| DVec3::new(min.x - (place.y - min.y), min.y + (place.x - min.x), place.z))
        }
    };
    let scene = Scene::batch(vec![body, copy], Entry::Difference);
    Ok(if copied == Copied::Itself { Task::of_volume(scene, 0.0) } else { Task::new(scene) })
}

/// The union of two spheres of about a number of triangles each.
pub(crate) fn spheres(triangles: usize) -> Task {
    let first = sphere(segments(triangles));
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.1);
    let second = moved(&first, |place| turn * place + DVec3::new(0.7, 0.2, 0.1));
    Task::new(Scene::batch(vec![first, second], Entry::Union))
}

/// Into how many parts each edge of an octahedron is cut for a number of triangles.
fn segments(triangles: usize) -> u32 {
    (triangles as f64 / 8.0).sqrt().round() as u32
}

/// An octahedron of which each edge is cut into parts, pushed to the unit sphere so that triangles are about equally large.
fn sphere(segments: u32) -> Body {
    let mut body = Body::default();
    let mut number = std::collections::HashMap::new();
    let mut corner = |place: [i64; 3]| {
        *number.entry(place).or_insert_with(|| {
            let pushed = place.map(|v| (FRAC_PI_2 * v as f64 / f64::from(segments)).sin());
            body.positions.push(DVec3::from_array(pushed).normalize().to_array());
            body.positions.len() as u32 - 1
        })
    };
    let n = i64::from(segments);
    for signs in (0..8).map(|k| [0, 1, 2].map(|axis| 1 - 2 * (k >> axis & 1))) {
        let is_mirrored = signs.iter().product::<i64>() < 0;
        let mut at = |i: i64, j: i64| corner([signs[0] * (n - i - j), signs[1] * i, signs[2] * j]);
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            let mut corners = vec![[at(i, j), at(i + 1, j), at(i, j + 1)]];
            if i + j + 2 <= n {
                corners.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
            let turned = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
            body.triangles.extend(corners.into_iter().map(turned));
        }
    }
    body
}

/// Segments of a torus around its axis and around its tube, and its radii.
const AROUND: [u32; 2] = [24, 12];
const RADII: [f64; 2] = [1.0, 0.35];

/// Side of the cube that the middles of tori are in.
const SIDE: f64 = 12.0;

/// The union of tori of 576 triangles, turned at random.
pub(crate) fn tori(count: usize) -> Task {
    let mut rng = StdRng::seed_from_u64(count as u64);
    let torus = torus();
    let body = |_| {
        let turn = rotation(&mut rng);
        let middle = DVec3::from_array([0; 3].map(|_| rng.random_range(0.0..SIDE)));
        moved(&torus, |place| turn * place + middle)
    };
    Task::new(Scene::batch((0..count).map(body).collect(), Entry::Union))
}

fn torus() -> Body {
    let [around, of_tube] = AROUND;
    let mut body = Body::default();
    for (i, j) in (0..around).flat_map(|i| (0..of_tube).map(move |j| (i, j))) {
        let [(sin, cos), (up, out)] =
            [(i, around), (j, of_tube)].map(|(k, n)| (TAU * f64::from(k) / f64::from(n)).sin_cos());
        let radius = RADII[0] + RADII[1] * out;
        body.positions.push([radius * cos, radius * sin, RADII[1] * up]);
        let corner = |i: u32, j: u32| (i % around) * of_tube + j % of_tube;
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        body.triangles.extend([[a, b, c], [a, c, d]]);
    }
    body
}

fn moved(body: &Body, map: impl Fn(DVec3) -> DVec3) -> Body {
    let positions = body.positions.iter().map(|place| map(DVec3::from_array(*place)).to_array()).collect();
    Body { positions, ..body.clone() }
}

#[cfg(test)]
mod tests {
    use planecut_csg::ClosedMesh;

    use super::*;

    fn volume(body: &Body) -> f64 {
        let place = |corner: u32| DVec3::from_array(body.positions[corner as usize]);
        let six = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(place);
            a.cross(b).dot(c)
        };
        body.triangles.iter().map(six).sum::<f64>() / 6.0
    }

    fn is_closed(body: &Body) -> bool {
        let positions: Vec<DVec3> = body.positions.iter().copied().map(DVec3::from_array).collect();
        ClosedMesh::new(&positions, &body.triangles, |_| 0).is_ok()
    }

    #[test]
    fn spheres_have_as_many_triangles_as_are_asked_for() {
        let counts = [1000, 32_000, 200_000, 1_000_000].map(|count| 8 * segments(count).pow(2));
        assert_eq!(counts, [968, 31_752, 199_712, 1_002_528]);
        let ball = sphere(20);
        assert_eq!((ball.triangles.len(), is_closed(&ball)), (3200, true));
        let share = volume(&ball) / (4.0 / 3.0 * std::f64::consts::PI);
        assert!(share > 0.99 && share < 1.0, "{share}");
    }

    #[test]
    fn tori_are_closed() {
        let torus = torus();
        assert_eq!((torus.triangles.len(), is_closed(&torus)), (576, true));
        let share = volume(&torus) / (TAU * std::f64::consts::PI * RADII[0] * RADII[1].powi(2));
        assert!(share > 0.93 && share < 1.0, "{share}");
    }
}
