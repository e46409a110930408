//! Trees of convex brushes, some of them replaced by meshes of the same bodies, against the same trees of brushes alone.

use std::fmt::Write;

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{
    Brush, ClosedMesh, EvaluateError, Evaluation, MaterialId, MeshBody, Model, Operation, Tree, evaluate,
};
use planecut_kernel::IncrementalPolytope;
use planecut_testkit::generate::{ball, turned_box};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, brush, cuboid, ensure, ensure_eq, half_space, model, sweep};

use super::integers::Convex;
use crate::tree::random::Shape;
use crate::tree::volume::check_membership;

/// A tree whose leaves have the planes of a convex body, and some the mesh of it as well, in place of which they stand.
#[derive(Debug, Clone)]
struct Mixed(Shape);

/// Corners and triangles of a mesh.
type Corners<'a> = (&'a [[f64; 3]], &'a [[u32; 3]]);

/// A leaf of [`Mixed`] as failures are printed.
#[allow(dead_code, reason = "what failures print")]
fn leaf(planes: &[([f64; 3], f64)], mesh: Option<Corners<'_>>) -> Shape {
    let planes = planes.iter().map(|(normal, offset)| half_space(DVec3::from_array(*normal), *offset));
    let mesh = mesh.map(|(positions, triangles)| {
        let positions: Vec<DVec3> = positions.iter().copied().map(DVec3::from_array).collect();
        MeshBody::new(ClosedMesh::new(&positions, triangles, |_| 0).expect("closed"), vec![MaterialId(0)])
    });
    Shape::Leaf(Brush { mesh, ..brush(planes) })
}

fn brushes_alone(shape: &Shape) -> Shape {
    match shape {
        Shape::Leaf(brush) => Shape::Leaf(Brush { mesh: None, ..brush.clone() }),
        Shape::Node(operation, operands) => Shape::Node(*operation, operands.iter().map(brushes_alone).collect()),
    }
}

fn mixed_tree(shape: &Shape) -> Tree {
    match shape {
        Shape::Leaf(Brush { mesh: Some(mesh), .. }) => mesh.clone().into(),
        Shape::Leaf(brush) => brush.clone().into(),
        Shape::Node(operation, operands) => Tree::combine(*operation, operands.iter().map(mixed_tree)),
    }
}

fn print(shape: &Shape, out: &mut String) {
    match shape {
        Shape::Leaf(brush) => {
            let planes: Vec<([f64; 3], f64)> =
                brush.half_spaces().map(|plane| (plane.normal().to_array(), plane.offset())).collect();
            write!(out, "leaf(&{planes:?}, ").expect("writing to a string");
            match &brush.mesh {
                None => out.push_str("None)"),
                Some(mesh) => {
                    let places: Vec<[f64; 3]> = mesh.positions().iter().map(DVec3::to_array).collect();
                    write!(out, "Some((&{places:?}, &{:?})))", mesh.triangles()).expect("writing to a string");
                }
            }
        }
        Shape::Node(operation, operands) => {
            write!(out, "Shape::Node(Operation::{operation:?}, vec![").expect("writing to a string");
            for operand in operands {
                print(operand, out);
                out.push_str(", ");
            }
            out.push_str("])");
        }
    }
}

fn smaller(shape: &Shape) -> Vec<Shape> {
    let Shape::Node(operation, operands) = shape else { return Vec::new() };
    let replace =
        |k: usize, with: &[Shape]| Shape::Node(*operation, [&operands[..k], with, &operands[k + 1..]].concat());
    let without = (0..operands.len()).map(|k| replace(k, &[]));
    let inner = (0..operands.len()).flat_map(|k| smaller(&operands[k]).into_iter().map(move |small| (k, small)));
    let inner = inner.map(|(k, small)| replace(k, &[small]));
    operands.iter().cloned().chain(without).chain(inner).collect()
}

impl Scene for Mixed {
    fn model(&self) -> Model {
        Model { materials: model(Vec::new()).materials, tree: mixed_tree(&self.0) }
    }

    fn smaller(&self) -> Vec<Self> {
        smaller(&self.0)
            .into_iter()
            .filter(|shape| shape.leaves().iter().any(|leaf| leaf.is_mesh()))
            .map(Self)
            .collect()
    }

    fn as_rust(&self) -> String {
        let mut out = String::from("let shape = ");
        print(&self.0, &mut out);
        out.push(';');
        out
    }
}

const OPERATIONS: [Operation; 5] =
    [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];

