//! A model in memory, block by block.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use thiserror::Error;

use super::block::{Block, BlockBuilder};
use super::grid::{BlockGrid, BlockPlace, BlockSides};
use super::polarity::{PolarityStack, SharedBrushes, brush_mark};
use super::scatter::{BlockNode, TreeScatter};
use super::seams::{SeamEdge, SeamEdges, uncancelled_edges, unmatched_edges};
use super::snapping::snapped_among;
use super::survey::{BlockSurvey, BrushPlace};
use super::{BlockOptions, UnboundedBrush};
use crate::evaluate::{EvaluateError, check_materials};
use crate::expression::Polarity;
use crate::model::{Brush, Model, Tree, TreePiece};

/// Number of brushes that are built at a time to know where they are.
const AT_A_TIME: usize = 1 << 13;

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
    /// A brush is not bounded, or a closed mesh.
    #[error(transparent)]
    Unbounded(#[from] UnboundedBrush),
    /// As for a model that is evaluated at once.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// A block was not taken.
    #[error("a block was not taken")]
    Taker(E),
}

/// Evaluates a model block by block and hands each to `take`, in an order that depends on the model alone. For a model that is itself
/// larger than memory there are the parts of this: [`BlockSurvey`], [`TreeScatter`],
/// [`BlockBuilder`].
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
    let used = brushes.iter().flat_map(|brush| &brush.faces).map(|face| face.material);
    check_materials(used, model.materials.len())?;
    if model.tree.holds_outside() {
        return Err(EvaluateError::Unbounded.into());
    }
    let mut survey = BlockSurvey::default();
    let mut places: Vec<BrushPlace> = Vec::with_capacity(brushes.len());
    for some in brushes.chunks(AT_A_TIME) {
        places.extend(survey.add(some));
    }
    if let Some(brush) = places.iter().position(|place| place.is_unbounded) {
        return Err(UnboundedBrush { brush: brush as u64, is_mesh: brushes[brush].is_mesh() }.into());
    }
    let snapped = snapped_among(survey.planes(), brushes.iter().flat_map(Brush::half_spaces));
    let brush = |leaf: usize| {
        let mut brush = brushes[leaf].clone();
        brush.faces.iter_mut().for_each(|face| face.half_space = snapped.of_plane(&face.half_space));
        brush
    };
    let polarities = polarities(&model.tree, |leaf| brush_mark(&brush(leaf), &places[leaf].redundant));
    let grid = survey.grid(options);
    let mut seams = WaitingSeams::default();
    let mut summary = BlocksSummary::default();
    for (place, told) in told_blocks(model, &places, &grid) {
        let mut block = BlockBuilder::new(grid.bounds(place), model.materials.len());
        for node in told {
            match node {
                BlockNode::Operation(told) => block.operation(&told).expect("operands that were told"),
                BlockNode::Leaf((leaf, sides)) => {
                    block.leaf(brush(leaf), model.tree.source_line(leaf), sides, polarities[leaf]);
                }
            }
        }
        let block = block.evaluate(model.materials.clone(), survey.size())?;
        summary.blocks += 1;
        summary.volume += block.volume;
        summary.triangles += block.mesh.triangles.len();
        summary.open_edges += seams.meet(place, &block.seams);
        take(block).map_err(BlocksError::Taker)?;
    }
    summary.open_edges += seams.sides.into_values().map(|edges| edges.len()).sum::<usize>();
    summary.open_edges += uncancelled_edges(&seams.crossings);
    Ok(summary)
}

/// For each leaf the polarity of all that equal it; `mark` is what equal ones share.
fn polarities(tree: &Tree, mark: impl Fn(usize) -> u64) -> Vec<Polarity> {
    let mut stack = PolarityStack::default();
    let mut polarities = Vec::with_capacity(tree.brushes().len());
    tree.pieces(|piece| match piece {
        TreePiece::Begin(operation) => stack.begin(operation),
        TreePiece::Leaf => polarities.push(stack.leaf()),
        TreePiece::End => stack.end(),
    });
    if polarities.windows(2).all(|pair| pair[0] == pair[1]) {
        return polarities;
    }
    let marks: Vec<u64> = (0..polarities.len()).map(mark).collect();
    let mut sorted: Vec<(u64, Polarity)> = marks.iter().copied().zip(polarities.iter().copied()).collect();
    sorted.sort_unstable();
    let mut shared = SharedBrushes::default();
    sorted.into_iter().for_each(|(mark, polarity)| shared.push(mark, polarity));
    marks.into_iter().zip(polarities).map(|(mark, own)| shared.polarity(mark, own)).collect()
}

/// A brush by its number, and the sides over which it reaches.
type ToldLeaf = (usize, BlockSides);

/// What each block with a brush is told, in the order of their places.
fn told_blocks(
    model: &Model,
    places: &[BrushPlace],
    grid: &BlockGrid,
) -> BTreeMap<BlockPlace, Vec<BlockNode<ToldLeaf>>> {
    let mut told: BTreeMap<BlockPlace, Vec<BlockNode<ToldLeaf>>> = BTreeMap::new();
    let mut scatter = TreeScatter::default();
    let mut leaf = 0;
    model.tree.pieces(|piece| match piece {
        TreePiece::Begin(operation) => scatter.begin(operation),
        TreePiece::Leaf => {
            let reached = grid.reached(&places[leaf].bounds);
            scatter.leaf(reached.map(|(place, sides)| {
                told.entry(place).or_default().push(BlockNode::Leaf((leaf, sides)));
                place
            }));
            leaf += 1;
        }
        TreePiece::End => {
            scatter.end().for_each(|(place, end)| told.entry(place).or_default().push(BlockNode::Operation(end)));
        }
    });
    told
}

/// The edges on walls of which the other side has not come yet.
#[derive(Default)]
struct WaitingSeams {
    /// By the block of larger coordinates and the axis that its wall is across.
    sides: FxHashMap<(BlockPlace, usize), Vec<SeamEdge>>,
    /// Where walls cross, of all blocks: there are hardly any.
    crossings: Vec<SeamEdge>,
}

impl WaitingSeams {
    /// Compares the edges of a block with those of the blocks before it; gives how many have no like.
    fn meet(&mut self, place: BlockPlace, seams: &SeamEdges) -> usize {
        let mut unmatched = 0;
        self.crossings.extend_from_slice(&seams.crossings);
        for axis in 0..3 {
            let before = self.sides.remove(&(place, axis)).unwrap_or_default();
            unmatched += unmatched_edges(&before, seams.side(axis, false));
            let after = seams.side(axis, true);
            if !after.is_empty() {
                let mut next = place;
                next[axis] += 1;
                self.sides.insert((next, axis), after.to_vec());
            }
        }
        unmatched
    }
}
