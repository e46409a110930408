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

use crate::ids::number32;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;

use super::Expression;
use crate::ids::{Id, LeafId, TreeNodeId};
use crate::model::Operation;

/// Numbers of operands: mostly there are few.
type Numbers = SmallVec<[u32; 4]>;

impl Expression {
    /// For each leaf whether the tree says the same where it is 0; `kinds` gives one number to equal leaves: that of one of them.
    pub(crate) fn repeated_leaves(&self, kinds: &[LeafId]) -> Vec<bool> {
        let mut repeated = vec![false; kinds.len()];
        let mut sorted: SmallVec<[LeafId; 32]> = kinds.into();
        sorted.sort_unstable();
        if sorted.windows(2).all(|pair| pair[0] != pair[1]) {
            return repeated;
        }
        let (numbers, unions) = (self.numbers(kinds), self.unions());
        let has_leaves = |k: usize| self.nodes[k].first_leaf < self.nodes[k].end_leaf;
        // operands of unions within unions are compared instead of these
        let is_operand = |k: usize| {
            unions[k] != TreeNodeId::NONE && self.nodes[k].operation != Some(Operation::Union) && has_leaves(k)
        };
        let mut operands: Vec<Numbers> = vec![Numbers::new(); self.nodes.len()];
        let mut said: FxHashSet<(TreeNodeId, u32)> = FxHashSet::default();
        let mut is_again = vec![false; self.nodes.len()];
        // of equal operands of one union the last counts
        for k in (0..self.nodes.len()).rev().filter(|k| is_operand(*k)) {
            is_again[k] = !said.insert((unions[k], numbers[k]));
            if !is_again[k] {
                operands[unions[k].index()].push(numbers[k]);
            }
        }
        // from the root down: how many of the unions around a node have an operand of each number
        let mut around: FxHashMap<u32, u32> = FxHashMap::default();
        let mut open: Vec<usize> = Vec::new();
        for (k, node) in self.nodes.iter().enumerate().rev().filter(|(k, _)| has_leaves(*k)) {
            while let Some(union) = open.pop_if(|union| self.nodes[*union].first_leaf >= node.end_leaf) {
                for number in &operands[union] {
                    around.entry(*number).and_modify(|count| *count -= 1);
                }
            }
            // a number that no union around has is there no time
            let others = around.get(&numbers[k]).copied().unwrap_or(0) - u32::from(is_operand(k));
            // without its leaves it must come to nothing
            if (is_again[k] || others > 0) && !node.base {
                repeated[node.first_leaf.index()..node.end_leaf.index()].fill(true);
            }
            if !operands[k].is_empty() {
                operands[k].iter().for_each(|number| *around.entry(*number).or_insert(0) += 1);
                open.push(k);
            }
        }
        repeated
    }

    /// For each node the one in which it is an operand of a union, that of unions within unions being the outermost.
    fn unions(&self) -> Vec<TreeNodeId> {
        let mut unions = vec![TreeNodeId::NONE; self.nodes.len()];
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

    /// Numbers that are equal for nodes of the same operations on equal leaves.
    fn numbers(&self, kinds: &[LeafId]) -> Vec<u32> {
        let mut operands: Vec<Numbers> = vec![Numbers::new(); self.nodes.len()];
        let mut numbers: Vec<u32> = Vec::with_capacity(self.nodes.len());
        let mut known: FxHashMap<(Option<Operation>, Numbers), u32> = FxHashMap::default();
        for (k, node) in self.nodes.iter().enumerate() {
            let mut key = std::mem::take(&mut operands[k]);
            match node.operation {
                None => key.push(kinds[node.first_leaf.index()].number()),
                Some(Operation::Difference) => key[1.min(node.operands as usize)..].sort_unstable(),
                Some(_) => key.sort_unstable(),
            }
            let next = number32(known.len());
            let number = *known.entry((node.operation, key)).or_insert(next);
            numbers.push(number);
            if let Some(above) = operands.get_mut(self.parents[k].index()) {
                above.push(number);
            }
        }
        numbers
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
