//! Large models block by block: space is cut into boxes that are evaluated on their own, so that memory is bounded by the size
//! of a block, not by that of the model.
//!
//! A brush that reaches over a wall between blocks is cut there, on both sides, which adds the wall to its planes. The
//! faces on walls are dropped from the mesh of each block; what is left of both sides ends in the same edges, because walls
//! go through all of the model ([`BlockGrid`]) and a point where planes meet is rounded alike wherever it is worked out. That every such edge finds its like is checked
//! ([`SeamEdges`]).
//!
//! Way of a model through this folder, in which it is never in memory as a whole: [`survey`] looks at each brush once and
//! says where walls go ([`grid`]), which planes may be nearly the same ([`snapping`]) and which brushes both add and take ([`polarity`]); [`scatter`] tells each block what of the tree is
//! there; [`block`] evaluates it. [`in_memory`] does all of this for a model that is in memory.

mod block;
mod contents;
mod grid;
mod in_memory;
mod polarity;
mod scatter;
mod seams;
mod snapping;
mod survey;

use thiserror::Error;

pub use block::{Block, BlockBuilder};
pub use grid::{BlockGrid, BlockPlace, BlockSides};
pub use in_memory::{BlocksError, BlocksSummary, evaluate_in_blocks};
pub use polarity::{PolarityStack, SharedBrushes, brush_mark};
pub use scatter::{BlockNode, BlockOperation, FirstOperand, TreeScatter};
pub use seams::{SeamEdge, SeamEdges, uncancelled_edges, unmatched_edges};
pub use snapping::{NearPlaneFinder, NearRanges, PlaneMark, PlaneSurvey, SnappedPlanes};
pub use survey::{BlockSurvey, BrushPlace};

/// How a model is cut into blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BlockOptions {
    /// A block with the middles of more brushes than this is cut in two, where a wall can part them. In a model of more than a quarter of a
    /// million brushes that is so on average: the middles of some of them are looked at.
    pub brushes: usize,
}

impl Default for BlockOptions {
    /// Blocks of about 8,192 brushes: some hundred megabytes for brushes of few faces.
    fn default() -> Self {
        Self { brushes: 1 << 13 }
    }
}

/// A brush that is not evaluated in blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("found {what}, number {brush}, expected bounded convex bodies", what = if *.is_mesh { "a closed mesh" } else { "a brush that reaches infinity" })]
pub struct UnboundedBrush {
    /// Its number.
    pub brush: u64,
    /// Whether it is a closed mesh, and not an unbounded body.
    pub is_mesh: bool,
}
