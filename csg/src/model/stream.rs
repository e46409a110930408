//! Trees that go from where they are read to where they are used piece by piece, and never are in memory as a whole.

use std::cmp::Reverse;
use std::convert::Infallible;
use std::num::NonZeroU32;

use super::tree::known_lines;
use super::{Brush, Operation, Tree, TreeNode};
use crate::ids::number32;

/// Takes a tree piece by piece: an operation begins, its operands follow, it ends. The whole is one leaf or one operation.
pub trait TreeSink {
    /// Why a piece is not taken.
    type Error;

    /// What follows up to its [`end`](Self::end) are the operands of an operation.
    ///
    /// # Errors
    /// Where it is not taken.
    fn begin(&mut self, operation: Operation) -> Result<(), Self::Error>;

    /// A leaf, and the line of the input on which it begins, where there is one.
    ///
    /// # Errors
    /// Where it is not taken.
    fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), Self::Error>;

    /// The operation that began last and has not ended is complete.
    ///
    /// # Errors
    /// Where it is not taken.
    fn end(&mut self) -> Result<(), Self::Error>;
}

/// Puts a tree together again from its pieces.
///
/// ```
/// use planecut_csg::{Brush, MaterialId, Tree, TreeBuilder};
/// use planecut_kernel::DVec3;
///
/// let block = |at: f64| Tree::from(Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 2.0), MaterialId(0)));
/// let tree = block(0.0) - (block(1.0) | block(2.0));
/// let mut builder = TreeBuilder::default();
/// tree.clone().send(&mut builder).unwrap();
/// assert_eq!(builder.finish(), tree);
/// ```
#[derive(Debug, Default)]
pub struct TreeBuilder {
    brushes: Vec<Brush>,
    lines: Vec<Option<NonZeroU32>>,
    nodes: Vec<TreeNode>,
    /// The operations that have not ended, each with how many operands it has.
    open: Vec<(Operation, usize)>,
}

impl TreeBuilder {
    /// The tree; nothing where there was no piece.
    #[must_use]
    pub fn finish(self) -> Tree {
        if self.nodes.is_empty() {
            return Tree::empty();
        }
        Tree { brushes: self.brushes, nodes: self.nodes, lines: known_lines(self.lines) }
    }

    fn count_operand(&mut self) {
        if let Some((_, operands)) = self.open.last_mut() {
            *operands += 1;
        }
    }
}

impl TreeSink for TreeBuilder {
    type Error = Infallible;

    fn begin(&mut self, operation: Operation) -> Result<(), Self::Error> {
        self.count_operand();
        self.open.push((operation, 0));
        Ok(())
    }

    fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), Self::Error> {
        self.count_operand();
        self.brushes.push(brush);
        self.lines.push(line);
        self.nodes.push(TreeNode::Leaf);
        Ok(())
    }

    fn end(&mut self) -> Result<(), Self::Error> {
        if let Some((operation, operands)) = self.open.pop() {
            self.nodes.push(TreeNode::Operation { operation, operands: number32(operands) });
        }
        Ok(())
    }
}

/// One step of the way through a tree, as a [`TreeSink`] is told of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TreePiece {
    Begin(Operation),
    /// The next leaf.
    Leaf,
    End,
}

impl Tree {
    /// Hands the tree to a sink piece by piece.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn send<S: TreeSink>(mut self, sink: &mut S) -> Result<(), S::Error> {
        let mut brushes = std::mem::take(&mut self.brushes).into_iter();
        let mut lines = std::mem::take(&mut self.lines).into_iter();
        self.try_pieces(|piece| match piece {
            TreePiece::Begin(operation) => sink.begin(operation),
            TreePiece::Leaf => sink.leaf(brushes.next().expect("a brush for each leaf"), lines.next().flatten()),
            TreePiece::End => sink.end(),
        })
    }

    /// Goes through the tree.
    pub(crate) fn pieces(&self, mut take: impl FnMut(TreePiece)) {
        let Ok(()) = self.try_pieces(|piece| {
            take(piece);
            Ok::<(), Infallible>(())
        });
    }

    fn try_pieces<E>(&self, mut take: impl FnMut(TreePiece) -> Result<(), E>) -> Result<(), E> {
        let mut begins = self.begins().into_iter().peekable();
        for (place, node) in self.nodes.iter().enumerate() {
            while let Some((_, _, operation)) = begins.next_if(|(start, ..)| *start == place) {
                take(TreePiece::Begin(operation))?;
            }
            take(if *node == TreeNode::Leaf { TreePiece::Leaf } else { TreePiece::End })?;
        }
        Ok(())
    }

    /// The operations by the entries at which their operands begin, outer ones first: place of the first entry, own place, operation.
    fn begins(&self) -> Vec<(usize, Reverse<usize>, Operation)> {
        let (mut begins, mut starts) = (Vec::new(), Vec::new());
        for (place, node) in self.nodes.iter().enumerate() {
            let start = match node {
                TreeNode::Leaf => place,
                TreeNode::Operation { operation, operands } => {
                    let taken = starts.split_off(starts.len() - *operands as usize);
                    let start = taken.first().copied().unwrap_or(place);
                    begins.push((start, Reverse(place), *operation));
                    start
                }
            };
            starts.push(start);
        }
        begins.sort_unstable_by_key(|(start, place, _)| (*start, *place));
        begins
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::random_trees::{Random, random_tree};

    #[test]
    fn a_tree_that_is_sent_comes_out_as_it_was() {
        for seed in 0..300 {
            let nodes = random_tree(&mut Random(0x9E37_79B9 + seed));
            let leaves = nodes.iter().filter(|node| **node == TreeNode::Leaf).count();
            let lines = (1..=number32(leaves)).map(NonZeroU32::new).collect();
            let tree = Tree::of_parts(vec![Brush::default(); leaves], nodes).with_source_lines(lines);
            let mut builder = TreeBuilder::default();
            tree.clone().send(&mut builder).expect("taken");
            assert_eq!(builder.finish(), tree, "seed {seed}");
        }
    }
}
