//! Random trees that can be made smaller and printed.

use std::fmt::Write;

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{Brush, Model, Operation, Tree, UnboundedBrushes};

use super::volume::{check_membership, check_volume};
use planecut_testkit::generate::{ball, sloped_brush, turned_box};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, brush, cuboid, half_space, model, sweep};
use planecut_testkit::soundness::evaluate_soundly_with;

/// A tree of a test.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Leaf(Brush),
    Node(Operation, Vec<Self>),
}

const OPERATIONS: [Operation; 5] =
    [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];

impl Shape {
    pub(crate) fn tree(&self) -> Tree {
        match self {
            Self::Leaf(brush) => Tree::from(brush.clone()),
            Self::Node(operation, operands) => Tree::combine(*operation, operands.iter().map(Self::tree)),
        }
    }

    pub(crate) fn leaves(&self) -> Vec<&Brush> {
        match self {
            Self::Leaf(brush) => vec![brush],
            Self::Node(_, operands) => operands.iter().flat_map(Self::leaves).collect(),
        }
    }

    /// The value for values of the leaves, from the definition.
    pub(crate) fn value(&self, leaves: &mut impl Iterator<Item = bool>) -> bool {
        let Self::Node(operation, operands) = self else { return leaves.next().expect("a value for each leaf") };
        let values: Vec<bool> = operands.iter().map(|operand| operand.value(leaves)).collect();
        let any = |values: &[bool]| values.contains(&true);
        match operation {
            Operation::Union => any(&values),
            Operation::Intersection => !values.contains(&false),
            Operation::Difference => values.first() == Some(&true) && !any(&values[1..]),
            Operation::Xor => values.iter().filter(|value| **value).count() % 2 == 1,
            Operation::Complement => !any(&values),
        }
    }

    fn print(&self, out: &mut String, indent: usize) {
        let space = "    ".repeat(indent);
        match self {
            Self::Leaf(brush) => {
                writeln!(out, "{space}leaf(&[").expect("writing to a string");
                for face in &brush.faces {
                    let (n, d) = (face.half_space.normal().to_array(), face.half_space.offset());
                    writeln!(out, "{space}    ({n:?}, {d:?}),").expect("writing to a string");
                }
                writeln!(out, "{space}]),").expect("writing to a string");
            }
            Self::Node(operation, operands) => {
                writeln!(out, "{space}node({operation:?}, vec![").expect("writing to a string");
                operands.iter().for_each(|operand| operand.print(out, indent + 1));
                writeln!(out, "{space}]),").expect("writing to a string");
            }
        }
    }
}

impl Scene for Shape {
    fn model(&self) -> Model {
        let base = model(self.leaves().into_iter().cloned().collect());
        Model { materials: base.materials, tree: self.tree() }
    }

    fn smaller(&self) -> Vec<Self> {
        match self {
            Self::Leaf(brush) => (0..brush.faces.len())
                .map(|k| {
                    let mut smaller = brush.clone();
                    smaller.faces.remove(k);
                    Self::Leaf(smaller)
                })
                .collect(),
            Self::Node(operation, operands) => {
                let replace = |k: usize, with: Vec<Self>| {
                    let (before, after) = (&operands[..k], &operands[k + 1..]);
                    Self::Node(*operation, [before, &with, after].concat())
                };
                let itself = operands.iter().cloned();
                let without = (0..operands.len()).map(|k| replace(k, vec![]));
                let inner = operands.iter().enumerate();
                let inner = inner.flat_map(|(k, operand)| operand.smaller().into_iter().map(move |s| (k, s)));
                let inner: Vec<Self> = inner.map(|(k, smaller)| replace(k, vec![smaller])).collect();
                itself.chain(without).chain(inner).collect()
            }
        }
    }

    fn as_rust(&self) -> String {
        let mut out = String::from("let shape =\n");
        self.print(&mut out, 1);
        out
    }
}

/// For regressions: a leaf from plain numbers.
#[allow(dead_code, reason = "what failures print")]
pub(crate) fn leaf(planes: &[([f64; 3], f64)]) -> Shape {
    Shape::Leaf(brush(planes.iter().map(|(n, d)| half_space(DVec3::from_array(*n), *d))))
}

/// For regressions: an operation.
#[allow(dead_code, reason = "what failures print")]
pub(crate) fn node(operation: Operation, operands: Vec<Shape>) -> Shape {
    Shape::Node(operation, operands)
}

/// Bodies to draw from: of one kind, so that faces coincide, or mixed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    Lattice,
    Turned,
    Mixed,
}

