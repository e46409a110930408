//! Solids as convex cells.

use planecut_cells::{Cell, Solid};
use planecut_csg::{ConvexPiece, MaterialId, Model, Tree};
use planecut_kernel::{HalfSpace, IncrementalPolytope};
use planecut_parallel::job::check;
use planecut_parallel::prelude::*;
use planecut_shapes::polyhedron::convex_tree;

use super::ExpressionError;

/// The body of half-spaces with its corners and triangles; of its planes those that carry a face.
///
/// # Errors
/// [`ExpressionError::Unbounded`].
pub fn piece_of_planes(planes: impl Iterator<Item = HalfSpace>) -> Result<ConvexPiece, ExpressionError> {
    let mut body = IncrementalPolytope::with_epsilon(0.0);
    planes.for_each(|plane| _ = body.add_plane(plane));
    if !body.is_bounded() {
        return Err(ExpressionError::Unbounded);
    }
    let (positions, polygons) = body.to_mesh();
    let fan = |polygon: &Vec<usize>| {
        let corner = |k: usize| polygon[k] as u32;
        (2..polygon.len()).map(|k| [corner(0), corner(k - 1), corner(k)]).collect::<Vec<_>>()
    };
    let half_spaces = body.facets().iter().filter_map(|(plane, _)| body.plane(*plane).copied()).collect();
    let volume = body.measures().map_or(0.0, |measures| measures.volume);
    Ok(ConvexPiece { half_spaces, positions, triangles: polygons.iter().flat_map(fan).collect(), volume })
}

/// The disjoint convex cells of a model, each with the number of its material.
///
/// # Errors
/// [`ExpressionError::Unbounded`], and [`ExpressionError::Convex`] for a closed mesh of too many cells.
pub fn cells_of(model: &Model) -> Result<Vec<(ConvexPiece, MaterialId)>, ExpressionError> {
    let tree = convex_tree(&model.tree)?;
    let solid = Solid::from_tree(&tree);
    if !solid.is_bounded() {
        return Err(ExpressionError::Unbounded);
    }
    let cells: Vec<&Cell> = solid.cells().collect();
    let piece = |cell: &&Cell| {
        check();
        let brush = solid.brush_of(cell);
        let material = brush.faces.first().map_or(MaterialId(0), |face| face.material);
        Ok((piece_of_planes(brush.half_spaces().copied())?, material))
    };
    cells.par_iter().map(piece).collect()
}

/// The connected parts of a model, each the union of disjoint cells.
///
/// # Errors
/// [`ExpressionError::Convex`] for a closed mesh of too many cells.
pub fn components_of(model: &Model) -> Result<Vec<Model>, ExpressionError> {
    let tree = convex_tree(&model.tree)?;
    let solid = Solid::from_tree(&tree);
    let part = |part: Solid| {
        let brushes = part.cells().map(|cell| part.brush_of(cell)).collect();
        Model { materials: model.materials.clone(), tree: Tree::union_of(brushes) }
    };
    Ok(solid.connected_components().into_iter().map(part).collect())
}