/// A tree over leaves that are drawn one by one.
fn random_tree(rng: &mut Rng, leaves: usize, leaf: &mut impl FnMut(&mut Rng) -> Brush) -> Shape {
    if leaves <= 1 {
        return Shape::Leaf(leaf(rng));
    }
    let operation = OPERATIONS[[0, 0, 1, 2, 2, 3, 4][rng.below(7)]];
    if operation == Operation::Complement {
        return Shape::Node(operation, vec![random_tree(rng, leaves, leaf)]);
    }
    let first = 1 + rng.below(leaves - 1);
    let mut operands = vec![random_tree(rng, first, leaf), random_tree(rng, leaves - first, leaf)];
    if rng.chance(0.2) {
        operands.push(Shape::Leaf(leaf(rng)));
    }
    Shape::Node(operation, operands)
}

/// Within a mesh, a brush, or unbounded as it may be.
fn random_mixed(rng: &mut Rng, scale: f64, mut leaf: impl FnMut(&mut Rng) -> Brush) -> Mixed {
    let leaves = 1 + rng.below(6);
    let shape = random_tree(rng, leaves, &mut leaf);
    if rng.chance(0.1) {
        return Mixed(shape);
    }
    let body = Convex::cuboid(DVec3::splat(-4.0 * scale), DVec3::new(5.0, 4.0, 4.0) * scale);
    let mesh = Some(body.mesh(rng)).filter(|_| rng.chance(0.5));
    let within = Shape::Leaf(Brush { mesh, ..body.brush() });
    Mixed(Shape::Node(Operation::Intersection, if rng.chance(0.5) { vec![shape, within] } else { vec![within, shape] }))
}

/// A body with whole corners, a half-space, or nothing; two of three bodies have meshes.
fn integer_leaf(rng: &mut Rng, turned: bool) -> Brush {
    let normal = DVec3::from_array(rng.lattice(1));
    let offset = rng.whole(-1, 4);
    match rng.below(12) {
        0 => brush([half_space(normal, offset * if turned { 5.0 } else { 1.0 })]),
        1 => brush([half_space(normal, offset), half_space(-normal, -offset - rng.whole(0, 1))]),
        _ => {
            let body = Convex::random(rng, 3, turned);
            let mesh = Some(body.mesh(rng)).filter(|_| rng.chance(0.6));
            Brush { mesh, ..body.brush() }
        }
    }
}

/// Volume and area of two outcomes, relative to their size.
fn ensure_same(found: &Evaluation, expected: &Evaluation, tolerance: f64, size: f64) -> Result<(), String> {
    let (p, q) = (&found.solid, &expected.solid);
    ensure!((p.volume - q.volume).abs() <= tolerance * size.powi(3), "volume {}, expected {}", p.volume, q.volume);
    ensure!((p.area - q.area).abs() <= tolerance * size.powi(2), "area {}, expected {}", p.area, q.area);
    Ok(())
}

fn ensure_sound(found: &Evaluation) -> Result<(), String> {
    let mesh = &found.mesh;
    if mesh.triangles.is_empty() {
        ensure_eq!((found.solid.volume, found.solid.area), (0.0, 0.0), "measures of nothing");
        return Ok(());
    }
    let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions::default());
    if let Some(problem) = report.first_problem() {
        return Err(format!("mesh: {problem}"));
    }
    let volume = report.topology.measures.volume;
    let size = 1.0 + found.solid.volume.abs();
    ensure!((volume - found.solid.volume).abs() < 1e-9 * size, "volume {volume}, stated {}", found.solid.volume);
    Ok(())
}

/// What is left where surfaces are nearer to each other than rounding: closed, but shreds lie upon one another.
fn ensure_manifold(found: &Evaluation) -> Result<(), String> {
    let report = planecut_check::check_topology(&found.mesh.positions, &found.mesh.triangles);
    ensure!(found.mesh.triangles.is_empty() || (report.watertight && report.manifold), "{:?}", report.first_defect);
    Ok(())
}

/// The summary of a mixed model follows from that of its brushes.
fn ensure_summary(shape: &Shape, found: &Evaluation) -> Result<(), String> {
    let leaves = shape.leaves();
    let places: Vec<usize> = (0..leaves.len()).filter(|k| !leaves[*k].is_mesh()).collect();
    let kept: Vec<Brush> = places.iter().map(|k| leaves[*k].clone()).collect();
    let expected = planecut_csg::summarize(&model(kept));
    let among_all = |numbers: &[usize]| -> Vec<usize> { numbers.iter().map(|k| places[*k]).collect() };
    ensure_eq!(found.model.brushes, leaves.len(), "number of brushes");
    ensure_eq!(found.model.planes, expected.planes, "number of planes");
    ensure_eq!(found.model.empty, among_all(&expected.empty), "empty brushes");
    ensure_eq!(found.model.unbounded, among_all(&expected.unbounded), "unbounded brushes");
    Ok(())
}