/// A body; unbounded ones now and then.
pub(crate) fn random_leaf(rng: &mut Rng, kind: Kind) -> Brush {
    let lattice = match kind {
        Kind::Lattice => true,
        Kind::Turned => false,
        Kind::Mixed => rng.chance(0.5),
    };
    let at = rng.point(-2.0, 2.0);
    match (rng.integer(0, 7), lattice) {
        (0, true) => {
            let normal = DVec3::from_array([0; 3].map(|_| rng.whole(-1, 1)));
            let normal = if normal == DVec3::ZERO { DVec3::Z } else { normal };
            brush([half_space(normal, rng.whole(-2, 2))])
        }
        (1..=4, true) => {
            let low = DVec3::from_array([0; 3].map(|_| rng.whole(-3, 2)));
            let size = DVec3::from_array([0; 3].map(|_| rng.whole(1, 3)));
            cuboid(low, low + size)
        }
        (_, true) => sloped_brush(rng),
        (0, false) => {
            let normal = rng.unit();
            brush([half_space(normal, normal.dot(at))])
        }
        (1..=4, false) => {
            let half = rng.point(0.4, 1.6);
            turned_box(rng, at, half)
        }
        (_, false) => {
            let (radius, planes) = (rng.float(0.5, 1.5), 6 + rng.below(20));
            ball(rng, at, radius, planes)
        }
    }
}

/// A tree of about `leaves` leaves.
pub(crate) fn random_shape(rng: &mut Rng, kind: Kind, leaves: usize) -> Shape {
    if leaves <= 1 {
        return Shape::Leaf(random_leaf(rng, kind));
    }
    let operation = OPERATIONS[[0, 0, 1, 2, 2, 3, 4][rng.below(7)]];
    if operation == Operation::Complement {
        return Shape::Node(operation, vec![random_shape(rng, kind, leaves)]);
    }
    let mut left = leaves;
    let mut operands = Vec::new();
    let wanted = 2 + rng.below(4);
    while left > 0 && operands.len() < wanted {
        let take = if operands.len() + 1 == wanted { left } else { 1 + rng.below(left) };
        operands.push(random_shape(rng, kind, take.min(leaves - 1)));
        left -= take.min(left);
    }
    Shape::Node(operation, operands)
}

/// The part of a shape inside a box, so that it is bounded.
pub(crate) fn bounded(shape: Shape, rng: &mut Rng) -> Shape {
    let half = DVec3::new(2.0, 3.0, 4.0) + rng.whole(0, 1);
    Shape::Node(Operation::Intersection, vec![shape, Shape::Leaf(cuboid(-half, half))])
}

fn judge(shape: &Shape) -> Result<(), String> {
    let evaluation = evaluate_soundly_with(&shape.model(), UnboundedBrushes::Keep)?;
    check_volume(shape, &evaluation)?;
    check_membership(shape, &evaluation, 60)
}

#[test]
fn small_trees_match_their_oracles() {
    for (kind, count) in [(Kind::Lattice, 600), (Kind::Turned, 400), (Kind::Mixed, 300)] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(6);
            let shape = random_shape(rng, kind, leaves);
            bounded(shape, rng)
        };
        sweep(count, generate, judge);
    }
}

#[test]
fn large_trees_match_the_membership_of_points() {
    for (kind, count) in [(Kind::Lattice, 60), (Kind::Turned, 40), (Kind::Mixed, 40)] {
        let generate = |rng: &mut Rng| {
            let leaves = 10 + rng.below(50);
            let shape = random_shape(rng, kind, leaves);
            bounded(shape, rng)
        };
        sweep(count, generate, |shape| {
            let evaluation = evaluate_soundly_with(&shape.model(), UnboundedBrushes::Keep)?;
            check_membership(shape, &evaluation, 200)
        });
    }
}

#[test]
fn meshes_of_trees_do_not_cross_themselves() {
    for kind in [Kind::Lattice, Kind::Mixed] {
        let generate = |rng: &mut Rng| {
            let leaves = 3 + rng.below(12);
            let shape = random_shape(rng, kind, leaves);
            bounded(shape, rng)
        };
        sweep(120, generate, |shape| {
            let mesh = evaluate_soundly_with(&shape.model(), UnboundedBrushes::Keep)?.mesh;
            let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions::default());
            report
                .first_problem()
                .filter(|_| !mesh.triangles.is_empty())
                .map_or(Ok(()), |problem| Err(problem.to_string()))
        });
    }
}
