//! Large models block by block: space is cut into boxes that are evaluated on their own, so that memory is bounded by the size
//! of a block, not by that of the model.
//!
//! A brush that reaches over a wall between blocks is cut there, on both sides, which adds the wall to its planes. The
//! faces on walls are dropped from the mesh of each block; what is left of both sides ends in the same edges, because walls
//! go through all of the model ([`grid`]) and a point where planes meet is rounded alike wherever it is worked out. That every such edge finds its like is checked
//! ([`Seams`]).

mod grid;
mod prune;
mod seams;

use crate::ids::number32;
use glam::DVec3;
use thiserror::Error;

use crate::base::Bounds;
use crate::body::BuiltBodies;
use crate::evaluate::{EvaluateError, UnboundedBrushes, check_materials, evaluate_among};
use crate::mesh::Mesh;
use crate::model::{Brush, Material, MaterialId, Model};
use crate::plane_table::{Snapped, smallest_size};
use grid::{Grid, bounds_of};
use seams::Seams;

/// How a model is cut into blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockOptions {
    /// A block with the middles of more brushes than this is cut in two, where a wall can part them.
    pub brushes: usize,
}

impl Default for BlockOptions {
    /// Blocks of about 16,384 brushes: a few hundred megabytes for brushes of few faces.
    fn default() -> Self {
        Self { brushes: 1 << 14 }
    }
}

/// The boundary of a solid within a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// The corner of the box of smallest coordinates.
    pub min: DVec3,
    /// The corner of largest coordinates.
    pub max: DVec3,
    /// The part of the boundary in the box: closed but for edges on the walls to other blocks, where theirs go on.
    pub mesh: Mesh,
    /// The volume of the solid within the box.
    pub volume: f64,
}

/// What all blocks have together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BlocksSummary {
    /// Blocks with a brush.
    pub blocks: usize,
    /// The volume of the solid.
    pub volume: f64,
    /// Triangles of all blocks.
    pub triangles: usize,
    /// Edges on walls that go on in no other block: 0 where the blocks together are watertight.
    pub open_edges: usize,
}

/// Why a model is not evaluated in blocks.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BlocksError<E> {
    /// A brush is not bounded.
    #[error("found a brush that reaches infinity, number {brush}, expected bounded ones")]
    Unbounded {
        /// Its number.
        brush: usize,
    },
    /// A leaf is a closed mesh.
    #[error("found a closed mesh, number {brush}, expected convex bodies alone")]
    Mesh {
        /// Its number.
        brush: usize,
    },
    /// As for a model that is evaluated at once.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// A block was not taken.
    #[error("a block was not taken")]
    Taker(E),
}

/// Evaluates a model block by block and hands each to `take`, in an order that depends on the model alone.
///
/// ```
/// use planecut_csg::{BlockOptions, Brush, Material, MaterialId, Model, Tree, evaluate_in_blocks};
/// use planecut_kernel::DVec3;
///
/// let cube = |k: u32| Brush::cuboid(DVec3::X * f64::from(k), DVec3::X * f64::from(k) + 1.5, MaterialId(0));
/// let tree = Tree::union_of((0..100).map(cube).collect());
/// let model = Model { materials: vec![Material::named("stone")], tree };
/// let mut triangles = 0;
/// let taken = evaluate_in_blocks(&model, BlockOptions { brushes: 10 }, |block| {
///     triangles += block.mesh.triangles.len();
///     Ok::<(), ()>(())
/// });
/// let all = taken.unwrap();
/// assert!(all.blocks >= 10 && all.triangles == triangles && all.open_edges == 0);
/// assert!((all.volume - 2.25 * 100.5).abs() < 1e-9);
/// ```
///
/// # Errors
/// [`BlocksError`]: brushes must be convex and bounded, and so must be the solid.
pub fn evaluate_in_blocks<E>(
    model: &Model,
    options: BlockOptions,
    mut take: impl FnMut(Block) -> Result<(), E>,
) -> Result<BlocksSummary, BlocksError<E>> {
    let brushes = model.tree.brushes();
    if let Some(brush) = brushes.iter().position(Brush::is_mesh) {
        return Err(BlocksError::Mesh { brush });
    }
    let used = brushes.iter().flat_map(|brush| &brush.faces).map(|face| face.material);
    check_materials(used, model.materials.len())?;
    if model.tree.holds_outside() {
        return Err(EvaluateError::Unbounded.into());
    }
    let bounds = bounds_of(brushes).map_err(|brush| BlocksError::Unbounded { brush })?;
    // once for all blocks, or what is one plane in one of them would be two in another
    let size = smallest_size(brushes.iter().map(Brush::half_spaces));
    let snapped = Snapped::of(brushes.iter().flat_map(Brush::half_spaces), size);
    let wall = MaterialId(number32(model.materials.len()));
    let mut materials = model.materials.clone();
    materials.push(Material::default());
    let mut seams = Seams::default();
    let mut summary = BlocksSummary::default();
    for block in Grid::new(&bounds, options.brushes.max(1)).cells(&bounds) {
        let brush = |member: u32| {
            let mut brush: Brush = brushes[member as usize].clone();
            for face in &mut brush.faces {
                face.half_space = snapped.of_plane(&face.half_space);
            }
            block.add_walls(&mut brush, &bounds[member as usize], wall);
            brush
        };
        let tree = prune::tree_of_some(&model.tree, &block.members, brush);
        let model = Model { materials: materials.clone(), tree };
        let evaluation = evaluate_among(&model, UnboundedBrushes::Keep, &BuiltBodies::default(), size)?;
        let mut mesh = evaluation.mesh;
        seams.part(&mut mesh, wall);
        mesh.materials.clone_from(&model.materials);
        summary.blocks += 1;
        summary.volume += evaluation.solid.volume;
        summary.triangles += mesh.triangles.len();
        let Bounds { min, max } = block.bounds;
        take(Block { min, max, mesh, volume: evaluation.solid.volume }).map_err(BlocksError::Taker)?;
    }
    summary.open_edges = seams.open();
    Ok(summary)
}
