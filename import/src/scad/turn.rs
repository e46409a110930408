//! A node whose turn it is, and where what it makes is put.

use planecut_kernel::MAX_COORDINATE;
use planecut_shapes::Outline;

use super::frame::Frame;
use super::problem::{Body, Geometry, Made};
use super::syntax::Node;
use super::{flat, solid};

/// A node whose turn it is.
#[derive(Clone, Copy)]
pub(super) struct Turn<'s, 'a> {
    pub(super) node: &'s Node<'a>,
    pub(super) frame: Frame,
}

/// How children become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Combination {
    Union,
    Difference,
    Intersection,
    Hull,
    Minkowski,
}

impl Turn<'_, '_> {
    /// Puts what was made in the node's own frame where it belongs.
    pub(super) fn place(&self, made: Option<Geometry>) -> Made {
        match made {
            None => Ok(None),
            Some(Geometry::Flat(outline)) => match self.frame.flat_map() {
                Some(map) => Ok(Some(Geometry::Flat(flat::moved(outline, map)?))),
                None => Ok(Some(Geometry::Flat(Outline::empty()))),
            },
            Some(Geometry::Solid(body)) => match self.frame.solid_map() {
                Some(map) => solid::moved(body, &map).map(|body| Some(Geometry::Solid(body))),
                None => {
                    let corners = solid::corners(&body)?.into_iter().map(|corner| self.frame.flattened(corner));
                    // of a map that is not finite either, there are none
                    let flattened =
                        corners.filter(|p| p.is_finite() && p.abs().max_element() < MAX_COORDINATE).collect();
                    Ok(Some(Geometry::Solid(Body { flattened, ..Body::default() })))
                }
            },
        }
    }
}
