//! Models of any size that are edited, in tests and benchmarks: a plate with many holes, and a block minus a grid of capsules.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};
use planecut_csg::{Brush, BrushId, Material, Model, Transform, Tree};
use planecut_kernel::PlaneIdx;

use crate::scene::{brush, cuboid, half_space};

/// Number of sides of a hole in a [`plate`].
const SEGMENTS: u32 = 24;

/// Thickness of a [`plate`], and how deep its holes are.
const THICKNESS: f64 = 1.0;
const DEPTH: f64 = 0.6;

/// The brush of a [`plate`] without its holes.
pub const PLATE: BrushId = BrushId(0);
/// The side of a [`plate`] at large x, 0.2 away from the nearest hole.
pub const PLATE_SIDE: PlaneIdx = PlaneIdx(0);
/// The top of a [`plate`].
pub const PLATE_TOP: PlaneIdx = PlaneIdx(4);
/// The plane of each hole in a [`plate`] at which it ends within the plate.
pub const HOLE_END: PlaneIdx = PlaneIdx(25);

/// A plate on the ground, of one unit for each of `side` × `side` holes from above: cylinders of 24 sides that end within it. The holes are the brushes from 1
/// on. It has `96·side² + 12` triangles.
#[must_use]
pub fn plate(side: u32) -> Model {
    let block = cuboid(DVec3::ZERO, DVec3::new(side.into(), side.into(), THICKNESS));
    let places = (0..side * side).map(|k| DVec3::new(0.5 + f64::from(k % side), 0.5 + f64::from(k / side), 0.0));
    difference(block, places.map(hole))
}

fn hole(middle: DVec3) -> Brush {
    const RADIUS: f64 = 0.3;
    let side = |k: u32| {
        let (sine, cosine) = (TAU * f64::from(k) / f64::from(SEGMENTS)).sin_cos();
        let normal = DVec3::new(cosine, sine, 0.0);
        half_space(normal, normal.dot(middle) + RADIUS)
    };
    let ends = [half_space(DVec3::Z, 2.0 * THICKNESS), half_space(-DVec3::Z, DEPTH - THICKNESS)];
    brush((0..SEGMENTS).map(side).chain(ends))
}

/// A block minus a grid of `side`³ capsules of 60 planes each, which are the brushes from 1 on.
#[must_use]
pub fn capsule_grid(side: u32) -> Model {
    let block = cuboid(DVec3::splat(-1.0), DVec3::splat(side.into()));
    let places = (0..side.pow(3)).map(|k| [k % side, k / side % side, k / side.pow(2)]);
    difference(block, places.map(|place| capsule(DVec3::from_array(place.map(f64::from)))))
}

/// 60 planes around a segment along z.
fn capsule(middle: DVec3) -> Brush {
    const COUNT: u32 = 60;
    brush((0..COUNT).map(|k| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(COUNT);
        let (sine, cosine) = (f64::from(k) * PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
        let normal = DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z);
        let end = DVec3::new(0.0, 0.0, 0.25_f64.copysign(z));
        half_space(normal, normal.dot(middle + end) + 0.2)
    }))
}

fn difference(block: Brush, others: impl Iterator<Item = Brush>) -> Model {
    let tree = Tree::difference(std::iter::once(block).chain(others).map(Tree::from));
    Model { materials: vec![Material::named("block")], tree }
}

/// The model turned by an angle that has nothing to do with its planes, and moved far from the origin: no two planes that were
/// parallel to an axis have a coefficient of zero, and what was meant to be one plane is nearly one.
///
/// # Panics
/// Where a plane is too far away to be moved.
#[must_use]
pub fn turned_far_away(model: &Model) -> Model {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0_f64.sqrt(), 3.0_f64.sqrt()).normalize(), 0.7);
    let transform = Transform::new(turn, 1e4 * DVec3::new(PI, 2.0_f64.sqrt(), -1.0)).expect("a rotation");
    let mut model = model.clone();
    for brush in model.tree.brushes_mut() {
        *brush = brush.clone().transformed(&transform).expect("planes that are not too far away");
    }
    model
}

#[cfg(test)]
mod tests {
    use super::{capsule_grid, plate, turned_far_away};
    use planecut_csg::evaluate;

    #[test]
    fn a_plate_has_the_triangles_that_it_says() {
        for side in [1, 2, 12] {
            let count = 96 * side as usize * side as usize + 12;
            for model in [plate(side), turned_far_away(&plate(side))] {
                assert_eq!(evaluate(&model).unwrap().mesh.triangles.len(), count, "{side}");
            }
        }
    }

    #[test]
    fn capsules_do_not_touch() {
        let evaluation = evaluate(&capsule_grid(2)).unwrap();
        let components = 9;
        let (vertices, triangles) = (evaluation.mesh.positions.len(), evaluation.mesh.triangles.len());
        assert_eq!(vertices - triangles / 2, 2 * components);
    }
}
