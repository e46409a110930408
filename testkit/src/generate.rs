//! Random brushes and scenes, leaning toward degeneracy.

use std::f64::consts::PI;

use glam::DVec3;
use planecut_csg::{Brush, MaterialId, Model};
use planecut_kernel::HalfSpace;

use crate::random::Rng;
use crate::scene::{brush, cuboid, half_space, model};

fn lattice_point(rng: &mut Rng, reach: i64) -> DVec3 {
    DVec3::new(rng.whole(-reach, reach), rng.whole(-reach, reach), rng.whole(-reach, reach))
}

/// All sign choices of a vector's components.
fn signs() -> impl Iterator<Item = DVec3> {
    (0..8).map(|k| DVec3::from_array([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 1.0 } else { -1.0 })))
}

/// A convex body with small integer coefficients: many of them share planes, lines and points.
pub fn sloped_brush(rng: &mut Rng) -> Brush {
    let at = lattice_point(rng, 3);
    let size = rng.whole(1, 4);
    let slope = |normal: DVec3, through: DVec3| half_space(normal, normal.dot(through));
    match rng.integer(0, 5) {
        0 => cuboid(at, at + lattice_point(rng, 1) + 2.0 + size - 1.0),
        1 => {
            let corner = rng.pick(&signs().collect::<Vec<_>>());
            let sides = DVec3::AXES.map(|axis| slope(-axis * corner, at));
            brush(sides.into_iter().chain([slope(corner, at + corner * DVec3::X * size)]))
        }
        2 => brush(signs().map(|n| half_space(n, n.dot(at) + size))),
        3 => brush(
            signs()
                .map(|n| half_space(n, n.dot(at) + 2.0 * size))
                .chain(DVec3::AXES.into_iter().flat_map(|n| [n, -n]).map(|n| half_space(n, n.dot(at) + size))),
        ),
        4 => {
            // a box cut by slopes through lattice points, 45° and others
            let mut cut = cuboid(at - size, at + size);
            for _ in 0..rng.integer(1, 3) {
                let steepest = if rng.chance(0.5) { 1 } else { 3 };
                let normal = lattice_point(rng, steepest);
                if normal != DVec3::ZERO {
                    cut.faces.extend(brush([slope(normal, at + lattice_point(rng, 1))]).faces);
                }
            }
            cut
        }
        _ => {
            let normals: Vec<DVec3> =
                (0..rng.integer(4, 10)).map(|_| lattice_point(rng, 2)).filter(|n| *n != DVec3::ZERO).collect();
            let offset = |n: DVec3, rng: &mut Rng| n.dot(at) + rng.whole(1, 4);
            let free: Vec<HalfSpace> = normals.into_iter().map(|n| half_space(n, offset(n, rng))).collect();
            brush(free.into_iter().chain(cuboid(at - 4.0, at + 4.0).faces.into_iter().map(|face| face.half_space)))
        }
    }
}

/// Two to six sloped brushes.
pub fn sloped_scene(rng: &mut Rng) -> Model {
    model((0..rng.integer(2, 6)).map(|_| sloped_brush(rng)).collect())
}

/// A turned box with the given half extents.
pub fn turned_box(rng: &mut Rng, at: DVec3, half: DVec3) -> Brush {
    let rotation = rng.rotation();
    let sides = |k: usize| {
        let normal = rotation * DVec3::AXES[k];
        [half_space(normal, normal.dot(at) + half[k]), half_space(-normal, -normal.dot(at) + half[k])]
    };
    brush((0..3).flat_map(sides))
}

/// A body of `planes` planes whose normals spread evenly over the sphere.
pub fn ball(rng: &mut Rng, at: DVec3, radius: f64, planes: usize) -> Brush {
    let rotation = rng.rotation();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    brush((0..planes).map(|k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / planes as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let normal = rotation * DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
        half_space(normal, normal.dot(at) + radius)
    }))
}

