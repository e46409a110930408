//! Which points a solid holds.

use planecut_cells::Solid as CellSolid;
use planecut_cells::coarsen::Winding;
use planecut_csg::stages::{Bounds, Boxes};
use planecut_csg::{Brush, Operation, TreeNode};
use planecut_kernel::{DVec3, IncrementalPolytope, Location};
use planecut_parallel::job::check;
use planecut_parallel::prelude::*;

use super::{ExpressionError, Node};

/// For each point whether the closed solid holds it: of convex bodies exactly, of closed meshes by the boundary as it is returned.
///
/// # Errors
/// [`ExpressionError`].
pub fn contains(node: &Node, points: &[DVec3]) -> Result<Vec<bool>, ExpressionError> {
    if node.has_meshes() {
        let evaluated = node.evaluated()?;
        let mesh = &evaluated.evaluation.mesh;
        let winding = Winding::new(&mesh.positions, &mesh.triangles);
        let holds = |point: &DVec3| {
            check();
            winding.around(*point) > 0
        };
        return Ok(points.par_iter().with_min_len(256).map(holds).collect());
    }
    let tree = node.model()?.tree;
    let bodies: Vec<IncrementalPolytope> = tree.brushes().par_iter().map(body_of).collect();
    let boxes = Boxes::new(bodies.par_iter().map(bounds_of).collect());
    let place = |near: &mut Vec<u32>, point: &DVec3| {
        check();
        boxes.touching(&Bounds { min: *point, max: *point }, near);
        let of_leaf = |leaf: usize| match near.binary_search(&(leaf as u32)) {
            Ok(_) => bodies[leaf].classify(*point),
            Err(_) => Location::Outside,
        };
        location(tree.nodes(), of_leaf)
    };
    let places: Vec<Location> = points.par_iter().with_min_len(64).map_init(Vec::new, place).collect();
    if places.contains(&Location::On) {
        // where boundaries touch, only the solid itself tells whether the point is left
        let solid = CellSolid::from_tree(&tree);
        let holds = |(place, point): (&Location, &DVec3)| match place {
            Location::Inside => true,
            Location::Outside => false,
            Location::On => solid.contains(*point),
        };
        return Ok(places.par_iter().zip(points).with_min_len(64).map(holds).collect());
    }
    Ok(places.into_iter().map(|place| place == Location::Inside).collect())
}

fn body_of(brush: &Brush) -> IncrementalPolytope {
    let mut body = IncrementalPolytope::with_epsilon(0.0);
    brush.half_spaces().for_each(|half_space| _ = body.add_plane(*half_space));
    body
}

/// A box that surely holds a body.
fn bounds_of(body: &IncrementalPolytope) -> Bounds {
    match body.bounding_box() {
        Some(bounds) => Bounds { min: bounds.min.map(f64::next_down), max: bounds.max.map(f64::next_up) },
        None if body.is_empty() => Bounds::EMPTY,
        None => Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY },
    }
}

/// Where a point lies by where it lies in the operands; on the boundary where these do not say it.
fn location(nodes: &[TreeNode], of_leaf: impl Fn(usize) -> Location) -> Location {
    let mut values: Vec<Location> = Vec::new();
    let mut leaves = 0..;
    for node in nodes {
        let TreeNode::Operation { operation, operands } = node else {
            values.extend(leaves.next().map(&of_leaf));
            continue;
        };
        let operands = values.split_off(values.len() - *operands as usize);
        values.push(match operation {
            Operation::Union => any(&operands, Location::Inside),
            Operation::Intersection => any(&operands, Location::Outside),
            Operation::Complement => turned(any(&operands, Location::Inside)),
            Operation::Difference => match operands.split_first() {
                Some((first, others)) => any(&[*first, turned(any(others, Location::Inside))], Location::Outside),
                None => Location::Outside,
            },
            Operation::Xor if operands.contains(&Location::On) => Location::On,
            Operation::Xor => {
                let count = operands.iter().filter(|place| **place == Location::Inside).count();
                if count % 2 == 1 { Location::Inside } else { Location::Outside }
            }
        });
    }
    values.pop().unwrap_or(Location::Outside)
}

/// A place if any operand has it, else the opposite one if none is on a boundary.
fn any(operands: &[Location], place: Location) -> Location {
    if operands.contains(&place) {
        place
    } else if operands.contains(&Location::On) {
        Location::On
    } else {
        turned(place)
    }
}

fn turned(place: Location) -> Location {
    match place {
        Location::Inside => Location::Outside,
        Location::Outside => Location::Inside,
        Location::On => Location::On,
    }
}
