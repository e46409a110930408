//! Trees taken apart into convex bodies.

use planecut_kernel::{DVec3, Face, HalfSpace, IncrementalPolytope};

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

/// The half-spaces whose faces are wider than rounding.
///
/// Planes through corners that nearly lie on a line, and across edges that are no longer than an ulp, touch the body and have no
/// say in it.
pub(super) fn wide_faces(half_spaces: &[HalfSpace]) -> Result<Vec<HalfSpace>, ShapeError> {
    let Some(body) = Convex::new(half_spaces)? else { return Ok(Vec::new()) };
    let size = |p: &DVec3, q: &DVec3| (*p - *q).abs().max_element();
    let extent = body.corners.iter().map(|p| size(p, &body.corners[0])).fold(0.0, f64::max);
    let (positions, _) = body.polytope.to_mesh();
    let is_wide = |face: &Face| width(face.vertices.iter().map(|v| positions[*v])) > extent * MERGED;
    let faces = body.polytope.faces();
    let wide = faces.iter().filter(|face| is_wide(face)).filter_map(|face| body.polytope.plane(face.plane).copied());
    let wide: Vec<HalfSpace> = wide.collect();
    // a body that is all needles keeps its planes
    Ok(if build(&wide, 0.0).is_bounded() { wide } else { body.half_spaces().collect() })
}

/// The area of a polygon over its diameter, but for a factor near 1.
fn width(corners: impl Iterator<Item = DVec3>) -> f64 {
    let corners: Vec<DVec3> = corners.collect();
    let Some(first) = corners.first() else { return 0.0 };
    let spread = corners.iter().map(|p| p.distance(*first)).fold(0.0, f64::max);
    let area: DVec3 = corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum();
    if spread > 0.0 { area.length() / spread } else { 0.0 }
}

fn build(half_spaces: &[HalfSpace], epsilon: f64) -> IncrementalPolytope {
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
