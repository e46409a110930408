//! The tree of a block from what it was told.

use std::num::NonZeroU32;

use super::scatter::{BlockOperation, FirstOperand};
use crate::expression::Polarity;
use crate::ids::number32;
use crate::model::{Brush, Operation, Tree, TreeNode};

/// Puts the tree of a block together, leaving out what is nothing there. The brushes keep their source lines.
#[derive(Debug, Default)]
pub(super) struct BlockTree {
    brushes: Vec<Brush>,
    lines: Vec<Option<NonZeroU32>>,
    polarities: Vec<Polarity>,
    nodes: Vec<TreeNode>,
    /// The results that no operation has taken yet: where the brushes and the nodes of each begin; nothing for one that is
    /// nothing.
    results: Vec<Option<(usize, usize)>>,
}

impl BlockTree {
    /// Adds a brush.
    pub(super) fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>, polarity: Polarity) {
        self.results.push(Some(self.place()));
        self.brushes.push(brush);
        self.lines.push(line);
        self.polarities.push(polarity);
        self.nodes.push(TreeNode::Leaf);
    }

    /// Adds an operation on the results that came last; `None` where there are fewer.
    pub(super) fn operation(&mut self, told: &BlockOperation) -> Option<()> {
        let first = self.results.len().checked_sub(told.here as usize)?;
        let mut operands = self.results.split_off(first);
        match told.first {
            FirstOperand::Here => {}
            FirstOperand::Empty => operands.insert(0, None),
            FirstOperand::Full => {
                // before the others: which operand is the first counts
                let begin = operands.iter().flatten().next().copied().unwrap_or_else(|| self.place());
                self.nodes.insert(begin.1, EVERYTHING);
                operands.iter_mut().flatten().for_each(|(_, nodes)| *nodes += 1);
                operands.insert(0, Some(begin));
            }
        }
        operands.extend(told.has_empty.then_some(None));
        for _ in 0..told.full {
            operands.push(Some(self.place()));
            self.nodes.push(EVERYTHING);
        }
        self.combine(told.operation, &operands);
        Some(())
    }

    /// The tree, nothing where nothing is left, and the polarity of each brush.
    pub(super) fn finish(mut self) -> (Tree, Vec<Polarity>) {
        match self.results.pop().flatten() {
            Some(_) => (Tree::of_parts(self.brushes, self.nodes).with_source_lines(self.lines), self.polarities),
            None => (Tree::empty(), Vec::new()),
        }
    }

    fn place(&self) -> (usize, usize) {
        (self.brushes.len(), self.nodes.len())
    }

    fn combine(&mut self, operation: Operation, operands: &[Option<(usize, usize)>]) {
        let left = operands.iter().flatten().count();
        let begin = operands.iter().flatten().next().copied().unwrap_or_else(|| self.place());
        let is_nothing = match operation {
            Operation::Union | Operation::Xor => left == 0,
            Operation::Intersection => left < operands.len(),
            Operation::Difference => operands.first().is_none_or(Option::is_none),
            Operation::Complement => false,
        };
        if is_nothing {
            self.brushes.truncate(begin.0);
            self.lines.truncate(begin.0);
            self.polarities.truncate(begin.0);
            self.nodes.truncate(begin.1);
            self.results.push(None);
            return;
        }
        // an operation on one operand is that operand
        if left != 1 || operation == Operation::Complement {
            self.nodes.push(TreeNode::Operation { operation, operands: number32(left) });
        }
        self.results.push(Some(begin));
    }
}

/// All of space: what lies in no operand, of which there is none.
const EVERYTHING: TreeNode = TreeNode::Operation { operation: Operation::Complement, operands: 0 };

#[cfg(test)]
mod tests {
    use super::super::scatter::{BlockNode, TreeScatter};
    use super::*;
    use crate::expression::Expression;
    use crate::expression::random_trees::{Random, random_tree, value};
    use crate::model::TreeSink;
    use std::convert::Infallible;

    /// What one block is told, where some leaves reach into it.
    struct OneBlock<'a> {
        members: &'a [bool],
        leaf: usize,
        scatter: TreeScatter,
        told: Vec<BlockNode<(Brush, Option<NonZeroU32>)>>,
    }

    impl TreeSink for OneBlock<'_> {
        type Error = Infallible;

        fn begin(&mut self, operation: Operation) -> Result<(), Infallible> {
            self.scatter.begin(operation);
            Ok(())
        }

        fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), Infallible> {
            let is_member = self.members[self.leaf];
            self.leaf += 1;
            self.scatter.leaf(is_member.then_some([0; 3]));
            self.told.extend(is_member.then_some(BlockNode::Leaf((brush, line))));
            Ok(())
        }

        fn end(&mut self) -> Result<(), Infallible> {
            self.told.extend(self.scatter.end().map(|(_, told)| BlockNode::Operation(told)));
            Ok(())
        }
    }

    #[test]
    fn a_block_is_told_the_tree_where_all_other_brushes_are_nothing() {
        let random = &mut Random(77);
        let mut compared = 0;
        for _ in 0..4000 {
            let nodes = random_tree(random);
            let leaves = nodes.iter().filter(|node| **node == TreeNode::Leaf).count();
            let members: Vec<bool> = (0..leaves).map(|_| random.below(2) == 0).collect();
            // a brush tells by its source line which one it was
            let lines = (1..=number32(leaves)).map(NonZeroU32::new).collect();
            let all = Tree::of_parts(vec![Brush::default(); leaves], nodes.clone()).with_source_lines(lines);
            let mut block = OneBlock { members: &members, leaf: 0, scatter: TreeScatter::default(), told: Vec::new() };
            let Ok(()) = all.send(&mut block);
            let base = value(&nodes, &vec![false; leaves]);
            assert_eq!(block.scatter.holds_outside(), base, "{nodes:?}");
            if !members.contains(&true) {
                assert!(block.told.is_empty());
                continue;
            }
            let mut tree = BlockTree::default();
            for told in block.told {
                match told {
                    BlockNode::Leaf((brush, line)) => tree.leaf(brush, line, Polarity::Adds),
                    BlockNode::Operation(told) => tree.operation(&told).expect("operands"),
                }
            }
            let (tree, _) = tree.finish();
            assert_eq!(Expression::new(tree.nodes()).base(), base);
            for _ in 0..20 {
                let values: Vec<bool> = members.iter().map(|is_member| *is_member && random.below(2) == 0).collect();
                let of_block: Vec<bool> =
                    tree.source_lines().map(|line| values[line.unwrap().get() as usize - 1]).collect();
                assert_eq!(value(tree.nodes(), &of_block), value(&nodes, &values), "{nodes:?} {members:?}");
                compared += 1;
            }
        }
        assert!(compared > 10_000);
    }
}
