//! Few convex cells around a solid, made the way that adds least.
//!
//! A solid of convex bodies is coarsened as it is. Where closed meshes are part of it, few cells come from its boundary, without its exact convex cells, of which there may be millions; where
//! these are few, they are coarsened as well, and what adds less is taken.

use planecut_cells::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Coarsener, Side, Surface};
use planecut_csg::{MaterialId, Mesh, Tree};
use planecut_kernel::DVec3;
use planecut_shapes::polyhedron::{ConvexTreeError, convex_tree};
use thiserror::Error;

/// Meshes of no more triangles are also tried by their exact cells, where these are no more than [`FEW_CELLS`].
const FEW_TRIANGLES: usize = 1500;
/// Exact cells that are coarsened in less time than the boundary.
const FEW_CELLS: usize = 64;

/// Volumes relative to that of the solid that differ by no more are the same.
const SAME_EXCESS: f64 = 1e-6;

/// Why a solid was not enclosed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EncloseError {
    /// As [`CoarsenError`].
    #[error(transparent)]
    Coarsen(#[from] CoarsenError),
    /// A mesh of the solid falls into too many convex cells where these are needed.
    #[error(transparent)]
    Cells(#[from] ConvexTreeError),
}

/// Coarsens the solid of a tree. `boundary` is its mesh; `points` are points that the cells must hold exactly although rounding may have left them outside. With the cells comes what the
/// boundary bounds, where they were made of it.
///
/// # Errors
/// [`EncloseError`].
///
/// ```
/// use planecut::cells::coarsen::CoarsenOptions;
/// use planecut::csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
/// use planecut::enclosing::enclosed;
/// use planecut::kernel::DVec3;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
/// let model = Model { materials: vec![Material::named("oak")], tree: block(0.0, 2.0) - block(1.0, 2.0) };
/// let boundary = evaluate(&model)?.mesh;
/// let options = CoarsenOptions { max_cells: Some(1), ..CoarsenOptions::default() };
/// let (cells, _) = enclosed(&model.tree, &boundary, &[], &options)?;
/// assert!((cells.volume_out - (8.0 - 1.0 / 6.0)).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn enclosed(
    tree: &Tree,
    boundary: &Mesh,
    points: &[DVec3],
    options: &CoarsenOptions,
) -> Result<(Coarsened, Option<Bounded>), EncloseError> {
    let is_coarse = options.max_cells.is_some() || options.max_excess.is_some();
    let of_cells = |tree: &Tree, points: &[DVec3]| Coarsener::new(tree, points, options)?.coarsened();
    if !tree.has_meshes() || !is_coarse || options.side != Side::Outer {
        return Ok((of_cells(&*convex_tree(tree)?, points)?, None));
    }
    let of_boundary = enclosed_surface(boundary, Bounded::Solid, options)?;
    // the planes of a mesh hold its vertices but for their rounding
    let points = || points.iter().chain(&boundary.positions).copied().collect::<Vec<DVec3>>();
    // pieces of a surface exceed it a little: what they cannot reach, exact cells may
    if options.max_excess.is_some_and(|most| of_boundary.excess() > most) {
        return Ok((of_cells(&*convex_tree(tree)?, &points())?, None));
    }
    if boundary.triangles.len() <= FEW_TRIANGLES
        // there is an answer already: it stands where exact cells cannot be had
        && let Ok(exact) = convex_tree(tree)
        && exact.brushes().len() <= FEW_CELLS
        && let Ok(of_cells) = of_cells(&exact, &points())
        && is_better(&of_cells, &of_boundary, options)
    {
        return Ok((of_cells, None));
    }
    Ok((of_boundary, Some(Bounded::Solid)))
}

/// Whether cells are better than others by more than rounding: fewer where as few as can be found are wanted, else such that add less, or overlap less.
fn is_better(one: &Coarsened, other: &Coarsened, options: &CoarsenOptions) -> bool {
    if options.max_cells.is_none() && one.cells.len() != other.cells.len() {
        return one.cells.len() < other.cells.len();
    }
    let differs = |a: f64, b: f64| (a - b).abs() > SAME_EXCESS;
    if differs(one.excess(), other.excess()) {
        one.excess() < other.excess()
    } else {
        differs(one.sum_excess(), other.sum_excess()) && one.sum_excess() < other.sum_excess()
    }
}

/// What triangles bound that bound no solid: with `fills` all that they go around by more than half, where there is any, else shells of some thickness, [`Bounded::default_thickness`]
/// where none is given.
#[must_use]
pub fn bounded_by(positions: &[DVec3], triangles: &[[u32; 3]], fills: bool, thickness: Option<f64>) -> Bounded {
    let filled = Surface { positions, triangles, materials: &[], bounded: Bounded::Filled };
    if fills && filled.volume() > 0.0 {
        return Bounded::Filled;
    }
    Bounded::Shell { thickness: thickness.unwrap_or_else(|| Bounded::default_thickness(positions, triangles)) }
}

/// Coarsens what a mesh bounds, by its triangles alone.
///
/// # Errors
/// As [`Coarsener::of_surface`].
pub fn enclosed_surface(mesh: &Mesh, bounded: Bounded, options: &CoarsenOptions) -> Result<Coarsened, CoarsenError> {
    let materials: Vec<MaterialId> =
        mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material).collect();
    let surface = Surface { positions: &mesh.positions, triangles: &mesh.triangles, materials: &materials, bounded };
    Coarsener::of_surface(&surface, None, options)?.coarsened()
}
