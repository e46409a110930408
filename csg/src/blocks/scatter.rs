//! What of a tree each block gets, while the tree goes by piece by piece.
//!
//! A block is told of the brushes that reach into it and of the operations above these, in postfix order. Of operands that
//! have no brush in the block it is enough to know how many there are and what they are where all brushes are nothing: nothing, or (as complements are) everything.

use rustc_hash::FxHashMap;

use super::grid::BlockPlace;
use crate::model::Operation;

/// One entry of what a block is told; the operands of an operation come before it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BlockNode<B> {
    /// A brush, however it is written.
    Leaf(B),
    /// An operation on what came last.
    Operation(BlockOperation),
}

/// An operation as a block sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BlockOperation {
    /// What to do.
    pub operation: Operation,
    /// Number of operands with brushes in the block: they came before.
    pub here: u32,
    /// What the first of all operands is.
    pub first: FirstOperand,
    /// Number of the other operands that are everything here.
    pub full: u32,
    /// Whether others are nothing here.
    pub has_empty: bool,
}

/// What the first operand of an operation is in a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FirstOperand {
    /// It has brushes there.
    Here,
    /// Nothing.
    Empty,
    /// Everything.
    Full,
}

/// Follows a tree that goes by, and says what each block is told of it.
#[derive(Debug, Default)]
pub struct TreeScatter {
    open: Vec<Frame>,
    /// What the whole is where all brushes are nothing, once it is known.
    base: bool,
}

/// An operation that has begun.
#[derive(Debug)]
struct Frame {
    operation: Operation,
    operands: u64,
    /// Operands that are everything where all brushes are nothing.
    full: u64,
    first_is_full: bool,
    here: FxHashMap<BlockPlace, Here>,
}

/// The operands of an operation that have brushes in a block.
#[derive(Debug, Clone, Copy, Default)]
struct Here {
    operands: u32,
    /// Those that are everything where all brushes are nothing.
    full: u32,
    has_first: bool,
}

impl TreeScatter {
    /// An operation begins.
    pub fn begin(&mut self, operation: Operation) {
        let here = FxHashMap::default();
        self.open.push(Frame { operation, operands: 0, full: 0, first_is_full: false, here });
    }

    /// A brush that reaches into some blocks: each of them is told of it.
    pub fn leaf(&mut self, blocks: impl IntoIterator<Item = BlockPlace>) {
        self.operand(false, blocks);
    }

    /// An operation ends; gives what blocks are told of it.
    pub fn end(&mut self) -> impl Iterator<Item = (BlockPlace, BlockOperation)> + use<> {
        let frame = self.open.pop();
        let told: Vec<(BlockPlace, BlockOperation)> = frame.map_or_else(Vec::new, |frame| {
            let told = frame.here.iter().map(|(place, here)| (*place, frame.told(here))).collect();
            self.operand(frame.is_full(), frame.here.into_keys());
            told
        });
        told.into_iter()
    }

    /// Whether the solid holds what no brush holds: then it is not bounded. Known once the tree has gone by.
    #[must_use]
    pub fn holds_outside(&self) -> bool {
        self.base
    }

    fn operand(&mut self, is_full: bool, blocks: impl IntoIterator<Item = BlockPlace>) {
        let Some(above) = self.open.last_mut() else {
            self.base = is_full;
            // the caller may do something for each
            return blocks.into_iter().for_each(drop);
        };
        let is_first = above.operands == 0;
        above.operands += 1;
        above.full += u64::from(is_full);
        above.first_is_full |= is_first && is_full;
        for block in blocks {
            let here = above.here.entry(block).or_default();
            here.operands += 1;
            here.full += u32::from(is_full);
            here.has_first |= is_first;
        }
    }
}

impl Frame {
    /// What it is where all brushes are nothing.
    fn is_full(&self) -> bool {
        match self.operation {
            Operation::Union => self.full > 0,
            Operation::Intersection => self.full == self.operands,
            Operation::Difference => self.first_is_full && self.full == 1,
            Operation::Xor => self.full % 2 == 1,
            Operation::Complement => self.full == 0,
        }
    }

    fn told(&self, here: &Here) -> BlockOperation {
        let first = match (here.has_first, self.first_is_full) {
            (true, _) => FirstOperand::Here,
            (false, true) => FirstOperand::Full,
            (false, false) => FirstOperand::Empty,
        };
        let others = self.operands - u64::from(here.operands) - u64::from(first != FirstOperand::Here);
        let full = self.full - u64::from(here.full) - u64::from(first == FirstOperand::Full);
        BlockOperation {
            operation: self.operation,
            here: here.operands,
            first,
            full: u32::try_from(full).unwrap_or(u32::MAX),
            has_empty: others > full,
        }
    }
}
