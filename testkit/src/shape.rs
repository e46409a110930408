//! Random trees that can be made smaller and printed, and what must hold of any solid.

use std::fmt::Write;

use glam::DVec3;
use planecut_cells::{Cell, Solid};
use planecut_csg::{Brush, Model, Operation, Tree};
use planecut_kernel::IncrementalPolytope;

use crate::generate::{ball, sloped_brush, turned_box};
use crate::random::Rng;
use crate::scene::{Scene, brush, cuboid, ensure, half_space, model};

/// A tree of a test.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A convex body.
    Leaf(Brush),
    /// An operation on others.
    Node(Operation, Vec<Self>),
}

impl Shape {
    /// As a tree of brushes.
    pub fn tree(&self) -> Tree {
        match self {
            Self::Leaf(brush) => Tree::from(brush.clone()),
            Self::Node(operation, operands) => Tree::combine(*operation, operands.iter().map(Self::tree)),
        }
    }

    /// The solid by operators on the solids of the operands, one after the other.
    pub fn by_operators(&self) -> Solid {
        let Self::Node(operation, operands) = self else { return Solid::from_tree(&self.tree()) };
        let solids = operands.iter().map(Self::by_operators);
        let join = |operator: fn(&mut Solid, &Solid)| {
            move |mut all: Solid, next: Solid| {
                operator(&mut all, &next);
                all
            }
        };
        let either = || join(|all, next| *all |= next);
        match operation {
            Operation::Union => solids.reduce(either()).unwrap_or_default(),
            Operation::Intersection => solids.reduce(join(|all, next| *all &= next)).unwrap_or(Solid::everything()),
            Operation::Difference => solids.reduce(join(|all, next| *all -= next)).unwrap_or_default(),
            Operation::Xor => solids.reduce(join(|all, next| *all ^= next)).unwrap_or_default(),
            Operation::Complement => !&solids.reduce(either()).unwrap_or_default(),
        }
    }

    fn leaves(&self) -> Vec<&Brush> {
        match self {
            Self::Leaf(brush) => vec![brush],
            Self::Node(_, operands) => operands.iter().flat_map(Self::leaves).collect(),
        }
    }

    /// Whether a point belongs to the set, from the definition; `None` where it is too near to a plane to tell.
    pub fn holds(&self, point: DVec3) -> Option<bool> {
        let Self::Node(operation, operands) = self else {
            let Self::Leaf(brush) = self else { return None };
            let distances = brush.faces.iter().map(|face| face.half_space.signed_distance(point));
            let outermost = distances.fold(f64::NEG_INFINITY, f64::max);
            return (outermost.abs() > 1e-7).then_some(outermost < 0.0);
        };
        let values: Vec<bool> = operands.iter().map(|operand| operand.holds(point)).collect::<Option<_>>()?;
        let any = |values: &[bool]| values.contains(&true);
        Some(match operation {
            Operation::Union => any(&values),
            Operation::Intersection => !values.contains(&false),
            Operation::Difference => values.first() == Some(&true) && !any(&values[1..]),
            Operation::Xor => values.iter().filter(|value| **value).count() % 2 == 1,
            Operation::Complement => !any(&values),
        })
    }

    fn print(&self, out: &mut String) {
        match self {
            Self::Leaf(brush) => {
                out.push_str("leaf(&[");
                for face in &brush.faces {
                    let (n, d) = (face.half_space.normal().to_array(), face.half_space.offset());
                    write!(out, "({n:?}, {d:?}), ").expect("writing to a string");
                }
                out.push_str("])");
            }
            Self::Node(operation, operands) => {
                write!(out, "node({operation:?}, vec![").expect("writing to a string");
                for operand in operands {
                    operand.print(out);
                    out.push_str(", ");
                }
                out.push_str("])");
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
        let Self::Node(operation, operands) = self else {
            let Self::Leaf(brush) = self else { return Vec::new() };
            let without = |k: usize| {
                let mut smaller = brush.clone();
                smaller.faces.remove(k);
                Self::Leaf(smaller)
            };
            return (0..brush.faces.len()).map(without).collect();
        };
        let replace =
            |k: usize, with: &[Self]| Self::Node(*operation, [&operands[..k], with, &operands[k + 1..]].concat());
        let without = (0..operands.len()).map(|k| replace(k, &[]));
        let inner =
            (0..operands.len()).flat_map(|k| operands[k].smaller().into_iter().map(move |smaller| (k, smaller)));
        let inner = inner.map(|(k, smaller)| replace(k, &[smaller]));
        operands.iter().cloned().chain(without).chain(inner).collect()
    }

    fn as_rust(&self) -> String {
        let mut out = String::from("let shape = ");
        self.print(&mut out);
        out.push(';');
        out
    }
}

/// For regressions: a leaf from plain numbers.
pub fn leaf(planes: &[([f64; 3], f64)]) -> Shape {
    Shape::Leaf(brush(planes.iter().map(|(n, d)| half_space(DVec3::from_array(*n), *d))))
}

/// For regressions: an operation.
pub fn node(operation: Operation, operands: Vec<Shape>) -> Shape {
    Shape::Node(operation, operands)
}

/// Bodies to draw from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Boxes and half-spaces along the axes, with integer coordinates.
    Boxes,
    /// Bodies with small integer coefficients.
    Sloped,
    /// Turned boxes, spheres and half-spaces.
    Turned,
    /// All of these.
    Mixed,
}

fn integers(rng: &mut Rng, low: i64, high: i64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| rng.whole(low, high)))
}

