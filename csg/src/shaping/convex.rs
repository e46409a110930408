//! Trees taken apart into convex bodies.

use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};

use crate::brush::{Brush, Material, MaterialId, Model};
use crate::evaluate::{EvaluateError, Evaluation, evaluate};
use crate::primitives::ShapeError;
use crate::solid::{Cell, Solid};
use crate::tree::{Operation, Tree, TreeNode};

/// Vertices nearer to each other than this part of a body's size are one: where many planes were meant to meet.
const MERGED: f64 = 1.0 / (1u64 << 36) as f64;

/// A bounded convex body with interior.
pub(super) struct Convex {
    pub(super) polytope: IncrementalPolytope,
    pub(super) corners: Vec<DVec3>,
}

impl Convex {
    /// The body of half-spaces; `None` where it has no interior.
    pub(super) fn new(half_spaces: &[HalfSpace]) -> Result<Option<Self>, ShapeError> {
        let exact = build(half_spaces, 0.0);
        if exact.is_empty() {
            return Ok(None);
        }
        let bounds = exact.bounding_box().filter(|_| exact.is_bounded()).ok_or(ShapeError::Unbounded)?;
        let polytope = build(half_spaces, (bounds.max - bounds.min).max_element() * MERGED);
        let corners = polytope.vertices().filter_map(|(_, vertex)| vertex.to_euclidean()).collect();
        Ok(Some(Self { polytope, corners }))
    }

    pub(super) fn of_brush(brush: &Brush) -> Result<Option<Self>, ShapeError> {
        Self::new(&brush.faces.iter().map(|face| face.half_space).collect::<Vec<_>>())
    }

    /// The half-spaces that have a face.
    pub(super) fn half_spaces(&self) -> impl Iterator<Item = HalfSpace> + '_ {
        let faces = self.polytope.facets().into_iter();
        faces.filter_map(|(plane, _)| self.polytope.plane(plane).copied())
    }
}

pub(super) fn build(half_spaces: &[HalfSpace], epsilon: f64) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::with_epsilon(epsilon);
    for half_space in half_spaces {
        polytope.add_plane(*half_space);
    }
    polytope
}

/// Whether a tree is the union of its brushes.
pub(super) fn is_union(tree: &Tree) -> bool {
    tree.nodes().iter().all(|node| match node {
        TreeNode::Leaf => true,
        TreeNode::Operation { operation: Operation::Union, .. } => true,
        TreeNode::Operation { operation: Operation::Complement, .. } => false,
        TreeNode::Operation { operands, .. } => *operands == 1,
    })
}

/// The brushes of a union that have an interior.
pub(super) fn parts_of_union(tree: &Tree) -> Result<Vec<(&Brush, Convex)>, ShapeError> {
    let parts = tree.brushes().iter().map(|brush| Ok(Convex::of_brush(brush)?.map(|convex| (brush, convex))));
    parts.filter_map(Result::transpose).collect()
}

/// The mesh of a tree, whatever its materials.
pub(super) fn evaluated(tree: &Tree) -> Result<Evaluation, ShapeError> {
    let tree = tree.clone().with_material(MaterialId(0));
    evaluate(&Model { materials: vec![Material::named("any")], tree }).map_err(|error| match error {
        EvaluateError::Unbounded => ShapeError::Unbounded,
        other => ShapeError::Evaluate(other),
    })
}

/// Disjoint convex cells of a tree.
pub(super) fn cells(tree: &Tree) -> Result<Vec<Convex>, ShapeError> {
    let solid = Solid::from_tree(tree);
    let half_spaces = |cell: &Cell| cell.polytope().planes().map(|(_, half_space)| *half_space).collect::<Vec<_>>();
    let cells = solid.cells().map(|cell| Convex::new(&half_spaces(cell)));
    cells.filter_map(Result::transpose).collect()
}
