//! Winding numbers beside an edge of the input, by one ray.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::states::Windings;
use crate::arrangement::around::{Around, HalfPlane};
use crate::arrangement::exact::compare_vertices;
use crate::arrangement::input::Input;
use crate::arrangement::predicates::{Corner, RoundedPlane, Triangle, sign, turn};
use crate::base::Bounds;
use crate::ids::number32;

/// The winding numbers of operands at the first of two vertices, moved by `δ` towards the second and by `(ε, ε², ε³)`: both are as small
/// as need be, `ε` far smaller than `δ`. What touches in the vertex alone is told apart by that.
pub(super) fn beside(input: &Input<'_>, from: [Corner; 2]) -> Windings {
    let all = (0..input.operands.len()).map(|operand| (number32(operand), winding_beside(input, operand, from)));
    all.filter(|(_, winding)| *winding != 0).collect()
}

/// The winding number of one operand there.
pub(in crate::arrangement) fn winding_beside(input: &Input<'_>, operand: usize, from: [Corner; 2]) -> i32 {
    let at = from[0].at;
    // corners of bodies may be a little away
    let (low, high) = (at.to_array().map(f64::next_down), at.to_array().map(f64::next_up));
    let passes = |bounds: &Bounds| {
        bounds.max.x >= low[0]
            && bounds.min.y <= high[1]
            && bounds.max.y >= low[1]
            && bounds.min.z <= high[2]
            && bounds.max.z >= low[2]
    };
    let mut winding = 0;
    let tree = input.operands[operand].tree();
    tree.for_each(passes, |triangle| winding += crossing(input, &input.triangle(operand, triangle), &from));
    winding
}

/// Whether a side of a triangle of an operand is beside the direction in which [`winding_beside`] moves from its first corner towards its second one,
/// with nothing else of the triangle and its neighbour between: the side from which it is counter-clockwise, or else the other one.
pub(in crate::arrangement) fn is_above_beside(input: &Input<'_>, operand: usize, triangle: u32) -> bool {
    let twin = input.operands[operand].twins()[3 * triangle as usize];
    let triangle = input.triangle(operand, triangle);
    let (axis, order) = axis_between(input, &triangle.corners[0], &triangle.corners[1]);
    let half_plane = |triangle: Triangle, is_forward: bool| HalfPlane { triangle, plane: None, is_forward };
    let members = [(half_plane(triangle, true), true), (half_plane(input.triangle(operand, twin / 3), false), false)];
    let around = Around::new(input, axis, order);
    !members[around.after_direction(&members)].1
}

/// How a ray along x crosses a triangle, from the first of two vertices, moved towards the second and by `(ε, ε², ε³)`: 1 from below,
/// −1 from above, 0 not at all.
fn crossing(input: &Input<'_>, triangle: &Triangle, start: &[Corner; 2]) -> i32 {
    let first = |signs: [Sign; 2]| signs.into_iter().find(|sign| *sign != Sign::Zero);
    let turn = |from: Corner, to: Corner| {
        first(start.map(|point| turn(input, [from, to, point], 0))).unwrap_or_else(|| {
            // which way the edge runs, along y and then along z
            let along = [1, 2].map(|axis| order_along(input, &from, &to, axis));
            if along[1] == Sign::Zero { along[0] } else { along[1].flip() }
        })
    };
    let corners = triangle.corners;
    let facing = turn(corners[0], corners[1]);
    if facing == Sign::Zero || turn(corners[1], corners[2]) != facing || turn(corners[2], corners[0]) != facing {
        return 0;
    }
    let plane = RoundedPlane::new(input, triangle);
    // one whose plane the whole edge lies in is left behind
    let is_ahead = first(start.map(|point| plane.side(input, &point))) == Some(facing.flip());
    match (is_ahead, facing) {
        (false, _) => 0,
        (true, Sign::Positive) => 1,
        (true, _) => -1,
    }
}

/// An axis along which two vertices differ, and their order along it.
fn axis_between(input: &Input<'_>, from: &Corner, to: &Corner) -> (usize, Ordering) {
    let longest = (to.at - from.at).abs().max_position();
    let order = |axis: usize| match order_along(input, from, to, axis) {
        Sign::Positive => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Negative => Ordering::Greater,
    };
    let axes = [longest, (longest + 1) % 3, (longest + 2) % 3];
    axes.map(|axis| (axis, order(axis)))
        .into_iter()
        .find(|(_, order)| order.is_ne())
        .unwrap_or((longest, Ordering::Equal))
}

/// The sign of the difference of two vertices along an axis.
fn order_along(input: &Input<'_>, from: &Corner, to: &Corner, axis: usize) -> Sign {
    let difference = sign(to.at[axis] - from.at[axis]);
    let is_there = |corner: &Corner| input.is_where_it_is_said(corner.vertex);
    if difference != Sign::Zero || is_there(from) && is_there(to) {
        return difference;
    }
    compare_vertices(input, to.vertex, from.vertex, axis)
}
