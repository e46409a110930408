//! Leaves that say again what is said elsewhere, so that the tree says the same without them.
//!
//! Scripts often make a part twice at the same place; all its faces would lie in each other. Where an operand of a union holds a point,
//! it does not matter what the other operands hold; and elsewhere this operand is 0. So an operand `X` counts as 0 wherever it
//! comes again below the same union, in other operands however deep: `X ∪ f(X) = X ∪ f(∅)`. In the same way what is taken away
//! counts as 0 wherever it comes below the same difference: `f(X) − X = f(∅) − X`.
//!
//! All that is found can be left out at once. At a point where no operand of the unions around a union holds, what these have
//! made 0 was 0 there; and of the operands that hold of the union itself, one of the fewest leaves has nothing within it that
//! equals another one that holds. So it still holds.
//!
//! Which of coplanar faces gives the boundary its material does not depend on what is left out (`docs/weld.md`, "Coplanar faces: who owns the boundary").

use std::cmp::Reverse;

use rustc_hash::FxHashMap;
use smallvec::{SmallVec, smallvec};

use super::Expression;
use crate::ids::{Id, LeafId, TreeNodeId, number32};
use crate::model::Operation;

/// What is said of each node, or of each operand of a union: near an edit there are few.
type List<T> = SmallVec<[T; 32]>;

impl Expression {
    /// For each leaf whether the tree says the same where it is 0; `kinds` gives one number to equal leaves: that of one of them.
    pub(crate) fn repeated_leaves(&self, kinds: &[LeafId]) -> Vec<bool> {
        let mut repeated = vec![false; kinds.len()];
        let mut sorted: List<LeafId> = kinds.into();
        sorted.sort_unstable();
        if sorted.windows(2).all(|pair| pair[0] != pair[1]) {
            return repeated;
        }
        let ((numbers, end), unions) = (self.numbers(kinds), self.unions());
        let has_leaves = |k: usize| self.nodes[k].first_leaf < self.nodes[k].end_leaf;
        // operands of unions within unions are compared instead of these
        let is_operand = |k: usize| {
            unions[k] != TreeNodeId::NONE && self.nodes[k].operation != Some(Operation::Union) && has_leaves(k)
        };
        // of each union the numbers of its operands, of equal ones the last one first: that counts
        let operand = |k: usize| (unions[k], numbers[k], Reverse(k));
        let mut operands: List<(TreeNodeId, u32, Reverse<usize>)> =
            (0..self.nodes.len()).filter(|k| is_operand(*k)).map(operand).collect();
        operands.sort_unstable();
        let mut is_again: List<bool> = smallvec![false; self.nodes.len()];
        operands.dedup_by(|(union, number, Reverse(k)), first| {
            is_again[*k] = (*union, *number) == (first.0, first.1);
            is_again[*k]
        });
        let operands_of = |union: TreeNodeId| {
            let start = operands.partition_point(|operand| operand.0 < union);
            operands[start..].iter().take_while(move |operand| operand.0 == union).map(|operand| operand.1 as usize)
        };
        // from the root down: how many of the unions around a node have an operand of each number
        let mut around: List<u32> = smallvec![0; end];
        let mut open: List<TreeNodeId> = List::new();
        let nodes = TreeNodeId::all(self.nodes.len()).zip(&self.nodes);
        for (number, node) in nodes.rev().filter(|(number, _)| has_leaves(number.index())) {
            while let Some(union) = open.last().copied()
                && self.nodes[union.index()].first_leaf >= node.end_leaf
            {
                open.pop();
                operands_of(union).for_each(|number| around[number] -= 1);
            }
            let k = number.index();
            let others = around[numbers[k] as usize] - u32::from(is_operand(k));
            // without its leaves it must come to nothing
            if (is_again[k] || others > 0) && !node.base {
                repeated[node.first_leaf.index()..node.end_leaf.index()].fill(true);
            }
            let mut of_union = operands_of(number).peekable();
            if of_union.peek().is_some() {
                of_union.for_each(|number| around[number] += 1);
                open.push(number);
            }
        }
        repeated
    }