/// A brush of any kind around a point: boxes, balls, slabs, needles, tiny ones.
fn any_brush(rng: &mut Rng) -> Brush {
    let at = rng.point(-1.0, 1.0);
    let thin = 10_f64.powi(-rng.integer(2, 9) as i32);
    match rng.integer(0, 6) {
        0 | 1 => {
            let half = rng.point(0.2, 1.0);
            turned_box(rng, at, half)
        }
        2 | 3 => {
            let (radius, planes) = (rng.float(0.3, 1.0), 6 + rng.below(30));
            ball(rng, at, radius, planes)
        }
        4 => turned_box(rng, at, DVec3::new(1.0, 0.8, thin)),
        5 => turned_box(rng, at, DVec3::new(1.5, thin, thin * 0.7)),
        _ => turned_box(rng, at, DVec3::splat(1e-3)),
    }
}

/// Brushes in general position.
pub fn general_scene(rng: &mut Rng) -> Model {
    model((0..rng.integer(2, 6)).map(|_| any_brush(rng)).collect())
}

/// Brushes that share planes: kin made from planes of earlier ones, given at other scales, on either side.
pub fn kindred_scene(rng: &mut Rng) -> Model {
    let mut brushes = vec![any_brush(rng)];
    for _ in 0..rng.integer(1, 5) {
        let mut next = any_brush(rng);
        for _ in 0..rng.integer(1, 4) {
            let other = brushes[rng.below(brushes.len())].clone();
            let face = rng.pick(&other.faces);
            let scale = rng.pick(&[1.0, 3.0, 1.0 / 7.0, 0.1, 1e5]) * if rng.chance(0.5) { 1.0 } else { -1.0 };
            let plane = &face.half_space;
            next.faces.extend(brush([half_space(plane.normal() * scale, plane.offset() * scale)]).faces);
        }
        brushes.push(next);
    }
    model(brushes)
}

/// Cuts some brushes in two along planes that cross them: the parts share a wall, and mostly all other planes.
pub fn split(brushes: &mut Vec<Brush>, cuts: usize, mut cut: impl FnMut() -> HalfSpace) {
    for _ in 0..cuts {
        let plane = cut();
        let k = (plane.normal().to_array().map(f64::to_bits).into_iter().fold(0, u64::wrapping_add) >> 7) as usize;
        let k = k % brushes.len();
        let mut rest = brushes[k].clone();
        brushes[k].faces.extend(brush([plane]).faces);
        rest.faces.extend(brush([plane.flipped()]).faces);
        brushes.push(rest);
    }
}

/// Moves each coefficient of each plane by up to `relative` of the largest one.
pub fn with_noise(rng: &mut Rng, mut model: Model, relative: f64) -> Model {
    for face in model.tree.brushes_mut().iter_mut().flat_map(|brush| &mut brush.faces) {
        let (normal, offset) = (face.half_space.normal(), face.half_space.offset());
        let size = normal.abs().max_element() * relative;
        let moved = offset + rng.float(-1.0, 1.0) * size.max(offset.abs() * relative);
        face.half_space = half_space(normal + rng.point(-1.0, 1.0) * size, moved);
    }
    model
}

/// Scales a model about the origin, then moves it, in rounded coefficients.
pub fn placed(mut model: Model, scale: f64, shift: DVec3) -> Model {
    for face in model.tree.brushes_mut().iter_mut().flat_map(|brush| &mut brush.faces) {
        let (normal, offset) = (face.half_space.normal(), face.half_space.offset());
        face.half_space = half_space(normal, offset * scale + normal.dot(shift));
    }
    model
}

/// Gives each face, or each brush as a whole, a material at random.
pub fn with_materials(rng: &mut Rng, scene: Model, count: i64) -> Model {
    let mut brushes = scene.tree.into_brushes();
    for brush in &mut brushes {
        let (one, mixed) = (rng.integer(0, count - 1), rng.chance(0.5));
        for face in &mut brush.faces {
            face.material = MaterialId(if mixed { rng.integer(0, count - 1) } else { one } as u32);
        }
    }
    model(brushes)
}
