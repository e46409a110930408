//! Regions of the plane from regions of the plane.

use planecut_csg::Operation;
use planecut_shapes::ShapeError;
use planecut_shapes::outline::{ClipperJoin, OffsetRule, Outline};

use super::arguments::Arguments;
use super::fragments::Fragments;
use super::frame::FlatMap;
use super::problem::{Geometry, Made, Problem};
use super::syntax::Node;
use super::turn::Combination;

/// The combination of operands, in their order; what is not there counts as empty.
pub(super) fn combine(how: Combination, operands: Vec<Option<Outline>>) -> Result<Outline, Problem> {
    let mut operands: Vec<Outline> = operands.into_iter().map(Option::unwrap_or_default).collect();
    if operands.len() == 1 && how != Combination::Hull {
        return Ok(operands.pop().unwrap_or_default());
    }
    let combined = match how {
        Combination::Union => Outline::combine(Operation::Union, &operands),
        Combination::Difference => Outline::combine(Operation::Difference, &operands),
        Combination::Intersection => Outline::combine(Operation::Intersection, &operands),
        Combination::Hull => Ok(Outline::hull(&operands)),
        Combination::Minkowski => minkowski(&operands),
    };
    Ok(combined?)
}

/// The sum of all operands that are not empty.
fn minkowski(operands: &[Outline]) -> Result<Outline, ShapeError> {
    let mut some = operands.iter().filter(|operand| !operand.is_empty());
    let Some(first) = some.next() else { return Ok(Outline::empty()) };
    some.try_fold(first.clone(), |sum, operand| sum.minkowski(operand))
}

/// An outline grown or shrunk: by `r` with round corners, or by `delta` with sharp ones, which `chamfer` cuts.
pub(super) fn offset(node: &Node<'_>, outline: &Outline) -> Made {
    let arguments = Arguments::of(node, &["r"]);
    let rule = match (arguments.number("r"), arguments.number("delta")) {
        (Some(by), _) => {
            OffsetRule { by, join: ClipperJoin::Round { segments: Fragments::of(&arguments).around(by.abs())? } }
        }
        (None, by) => {
            let join = if arguments.is_set("chamfer") { ClipperJoin::Square } else { ClipperJoin::Miter };
            OffsetRule { by: by.unwrap_or(1.0), join }
        }
    };
    Ok(Some(Geometry::Flat(outline.offset_with(&rule)?)))
}

pub(super) fn moved(outline: Outline, map: FlatMap) -> Result<Outline, Problem> {
    if map == FlatMap::identity() {
        return Ok(outline);
    }
    Ok(outline.transformed(map.linear, map.translation)?)
}