    /// For each node the one in which it is an operand of a union, that of unions within unions being the outermost.
    fn unions(&self) -> List<TreeNodeId> {
        let mut unions: List<TreeNodeId> = smallvec![TreeNodeId::NONE; self.nodes.len()];
        for k in (0..self.nodes.len()).rev() {
            let parent = self.parents[k];
            let Some(above) = self.nodes.get(parent.index()) else { continue };
            unions[k] = match above.operation {
                Some(Operation::Union) if unions[parent.index()] != TreeNodeId::NONE => unions[parent.index()],
                Some(Operation::Union | Operation::Complement) => parent,
                Some(Operation::Difference) if above.negates(self.nodes[k].first_leaf) => parent,
                _ => TreeNodeId::NONE,
            };
        }
        unions
    }

    /// Numbers that are equal for nodes of the same operations on equal leaves, and one above all of them.
    fn numbers(&self, kinds: &[LeafId]) -> (List<u32>, usize) {
        let (mut numbers, mut open): (List<u32>, List<u32>) = (List::new(), List::new());
        let end_of_leaves = kinds.iter().map(|kind| kind.index() + 1).max().unwrap_or(0);
        let mut known: FxHashMap<(Operation, SmallVec<[u32; 4]>), u32> = FxHashMap::default();
        for node in &self.nodes {
            let number = match node.operation {
                None => kinds[node.first_leaf.index()].number(),
                Some(operation) => {
                    let start = open.len() - node.operands as usize;
                    let operands = &mut open[start..];
                    let first = usize::from(operation == Operation::Difference).min(operands.len());
                    operands[first..].sort_unstable();
                    let next = number32(end_of_leaves + known.len());
                    let number = *known.entry((operation, (&*operands).into())).or_insert(next);
                    open.truncate(start);
                    number
                }
            };
            numbers.push(number);
            open.push(number);
        }
        (numbers, end_of_leaves + known.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::random_trees::{Random, random_tree, value};
    use crate::model::TreeNode;

    #[test]
    fn trees_say_the_same_without_repeated_leaves() {
        const KINDS: u64 = 4;
        let mut found = 0;
        for seed in 1..4000_u64 {
            let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            let entries = random_tree(&mut random);
            let count = entries.iter().filter(|entry| **entry == TreeNode::Leaf).count();
            let kinds: Vec<LeafId> = (0..count).map(|_| LeafId::from_index(random.below(KINDS) as usize)).collect();
            let repeated = Expression::new(&entries).repeated_leaves(&kinds);
            found += repeated.iter().filter(|repeated| **repeated).count();
            for values in 0..1 << KINDS {
                let all: Vec<bool> = kinds.iter().map(|kind| values >> kind.index() & 1 == 1).collect();
                let fewer: Vec<bool> = all.iter().zip(&repeated).map(|(value, repeated)| *value && !repeated).collect();
                let message = || format!("seed {seed}: {entries:?} {kinds:?} without {repeated:?} at {values:b}");
                assert_eq!(value(&entries, &all), value(&entries, &fewer), "{}", message());
            }
        }
        assert!(found > 1000, "only {found} leaves of these trees are repeated");
    }

    #[test]
    fn operands_are_compared_as_a_whole() {
        use Operation::{Difference, Intersection, Union};
        let operation = |operation, operands| TreeNode::Operation { operation, operands };
        // (b ∪ c) − (a ∪ b), where b is taken away
        let either = [TreeNode::Leaf, TreeNode::Leaf, operation(Union, 2)];
        let entries = [&either[..], &either, &[operation(Difference, 2)]].concat();
        assert_eq!(
            Expression::new(&entries).repeated_leaves(&[1, 2, 0, 1].map(LeafId::from_index)),
            [true, false, false, false]
        );
        // (a − b − c) ∪ ((a − c − b) ∪ (a ∩ b)) ∪ (a − b)
        let less_two = [TreeNode::Leaf, TreeNode::Leaf, TreeNode::Leaf, operation(Difference, 3)];
        let both = [TreeNode::Leaf, TreeNode::Leaf, operation(Intersection, 2)];
        let less_one = [TreeNode::Leaf, TreeNode::Leaf, operation(Difference, 2)];
        let inner = [&less_two[..], &both, &[operation(Union, 2)]].concat();
        let entries = [&less_two[..], &inner, &less_one, &[operation(Union, 3)]].concat();
        let repeated =
            Expression::new(&entries).repeated_leaves(&[0, 1, 2, 0, 2, 1, 0, 1, 0, 1].map(LeafId::from_index));
        let places: Vec<usize> = (0..repeated.len()).filter(|k| repeated[*k]).collect();
        assert_eq!(places, [0, 1, 2]);
    }
}
