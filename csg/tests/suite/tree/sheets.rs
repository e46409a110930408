//! Many faces around one line or point: wedges, pencils of planes, cones and grids with diagonal planes, mostly as exclusive or, where a
//! solid alternates around the line. Judged by the exact order of the faces around each line of the mesh, by volume and by membership.

use glam::DVec3;
use planecut_csg::{Brush, BrushFace, MaterialId, Operation, UnboundedBrushes};

use super::random::Shape;
use super::volume::{check_membership, check_volume};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, brush, cuboid, half_space, sweep};
use planecut_testkit::sheets::check_around_lines;
use planecut_testkit::soundness::evaluate_soundly_with;

fn judge(shape: &Shape) -> Result<(), String> {
    let model = shape.model();
    let evaluation = evaluate_soundly_with(&model, UnboundedBrushes::Keep)?;
    check_around_lines(&model, &evaluation.mesh)?;
    check_volume(shape, &evaluation)?;
    check_membership(shape, &evaluation, 40)
}

/// An exclusive or of bodies mostly, within a box; other operations here and there.
fn joined(rng: &mut Rng, mut bodies: Vec<Shape>, bounds: Shape) -> Shape {
    if bodies.len() > 2 && rng.chance(0.4) {
        let others = bodies.split_off(bodies.len() / 2);
        let operation = rng.pick(&[Operation::Union, Operation::Difference, Operation::Intersection, Operation::Xor]);
        bodies.push(Shape::Node(operation, others));
    }
    let operation = if rng.chance(0.8) { Operation::Xor } else { Operation::Union };
    Shape::Node(Operation::Intersection, vec![Shape::Node(operation, bodies), bounds])
}

/// A body of some planes through a point, of one or several materials.
fn through(rng: &mut Rng, point: DVec3, count: i64, normal: impl Fn(&mut Rng) -> DVec3) -> Brush {
    let materials = rng.pick(&[1, 1, 3]);
    let face = |rng: &mut Rng| {
        let normal = normal(rng);
        let material = MaterialId(rng.below(materials) as u32);
        BrushFace { half_space: half_space(normal, normal.dot(point)), material }
    };
    Brush { faces: (0..rng.integer(1, count)).map(|_| face(rng)).collect(), ..Brush::default() }
}

fn integers(rng: &mut Rng, reach: i64) -> DVec3 {
    DVec3::from_array(rng.lattice(reach))
}

/// Wedges of one to three planes through the z axis.
fn wedges(rng: &mut Rng) -> Shape {
    let reach = rng.integer(1, 3);
    let normal = |rng: &mut Rng| loop {
        let normal = DVec3::new(rng.whole(-reach, reach), rng.whole(-reach, reach), 0.0);
        if normal != DVec3::ZERO {
            return normal;
        }
    };
    let bodies = (0..rng.integer(2, 6)).map(|_| Shape::Leaf(through(rng, DVec3::ZERO, 3, normal))).collect();
    joined(rng, bodies, Shape::Leaf(cuboid(DVec3::NEG_ONE, DVec3::ONE)))
}

/// Wedges of planes through one line of any direction, and through one beside it.
fn pencils(rng: &mut Rng) -> Shape {
    let along = integers(rng, 2);
    let places = [integers(rng, 1), integers(rng, 2)];
    let mut bodies = Vec::new();
    for _ in 0..rng.integer(2, 6) {
        let normal = |rng: &mut Rng| loop {
            let normal = along.cross(integers(rng, 2));
            if normal != DVec3::ZERO {
                return normal;
            }
        };
        let place = places[usize::from(rng.chance(0.2))];
        let mut body = through(rng, place, 3, normal);
        if rng.chance(0.3) {
            let cap = integers(rng, 1);
            body.faces.push(BrushFace { half_space: half_space(cap, rng.whole(-1, 2)), material: MaterialId(0) });
        }
        bodies.push(Shape::Leaf(body));
    }
    joined(rng, bodies, Shape::Leaf(cuboid(DVec3::splat(-3.0), DVec3::splat(3.0))))
}

/// Cones of planes through one point.
fn cones(rng: &mut Rng) -> Shape {
    let point = integers(rng, 1);
    let normal = |rng: &mut Rng| integers(rng, 1);
    let bodies = (0..rng.integer(2, 5)).map(|_| Shape::Leaf(through(rng, point, 4, normal))).collect();
    joined(rng, bodies, Shape::Leaf(cuboid(DVec3::splat(-3.0), DVec3::splat(3.0))))
}

/// Bodies of planes along the axes and diagonals, through points of a grid.
fn diagonals(rng: &mut Rng) -> Shape {
    let reach = rng.integer(1, 2);
    let mut bodies = Vec::new();
    for _ in 0..rng.integer(2, 6) {
        let plane = |rng: &mut Rng| {
            let mut normal = integers(rng, 1);
            if normal.abs().element_sum() > 2.0 {
                normal[rng.below(3)] = 0.0;
            }
            half_space(normal, rng.whole(-reach, reach))
        };
        bodies.push(Shape::Leaf(brush((0..rng.integer(1, 5)).map(|_| plane(rng)).collect::<Vec<_>>())));
    }
    joined(rng, bodies, Shape::Leaf(cuboid(DVec3::splat(-2.0), DVec3::splat(2.0))))
}

#[test]
fn wedges_through_an_axis() {
    sweep(1500, wedges, judge);
}

#[test]
fn pencils_of_planes() {
    sweep(1500, pencils, judge);
}

#[test]
fn cones_of_planes() {
    sweep(1000, cones, judge);
}

#[test]
fn grids_with_diagonals() {
    sweep(1000, diagonals, judge);
}
