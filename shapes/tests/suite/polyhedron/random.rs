//! Surfaces of random trees.

use glam::{DMat3, DVec3};
use planecut_check::check_topology;
use planecut_csg::{MaterialId, Model, Operation, Transform, Tree, evaluate};
use planecut_shapes::polyhedron::{PolyhedronError, Precision};
use planecut_shapes::primitives::{cuboid, prism, sphere, torus};

use super::judge::{Given, ensure_membership, ensure_skin};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, random_shape};

/// The surface of a shape: its triangles, or nothing.
fn surface(shape: &Shape) -> Result<Option<(Given, usize, Option<i64>)>, String> {
    let Model { materials, tree } = shape.model();
    let mesh = evaluate(&Model { materials, tree }).map_err(|error| error.to_string())?.mesh;
    let topology = check_topology(&mesh.positions, &mesh.triangles);
    let facets = mesh.triangles.iter().map(|triangle| triangle.to_vec()).collect();
    let given = Given { points: mesh.positions, facets };
    Ok((!given.facets.is_empty()).then_some((given, topology.components, topology.genus)))
}

/// Whether two corners are the same place: sheets touch there, and noise parts or joins them.
fn touches_itself(given: &Given) -> bool {
    let mut places: Vec<[u64; 3]> = given.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    places.sort_unstable();
    places.windows(2).any(|pair| pair[0] == pair[1])
}

fn judge(shape: &Shape) -> Result<(), String> {
    let Some((given, components, genus)) = surface(shape)? else { return Ok(()) };
    let tolerance = 1e-10 * given.size() * given.area();
    let solid = given.cells(Precision::Double).map_err(|error| format!("refused: {error}"))?;
    ensure!((solid.volume - given.volume()).abs() <= tolerance, "volume {}, expected {}", solid.volume, given.volume());
    ensure!(!solid.is_turned, "turned over");
    ensure_membership(&given, &solid.cells, 40, 1e-9)?;
    let found = ensure_skin(&solid.cells, given.volume(), tolerance)?;
    ensure!(
        touches_itself(&given) || found == (components, genus),
        "{found:?} components and genus, expected {:?}",
        (components, genus)
    );
    Ok(())
}

fn random(kind: Kind, leaves: usize, count: u64) {
    sweep(count, |rng| bounded(random_shape(rng, kind, leaves)), judge);
}

#[test]
fn trees_of_boxes() {
    random(Kind::Boxes, 8, 60);
}

#[test]
fn trees_of_sloped_bodies() {
    random(Kind::Sloped, 6, 60);
}

#[test]
fn trees_of_turned_bodies() {
    random(Kind::Turned, 6, 40);
}

#[test]
fn trees_of_all_bodies() {
    random(Kind::Mixed, 8, 40);
}

/// Rings, balls, prisms and boxes at lattice points, some of them turned: combined, they touch and nearly touch anyhow.
fn bodies(rng: &mut Rng) -> Shape {
    let count = 2 + rng.below(5);
    let operations = [Operation::Union, Operation::Union, Operation::Difference, Operation::Xor];
    (1..count).fold(body(rng), |shape, _| Shape::Node(rng.pick(&operations), vec![shape, body(rng)]))
}

fn body(rng: &mut Rng) -> Shape {
    let mut number = |low, high| rng.whole(low, high);
    let (at, size) =
        (DVec3::new(number(0, 7), number(0, 7), number(0, 7)), DVec3::new(number(1, 5), number(1, 5), number(1, 5)));
    let (sides, rings) = (number(3, 11) as u32, number(3, 11) as u32);
    let material = MaterialId(0);
    let tree: Tree = match number(0, 3) as u32 {
        0 => cuboid(DVec3::ZERO, size, material).expect("a box").into(),
        1 => prism(size.x, 0.5 * size.y, sides, material).expect("a prism").into(),
        2 => sphere(size.x, 2 * sides, material).expect("a ball").into(),
        _ => torus(3.0 + 0.2 * size.x, 0.2 * size.y, sides, rings, material).expect("a ring"),
    };
    let turn = if rng.chance(0.5) { DMat3::from_quat(rng.rotation()) } else { DMat3::IDENTITY };
    let placed = tree.transformed(&Transform::new(turn, at).expect("a motion")).expect("planes in range");
    Shape::Node(Operation::Union, placed.into_brushes().into_iter().map(Shape::Leaf).collect())
}

#[test]
fn rings_and_other_bodies() {
    sweep(60, bodies, judge);
}

/// Coordinates as other formats keep them: the cells have the volume of the rounded surface. What rounding lets cross itself is
/// refused; anything else is not.
fn judge_rounded(shape: &Shape, precision: Precision, round: fn(f64) -> f64, unit: f64) -> Result<(), String> {
    let Some((given, ..)) = surface(shape)? else { return Ok(()) };
    let given = given.moved(|p| DVec3::from_array(p.to_array().map(round)));
    let tolerance = 4.0 * unit * given.size() * given.area();
    let solid = match given.cells(precision) {
        Err(PolyhedronError::Crossing { .. }) => return Ok(()),
        other => other.map_err(|error| format!("refused: {error}"))?,
    };
    ensure_skin(&solid.cells, given.volume(), tolerance)?;
    ensure_membership(&given, &solid.cells, 20, 100.0 * unit * given.size())
}

#[test]
fn trees_rounded_to_single_precision() {
    let round = |v: f64| f64::from(v as f32);
    let judge = |shape: &Shape| judge_rounded(shape, Precision::Single, round, f64::from(f32::EPSILON));
    sweep(60, |rng| bounded(random_shape(rng, Kind::Mixed, 6)), judge);
}

#[test]
fn trees_rounded_to_six_digits() {
    let round = |v: f64| format!("{v:.5e}").parse().expect("a number");
    let judge = |shape: &Shape| judge_rounded(shape, Precision::Digits(6), round, 1e-5);
    sweep(60, |rng| bounded(random_shape(rng, Kind::Mixed, 6)), judge);
}
