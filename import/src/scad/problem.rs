//! What cannot be made of a node.

use planecut_csg::Tree;
use planecut_kernel::DVec3;
use planecut_shapes::ShapeError;
use planecut_shapes::outline::Outline;

use super::fragments::TooMany;

/// What cannot be made of a node: what was found and what was expected, the node's name aside.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Problem {
    pub(super) found: String,
    pub(super) expected: String,
}

/// What a node gives; `None` where OpenSCAD has no object at all.
pub(super) type Made = Result<Option<Geometry>, Problem>;

/// A region of the plane or a solid.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Geometry {
    /// A region of the plane.
    Flat(Outline),
    /// A solid.
    Solid(Body),
}

/// A solid.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Body {
    pub(super) tree: Tree,
    /// Whether its surface touches itself in an edge or a corner. OpenSCAD combines no such solid with others.
    pub(super) touches_itself: bool,
    /// The corners of a single body that a matrix has flattened: a hull takes them.
    pub(super) flattened: Vec<DVec3>,
}

impl From<Tree> for Body {
    fn from(tree: Tree) -> Self {
        Self { tree, ..Self::default() }
    }
}

impl Body {
    /// Whether there is surely nothing.
    pub(super) fn is_empty(&self) -> bool {
        self.tree.brushes().is_empty()
    }
}

impl Geometry {
    /// Whether this is a solid that is not surely empty.
    pub(super) fn is_some_solid(&self) -> bool {
        matches!(self, Self::Solid(body) if !body.is_empty())
    }
}

impl From<Tree> for Geometry {
    fn from(tree: Tree) -> Self {
        Self::Solid(tree.into())
    }
}

impl Problem {
    pub(super) fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { found: found.into(), expected: expected.into() }
    }
}

impl From<ShapeError> for Problem {
    fn from(error: ShapeError) -> Self {
        match error {
            ShapeError::Parameter { parameter, found, expected } => {
                Self::new(format!("{found} for `{parameter}`"), expected)
            }
            error => Self::new(format!("a shape that cannot be made ({error})"), "one that can"),
        }
    }
}

impl From<TooMany> for Problem {
    fn from(TooMany(count): TooMany) -> Self {
        let limit = planecut_shapes::primitives::MAX_SEGMENTS;
        Self::new(format!("{count} segments by `$fn`, `$fa` and `$fs`"), format!("at most {limit}"))
    }
}