/// What holds for a mixed tree; `size` is that of its coordinates.
fn judge(mixed: &Mixed, tolerance: f64, size: f64) -> Result<(), String> {
    let alone = brushes_alone(&mixed.0);
    let found = evaluate(&mixed.model());
    let expected = evaluate(&alone.model());
    let (found, expected) = match (found, expected) {
        (Err(EvaluateError::Unbounded), Err(EvaluateError::Unbounded)) => return Ok(()),
        (found, expected) => {
            (found.map_err(|e| format!("mixed: {e}"))?, expected.map_err(|e| format!("brushes alone: {e}"))?)
        }
    };
    ensure_sound(&found)?;
    ensure_same(&found, &expected, tolerance, size)?;
    if mixed.0.leaves().iter().any(|leaf| leaf.is_mesh()) {
        ensure_summary(&mixed.0, &found)?;
    }
    check_membership(&alone, &found, 24).or_else(|text| if text.starts_with("only ") { Ok(()) } else { Err(text) })
}

#[test]
fn trees_on_a_grid_are_those_of_brushes_alone() {
    sweep(2000, |rng| random_mixed(rng, 1.0, |rng| integer_leaf(rng, false)), |mixed| judge(mixed, 1e-9, 1.0));
}

#[test]
fn trees_of_bodies_turned_exactly_are_those_of_brushes_alone() {
    sweep(1000, |rng| random_mixed(rng, 5.0, |rng| integer_leaf(rng, true)), |mixed| judge(mixed, 1e-9, 5.0));
}

/// A body whose corners are no numbers, and its mesh of rounded corners, by the polytope of the kernel.
fn rounded(rng: &mut Rng) -> (Brush, MeshBody) {
    let at = rng.point(-1.0, 1.0);
    let body = if rng.chance(0.5) {
        let half = rng.point(0.4, 1.6);
        turned_box(rng, at, half)
    } else {
        let (radius, planes) = (rng.float(0.5, 1.5), 6 + rng.below(20));
        ball(rng, at, radius, planes)
    };
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    body.half_spaces().for_each(|plane| {
        polytope.add_plane(*plane);
    });
    let (corners, faces) = polytope.to_mesh();
    let corner = |k: usize| u32::try_from(k).expect("few corners");
    let fan = |face: &Vec<usize>| -> Vec<[u32; 3]> {
        (1..face.len() - 1).map(|k| [face[0], face[k], face[k + 1]].map(corner)).collect()
    };
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(fan).collect();
    let mesh = ClosedMesh::new(&corners, &triangles, |_| 0).expect("the boundary of a convex body is closed");
    (body, MeshBody::new(mesh, vec![MaterialId(0)]))
}

/// Bodies in general position, half-spaces, and now and then the body before, so that its brush meets its rounded mesh.
fn rounded_mixed(rng: &mut Rng) -> Mixed {
    let mut last: Option<(Brush, MeshBody)> = None;
    random_mixed(rng, 1.0, |rng| {
        if rng.chance(0.1) {
            let normal = rng.unit();
            return brush([half_space(normal, rng.float(-0.5, 1.0))]);
        }
        let (body, mesh) = last.take().filter(|_| rng.chance(0.3)).unwrap_or_else(|| rounded(rng));
        last = Some((body.clone(), mesh.clone()));
        Brush { mesh: Some(mesh).filter(|_| rng.chance(0.5)), ..body }
    })
}

#[test]
fn trees_of_rounded_meshes_are_nearly_those_of_brushes_alone() {
    sweep(200, rounded_mixed, |mixed| {
        // where a brush meets its own mesh, slivers have an area that brushes alone have not
        let alone = evaluate(&brushes_alone(&mixed.0).model());
        let found = evaluate(&mixed.model());
        let (found, alone) = match (found, alone) {
            (Err(EvaluateError::Unbounded), Err(EvaluateError::Unbounded)) => return Ok(()),
            (found, alone) => (found.map_err(|e| format!("mixed: {e}"))?, alone.map_err(|e| format!("alone: {e}"))?),
        };
        ensure_manifold(&found)?;
        let (volume, expected) = (found.solid.volume, alone.solid.volume);
        ensure!((volume - expected).abs() < 1e-9, "volume {volume}, expected {expected}");
        ensure_summary(&mixed.0, &found)
    });
}

/// A mesh far away, so that brushes are evaluated as meshes are.
fn far() -> Tree {
    let body = Convex::cuboid(DVec3::splat(40.0), DVec3::splat(41.0));
    body.mesh(&mut Rng::new(1)).into()
}

