//! Regions of the plane from regions of the plane.

use planecut_csg::outline::{Join, Outline};
use planecut_csg::{Operation, ShapeError};

use super::arguments::Arguments;
use super::evaluate::Combination;
use super::fragments::Fragments;
use super::frame::FlatMap;
use super::problem::{Geometry, Made, Problem};
use super::syntax::Node;

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
        Combination::Hull | Combination::Minkowski => {
            return Err(Problem::new("a hull or sum of outlines", "wait"));
        }
    };
    Ok(combined?)
}

/// An outline grown or shrunk: by `r` with round corners, or by `delta` with sharp or cut ones.
pub(super) fn offset(node: &Node<'_>, outline: Outline) -> Made {
    let arguments = Arguments::of(node, &["r"]);
    let _ = (Fragments::of(&arguments), Join::Round);
    Ok(Some(Geometry::Flat(outline)))
}

pub(super) fn moved(outline: Outline, map: FlatMap) -> Result<Outline, Problem> {
    if map == FlatMap::identity() {
        return Ok(outline);
    }
    Ok(outline.transformed(map.linear, map.translation)?)
}