fn random_leaf(rng: &mut Rng, kind: Kind) -> Brush {
    let at = rng.point(-2.0, 2.0);
    match (kind, rng.below(9)) {
        (Kind::Boxes, 0) => {
            let axis = rng.pick(&DVec3::AXES) * rng.pick(&[1.0, -1.0]);
            brush([half_space(axis, rng.whole(-2, 2))])
        }
        (Kind::Boxes, _) => {
            let low = integers(rng, -4, 2);
            cuboid(low, low + integers(rng, 1, 4))
        }
        (Kind::Sloped, 0) => {
            let normal = integers(rng, -1, 1);
            brush([half_space(if normal == DVec3::ZERO { DVec3::Z } else { normal }, rng.whole(-2, 2))])
        }
        (Kind::Sloped, _) => sloped_brush(rng),
        (Kind::Turned, 0) => {
            let normal = rng.unit();
            brush([half_space(normal, normal.dot(at))])
        }
        (Kind::Turned, 1..=5) => {
            let half = rng.point(0.4, 2.0);
            turned_box(rng, at, half)
        }
        (Kind::Turned, _) => {
            let (radius, planes) = (rng.float(0.5, 2.0), 6 + rng.below(20));
            ball(rng, at, radius, planes)
        }
        (Kind::Mixed, _) => {
            let kind = rng.pick(&[Kind::Boxes, Kind::Sloped, Kind::Turned]);
            random_leaf(rng, kind)
        }
    }
}

/// A tree of about `leaves` leaves.
pub fn random_shape(rng: &mut Rng, kind: Kind, leaves: usize) -> Shape {
    use Operation::{Complement, Difference, Intersection, Union, Xor};
    if leaves <= 1 {
        return Shape::Leaf(random_leaf(rng, kind));
    }
    let operation = rng.pick(&[Union, Union, Union, Intersection, Difference, Difference, Difference, Xor, Complement]);
    if operation == Complement {
        return Shape::Node(operation, vec![random_shape(rng, kind, leaves)]);
    }
    let count = 2 + rng.below(leaves.min(5) - 1);
    let mut sizes = vec![1; count];
    (count..leaves).for_each(|_| sizes[rng.below(count)] += 1);
    Shape::Node(operation, sizes.into_iter().map(|size| random_shape(rng, kind, size)).collect())
}

/// The shape within a box of half size 7.
pub fn bounded(shape: Shape) -> Shape {
    let frame = Shape::Leaf(cuboid(DVec3::splat(-7.0), DVec3::splat(7.0)));
    Shape::Node(Operation::Intersection, vec![shape, frame])
}

/// Whether a body lies within some planes and others, with interior.
fn have_common_interior(a: &Cell, b: &Cell) -> bool {
    let mut common = IncrementalPolytope::with_epsilon(0.0);
    for (_, half_space) in a.polytope().planes().chain(b.polytope().planes()) {
        common.add_plane(*half_space);
    }
    !common.is_empty()
}

/// What must hold of any solid: cells with interior, none of them overlapping, made of the planes they say.
pub fn ensure_sound(solid: &Solid) -> Result<(), String> {
    let cells: Vec<&Cell> = solid.cells().collect();
    for (k, cell) in cells.iter().enumerate() {
        ensure!(cell.polytope().check_invariants().is_ok(), "cell {k} is broken");
        for (handle, half_space) in cell.polytope().planes() {
            let plane = cell.plane(handle).ok_or_else(|| format!("cell {k}: a plane without a number"))?;
            ensure!(solid.table().half_space(plane.plane) == half_space, "cell {k}: another plane");
        }
        for (other, with) in cells[..k].iter().enumerate() {
            ensure!(!have_common_interior(cell, with), "cells {other} and {k} of {} overlap", cells.len());
        }
    }
    Ok(())
}

/// The same membership for random points.
pub fn ensure_membership(shape: &Shape, solid: &Solid, points: usize) -> Result<(), String> {
    let mut rng = Rng::spread(points as u64);
    for _ in 0..points {
        let point = rng.point(-6.0, 6.0);
        let Some(expected) = shape.holds(point) else { continue };
        ensure!(solid.contains(point) == expected, "membership of {point}: expected {expected}");
    }
    Ok(())
}

/// Equal up to rounding, relative to the larger and to `size`.
pub fn ensure_close(what: &str, found: f64, expected: f64, size: f64) -> Result<(), String> {
    let tolerance = 1e-12 * found.abs().max(expected.abs()).max(size);
    ensure!((found - expected).abs() <= tolerance, "{what}: found {found:?}, expected {expected:?}");
    Ok(())
}