fn outcome(tree: Tree) -> Evaluation {
    evaluate(&Model { materials: model(Vec::new()).materials, tree }).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn brushes_beside_a_mesh_are_what_they_are_alone() {
    for seed in 0..planecut_testkit::scene::scaled(100) {
        let rng = &mut Rng::spread(seed);
        let [(a, mesh), (b, _)] = [rounded(rng), rounded(rng)];
        let [a, b] = [a, b].map(Tree::from);
        for operation in &OPERATIONS[..4] {
            let alone = outcome(Tree::combine(*operation, [a.clone(), b.clone()]));
            let beside = outcome(Tree::combine(*operation, [a.clone(), b.clone()]) | far());
            let (p, q) = (alone.solid, beside.solid);
            assert!((p.volume + 1.0 - q.volume).abs() < 1e-9, "seed {seed}, {operation:?}: {} {}", p.volume, q.volume);
            assert!((p.area + 6.0 - q.area).abs() < 1e-9, "seed {seed}, {operation:?}: {} {}", p.area, q.area);
            ensure_sound(&beside).unwrap_or_else(|error| panic!("seed {seed}, {operation:?}: {error}"));
        }
        assert_eq!(outcome(a.clone() | a.clone() | far()).mesh, outcome(a.clone() | far()).mesh, "seed {seed}");
        assert_eq!(outcome((a.clone() & a.clone()) | far()).mesh, outcome(a.clone() | far()).mesh, "seed {seed}");
        for nothing in [a.clone() - a.clone(), a.clone() ^ a.clone(), a.clone() & !a.clone()] {
            assert_eq!(outcome(nothing & far()).mesh.triangles.len(), 0, "seed {seed}");
        }
        assert_eq!(outcome((a.clone() - a.clone()) | far()).mesh, outcome(far()).mesh, "seed {seed}");
        // the mesh has rounded corners, the brush has not
        for less in [Tree::from(mesh.clone()) - a.clone(), a.clone() - mesh.clone().into(), a ^ mesh.into()] {
            let less = outcome(less);
            assert!(less.solid.volume.abs() < 1e-12, "seed {seed}: {}", less.solid.volume);
            ensure_manifold(&less).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        }
    }
}

#[test]
fn unbounded_brushes_beside_meshes() {
    let cube = || Tree::from(Convex::cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh(&mut Rng::new(3)));
    let below = |normal: DVec3, offset: f64| Tree::from(brush([half_space(normal, offset)]));
    let slab = below(DVec3::Z, 0.5);
    assert_eq!(outcome(cube() - slab.clone()).solid.volume, 6.0);
    assert_eq!(outcome(cube() & slab.clone()).solid.volume, 2.0);
    assert_eq!(outcome(cube() - below(DVec3::ONE, 3.0)).solid.volume, 4.0);
    assert_eq!(outcome(cube() & !slab.clone()).model.unbounded, [1]);
    let unbounded = |tree: Tree| {
        let found = evaluate(&Model { materials: model(Vec::new()).materials, tree });
        assert!(matches!(found, Err(EvaluateError::Unbounded)), "{found:?}");
    };
    unbounded(cube() | slab.clone());
    unbounded(cube() ^ slab.clone());
    unbounded(slab.clone() - cube());
    unbounded(!cube());
    unbounded(!(cube() | slab.clone()));
    unbounded(Tree::everything() - cube());
    // six half-spaces leave a box, whatever holds outside of all leaves
    let sides = DVec3::AXES.into_iter().flat_map(|axis| [below(axis, 1.0), below(-axis, -3.0)]);
    let room = !Tree::union(sides);
    assert_eq!(outcome(room.clone()).solid.volume, 8.0, "brushes alone");
    assert_eq!(outcome(room.clone() | cube()).solid.volume, 15.0);
    assert_eq!(outcome(room - cube()).solid.volume, 7.0);
}

#[test]
fn nothing_and_everything_beside_meshes() {
    let cube = || Tree::from(Convex::cuboid(DVec3::ZERO, DVec3::splat(2.0)).mesh(&mut Rng::new(5)));
    let empty = || Tree::from(cuboid(DVec3::ONE, DVec3::ZERO));
    assert_eq!(outcome(cube() | empty()).model.empty, [1]);
    assert_eq!(outcome(empty() | cube()).model.empty, [0]);
    assert_eq!(outcome(cube() - empty()).solid.volume, 8.0);
    assert_eq!(outcome(cube() & empty()).solid.volume, 0.0);
    assert_eq!(outcome(cube() & Tree::everything()).solid.volume, 8.0);
    assert_eq!(outcome(Tree::everything() & cube()).solid.volume, 8.0);
    assert_eq!(outcome(cube() & Brush::default().into()).solid.volume, 8.0, "a brush without planes is everything");
}
