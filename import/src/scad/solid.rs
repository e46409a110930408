//! Solids from solids.

use planecut_cells::Solid;
use planecut_csg::{Material, MaterialId, Model, Operation, Transform, Tree, evaluate};
use planecut_kernel::{DVec2, DVec3};
use planecut_shapes::outline::Outline;
use planecut_shapes::polyhedron::convex_tree;
use planecut_shapes::{ShapeError, shaping};

use super::arguments::Arguments;
use super::problem::{Body, Geometry, Made, Problem};
use super::syntax::Node;
use super::turn::Combination;
use super::value::Value;

/// The combination of operands, in their order. Where one is not there, an intersection is empty, and so is a difference from
/// it; sums pass over it.
pub(super) fn combine(
    how: Combination,
    mut operands: Vec<Option<Body>>,
    material: MaterialId,
) -> Result<Body, Problem> {
    if operands.len() == 1 && how != Combination::Hull {
        return Ok(operands.pop().flatten().unwrap_or_default());
    }
    let flattened: Vec<DVec3> = operands.iter().flatten().flat_map(|body| body.flattened.iter().copied()).collect();
    let is_there = |body: &Option<Body>| body.as_ref().is_some_and(|body| !body.is_empty());
    match how {
        Combination::Intersection if !operands.iter().all(is_there) => return Ok(Body::default()),
        Combination::Difference if !operands.first().is_some_and(is_there) => return Ok(Body::default()),
        _ => operands.retain(is_there),
    }
    if operands.len() == 1 && how == Combination::Union {
        return Ok(operands.pop().flatten().unwrap_or_default());
    }
    let operands = operands.into_iter().flatten().map(|body| body.tree);
    let tree = match how {
        Combination::Union => Tree::combine(Operation::Union, operands),
        Combination::Difference => Tree::combine(Operation::Difference, operands),
        Combination::Intersection => Tree::combine(Operation::Intersection, operands),
        Combination::Hull => shaping::hull_with_points(&operands.collect::<Vec<_>>(), &flattened, material)?,
        Combination::Minkowski => minkowski(operands, material)?,
    };
    Ok(tree.into())
}

/// The sum of all operands that are not empty.
fn minkowski(mut operands: impl Iterator<Item = Tree>, material: MaterialId) -> Result<Tree, ShapeError> {
    let first = operands.next().unwrap_or_default();
    operands.try_fold(first, |so_far, operand| {
        let sum = shaping::minkowski(&so_far, &operand, material)?;
        if !sum.brushes().is_empty() {
            return Ok(sum);
        }
        let is_empty = |tree: &Tree| Solid::from_tree(tree).cells().next().is_none();
        Ok(if is_empty(&operand) { so_far } else { operand })
    })
}

/// Solids with convex cells in place of closed meshes.
pub(super) fn of_cells(children: Vec<Option<Geometry>>) -> Result<Vec<Option<Geometry>>, Problem> {
    let of_cells = |child| match child {
        Some(Geometry::Solid(body)) => {
            let tree = convex_tree(&body.tree).map_err(ShapeError::from)?.into_owned();
            Ok(Some(Geometry::Solid(Body { tree, ..body })))
        }
        child => Ok(child),
    };
    children.into_iter().map(of_cells).collect()
}

/// The corners of a body.
pub(super) fn corners(body: &Body) -> Result<Vec<DVec3>, Problem> {
    let tree = body.tree.clone().with_material(MaterialId(0));
    let model = Model { materials: vec![Material::default()], tree };
    Ok(evaluate(&model).map_err(ShapeError::from)?.mesh.positions)
}

pub(super) fn moved(body: Body, map: &Transform) -> Result<Body, Problem> {
    if *map == Transform::identity() {
        return Ok(body);
    }
    let tree = body.tree.transformed(map).map_err(|error| Problem::new(error.to_string(), "less extreme numbers"))?;
    Ok(Body { tree, ..body })
}

/// The shadow on the x–y plane, or with `cut` where the solid meets that plane.
pub(super) fn projection(node: &Node<'_>, tree: &Tree) -> Made {
    if tree.brushes().is_empty() {
        return Ok(None);
    }
    let arguments = Arguments::of(node, &["cut"]);
    let outline = if arguments.is_set("cut") { section(tree)? } else { shaping::project(tree)? };
    Ok(Some(Geometry::Flat(outline)))
}

/// The closed solid's part in the x–y plane: what there is just below it, and what there is just above.
fn section(tree: &Tree) -> Result<Outline, Problem> {
    let below = shaping::slice(tree, 0.0)?;
    let mirror = Transform::scale(DVec3::new(1.0, 1.0, -1.0)).map_err(ShapeError::from)?;
    let above = shaping::slice(&moved(tree.clone().into(), &mirror)?.tree, 0.0)?;
    Ok(Outline::combine(Operation::Union, &[below, above])?)
}

/// What was made, stretched to `newsize`; a size of 0 leaves an axis alone, unless `auto` says that it follows the largest.
pub(super) fn resized(node: &Node<'_>, made: Option<Geometry>) -> Made {
    let arguments = Arguments::of(node, &["newsize", "auto"]);
    let wanted = arguments.size::<3>("newsize");
    let wanted = if arguments.get("newsize").is_some() { wanted } else { [0.0; 3] };
    let follows: [bool; 3] = match arguments.get("auto") {
        Some(Value::Vector(items)) => std::array::from_fn(|axis| items.get(axis).is_some_and(Value::is_true)),
        Some(value) => [value.is_true(); 3],
        None => [false; 3],
    };
    match made {
        Some(Geometry::Flat(outline)) if !outline.is_empty() => {
            let (min, max) = extent(outline.loops().flatten().map(|p| p.extend(0.0)));
            let factors = factors(max - min, wanted, follows).truncate();
            Ok(Some(Geometry::Flat(outline.transformed(glam::DMat2::from_diagonal(factors), DVec2::ZERO)?)))
        }
        Some(Geometry::Solid(body)) if !body.is_empty() => {
            let (min, max) = extent(corners(&body)?.into_iter());
            let map = Transform::scale(factors(max - min, wanted, follows)).map_err(ShapeError::from)?;
            moved(body, &map).map(|body| Some(Geometry::Solid(body)))
        }
        other => Ok(other),
    }
}

fn extent(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    let nowhere = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points.fold(nowhere, |(min, max), point| (min.min(point), max.max(point)))
}

/// By how much each axis is stretched.
fn factors(size: DVec3, wanted: [f64; 3], follows: [bool; 3]) -> DVec3 {
    let stretched = |axis: usize| wanted[axis] > 0.0 && size[axis] > 0.0;
    let factor = |axis: usize| if stretched(axis) { wanted[axis] / size[axis] } else { 1.0 };
    // the first of those that are equal
    let largest = (0..3).rev().max_by(|a, b| wanted[*a].total_cmp(&wanted[*b])).unwrap_or(0);
    DVec3::from_array(std::array::from_fn(|axis| {
        if follows[axis] && wanted[axis] <= 0.0 { factor(largest) } else { factor(axis) }
    }))
}
