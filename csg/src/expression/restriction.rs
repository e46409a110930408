//! What a few leaves leave of an expression while all others are 0.

use super::{Expression, Node};
use crate::ids::{BranchId, Id, KeptLeafId, LeafId, TreeNodeId};
use crate::model::Operation;

/// One evaluation among several that are kept side by side.
pub(crate) type Channel = usize;

/// How many evaluations are kept side by side.
pub(crate) const CHANNELS: usize = 4;

/// A node of a restriction: a leaf, or a node of the expression where ways of several leaves meet.
#[derive(Debug, Clone, Copy)]
struct Branch {
    /// The node of the expression.
    node: TreeNodeId,
    parent: BranchId,
    /// Whether the operand of the parent that holds this node is the negation of it.
    is_negated: bool,
    /// Whether that operand is the first of a difference.
    is_first: bool,
    /// Whether nothing below can change the root.
    is_mute: bool,
    /// Of the branches right below that are not mute: how many are counted as operands, how many of these are true at base,
    /// and whether there is one in the first operand of a difference.
    below: (u32, u32, bool),
    /// For each value of this node the value of the root, where this alone decides it.
    decides: [Option<bool>; 2],
    /// For each channel: true operands, the first operand of a difference, the value.
    true_operands: [u32; CHANNELS],
    first: [bool; CHANNELS],
    value: [bool; CHANNELS],
}

/// An expression of a few leaves, all others being 0; evaluated step by step as leaves change.
#[derive(Debug, Clone, Default)]
pub(crate) struct Restriction {
    branches: Vec<Branch>,
    /// The branch of each leaf in the order in which they were given.
    leaves: Vec<BranchId>,
    root_negated: bool,
    base: bool,
    order: Vec<TreeNodeId>,
    /// Nodes above the leaves that were looked at last, each above those that follow.
    above: Vec<TreeNodeId>,
    stack: Vec<BranchId>,
}

impl Restriction {
    /// Restricts an expression to `leaves`, ascending and each once; all are 0 in every channel at first.
    pub(crate) fn restrict(&mut self, expression: &Expression, leaves: &[LeafId]) {
        self.base = expression.base();
        self.collect_nodes(expression, leaves);
        self.link(expression, leaves);
        self.silence(expression);
        self.decide(expression);
    }

    /// Whether a leaf, by its place among those given, can change the root at all.
    pub(crate) fn matters(&self, leaf: KeptLeafId) -> bool {
        !self.branches[self.leaves[leaf.index()].index()].is_mute
    }

    /// The value of the root that a value of a leaf alone decides, whatever the other leaves are.
    pub(crate) fn decides(&self, leaf: KeptLeafId, value: bool) -> Option<bool> {
        let branch = &self.branches[self.leaves[leaf.index()].index()];
        if branch.is_mute { None } else { branch.decides[usize::from(value)] }
    }

    /// The value that a leaf of some value forces upon the lowest node above it and another leaf, which then changes nothing.
    pub(crate) fn forces(
        &self,
        expression: &Expression,
        leaf: KeptLeafId,
        value: bool,
        other: KeptLeafId,
    ) -> Option<bool> {
        let other = &expression.nodes[self.branches[self.leaves[other.index()].index()].node.index()];
        let (mut at, mut value) = (&self.branches[self.leaves[leaf.index()].index()], value);
        if at.is_mute {
            return None;
        }
        loop {
            let above = self.branches.get(at.parent.index())?;
            let node = &expression.nodes[above.node.index()];
            value = above.forced_by(node, at, value ^ at.is_negated)?;
            if node.first_leaf <= other.first_leaf && other.end_leaf <= node.end_leaf {
                return Some(value);
            }
            at = above;
        }
    }

    /// Sets a leaf in one channel.
    pub(crate) fn set(&mut self, expression: &Expression, leaf: KeptLeafId, channel: Channel, value: bool) {
        let mut at = self.leaves[leaf.index()];
        let branch = &mut self.branches[at.index()];
        if branch.is_mute || branch.value[channel] == value {
            return;
        }
        branch.value[channel] = value;
        // From here on each step carries a change of value up.
        while let Some(&Branch { parent, is_negated, is_first, value, .. }) = self.branches.get(at.index()) {
            let Some(above) = self.branches.get_mut(parent.index()) else { return };
            let node = &expression.nodes[above.node.index()];
            let operand = value[channel] ^ is_negated;
            let before = above.value[channel];
            if node.operation == Some(Operation::Xor) {
                above.value[channel] = !before;
            } else {
                if is_first {
                    above.first[channel] = operand;
                } else if operand {
                    above.true_operands[channel] += 1;
                } else {
                    above.true_operands[channel] -= 1;
                }
                above.value[channel] = node.value(above.true_operands[channel], above.first[channel]);
            }
            if above.value[channel] == before {
                return;
            }
            at = parent;
        }
    }

    /// The value of the root in a channel.
    pub(crate) fn root(&self, channel: Channel) -> bool {
        match self.branches.first().filter(|top| !top.is_mute) {
            Some(top) => top.value[channel] ^ self.root_negated,
            None => self.base,
        }
    }

    /// The nodes at which ways of leaves meet, and the leaves, each before what is below it.
    ///
    /// From the last leaf to the first: a node above some leaves comes right before the first of them, which is known once a shallower one
    /// is above it and the leaf before.
    fn collect_nodes(&mut self, expression: &Expression, leaves: &[LeafId]) {
        let depth = |node: TreeNodeId| expression.nodes[node.index()].depth;
        self.order.clear();
        self.above.clear();
        for (k, leaf) in leaves.iter().enumerate().rev() {
            self.order.push(expression.leaves[leaf.index()]);
            let before = k.checked_sub(1).map(|before| expression.lowest_above(leaves[before], *leaf));
            while let Some(top) = self.above.last()
                && before.is_none_or(|before| depth(*top) > depth(before))
            {
                self.order.extend(self.above.pop());
            }
            if let Some(before) = before
                && self.above.last() != Some(&before)
            {
                self.above.push(before);
            }
        }
        self.order.reverse();
    }

    /// Makes the branches and finds the parent of each.
    fn link(&mut self, expression: &Expression, leaves: &[LeafId]) {
        let nodes = &expression.nodes;
        self.branches.clear();
        self.leaves.clear();
        self.stack.clear();
        for (number, &node) in BranchId::all(self.order.len()).zip(&self.order) {
            let this = &nodes[node.index()];
            while let Some(top) = self.stack.last()
                && nodes[self.order[top.index()].index()].end_leaf <= this.first_leaf
            {
                self.stack.pop();
            }
            let parent = self.stack.last().copied().unwrap_or(BranchId::NONE);
            let above = self.branches.get(parent.index()).map(|above: &Branch| &nodes[above.node.index()]);
            self.branches.push(Branch::new(node, this, parent, above));
            if this.operation.is_none() {
                debug_assert_eq!(leaves[self.leaves.len()], this.first_leaf);
                self.leaves.push(number);
            }
            self.stack.push(number);
        }
        self.root_negated = self.order.first().is_some_and(|top| nodes[top.index()].is_negated);
    }

    /// Marks what cannot change the root: where the way up is blocked, and where operands that are not below any branch
    /// make a node constant.
    fn silence(&mut self, expression: &Expression) {
        let nodes = &expression.nodes;
        for k in (0..self.branches.len()).rev() {
            let branch = self.branches[k];
            let node = &nodes[branch.node.index()];
            let is_blocked = match self.branches.get(branch.parent.index()) {
                // blocked before it comes to the operand of the parent: what blocks that operand may be a branch itself
                Some(above) => node.blocked_at > nodes[above.node.index()].depth + 2,
                None => node.blocked_at > 0,
            };
            self.branches[k].is_mute = is_blocked || branch.is_fixed(node);
            if !self.branches[k].is_mute
                && let Some(above) = self.branches.get_mut(branch.parent.index())
            {
                if branch.is_first {
                    above.below.2 = true;
                } else {
                    above.below.0 += 1;
                    above.below.1 += u32::from(node.base ^ branch.is_negated);
                }
            }
        }
        for k in 0..self.branches.len() {
            let parent = self.branches[k].parent.index();
            self.branches[k].is_mute |= self.branches.get(parent).is_some_and(|above| above.is_mute);
        }
    }

    /// Finds for each branch the values that decide the root.
    fn decide(&mut self, expression: &Expression) {
        for k in 0..self.branches.len() {
            let branch = self.branches[k];
            let decides = match self.branches.get(branch.parent.index()) {
                None => [self.root_negated, !self.root_negated].map(Some),
                Some(above) => {
                    let node = &expression.nodes[above.node.index()];
                    [false, true].map(|value| {
                        let forced = above.forced_by(node, &branch, value ^ branch.is_negated)?;
                        above.decides[usize::from(forced)]
                    })
                }
            };
            self.branches[k].decides = decides;
        }
    }
}

impl Branch {
    fn new(node: TreeNodeId, this: &Node, parent: BranchId, above: Option<&Node>) -> Self {
        let is_first = above.is_some_and(|above| above.is_in_first(this.first_leaf));
        // Between this node and the operand of `above` that holds it; an exclusive or is told of changes alone.
        let is_negated = above.is_some_and(|above| {
            above.operation != Some(Operation::Xor)
                && (this.is_negated ^ above.is_negated ^ above.negates(this.first_leaf))
        });
        Self {
            node,
            parent,
            is_negated,
            is_first,
            is_mute: false,
            below: (0, 0, false),
            decides: [None; 2],
            true_operands: [this.true_operands; CHANNELS],
            first: [this.first_operand.1; CHANNELS],
            value: [this.base; CHANNELS],
        }
    }

    /// Whether operands without branches make the node constant.
    fn is_fixed(&self, node: &Node) -> bool {
        let (count, true_below, has_first) = self.below;
        let others_true = node.true_operands.saturating_sub(true_below);
        match node.operation {
            None | Some(Operation::Xor) => false,
            Some(Operation::Union | Operation::Complement) => others_true > 0,
            Some(Operation::Intersection) => others_true + count < node.operands,
            Some(Operation::Difference) => others_true > 0 || !(node.first_operand.1 || has_first),
        }
    }

    /// The value of this node that the operand in which `branch` lies forces, where it does.
    fn forced_by(&self, node: &Node, branch: &Self, operand: bool) -> Option<bool> {
        let is_alone = self.below.0 + u32::from(self.below.2) == 1;
        match (node.operation?, operand) {
            (Operation::Union, true) => Some(true),
            (Operation::Complement, true) | (Operation::Intersection, false) => Some(false),
            (Operation::Difference, value) if value != branch.is_first => Some(false),
            // All others are at base, and do not make the node constant.
            (Operation::Union | Operation::Intersection, value) if is_alone => Some(value),
            (Operation::Complement, false) if is_alone => Some(true),
            (Operation::Difference, _) if is_alone => Some(true),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::random_trees::{Random, random_tree, value};
    use crate::model::{TreeNode, holds_outside};

    #[test]
    fn restrictions_follow_random_trees() {
        for seed in 1..3000_u64 {
            let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            let entries = random_tree(&mut random);
            let count = entries.iter().filter(|entry| **entry == TreeNode::Leaf).count();
            let expression = Expression::new(&entries);
            assert_eq!(expression.base(), value(&entries, &vec![false; count]), "seed {seed}");
            assert_eq!(expression.base(), holds_outside(&entries), "seed {seed}");
            let near: Vec<LeafId> = LeafId::all(count).filter(|_| random.below(3) > 0).collect();
            if near.is_empty() {
                continue;
            }
            let mut restriction = Restriction::default();
            restriction.restrict(&expression, &near);
            let mut all = vec![false; count];
            for _ in 0..40 {
                let k = KeptLeafId::from_index(random.below(near.len() as u64) as usize);
                let on = random.below(2) == 1;
                all[near[k.index()].index()] = on;
                restriction.set(&expression, k, 1, on);
                assert_eq!(restriction.root(1), value(&entries, &all), "seed {seed}: {entries:?} {near:?} {all:?}");
                if let Some(root) = restriction.decides(k, on) {
                    assert_eq!(root, value(&entries, &all), "seed {seed}: leaf {k:?} of {near:?} decides {entries:?}");
                }
            }
            assert_eq!(restriction.root(0), expression.base(), "channels are apart");
            for (k, &leaf) in KeptLeafId::all(near.len()).zip(&near) {
                for (j, &other) in KeptLeafId::all(near.len()).zip(&near).filter(|(j, _)| *j != k) {
                    let with = |on: bool, other_on: bool| {
                        let mut all: Vec<bool> = all.clone();
                        (all[leaf.index()], all[other.index()]) = (on, other_on);
                        value(&entries, &all)
                    };
                    let forced = [false, true].map(|on| restriction.forces(&expression, k, on, j));
                    for on in [false, true].into_iter().filter(|on| forced[usize::from(*on)].is_some()) {
                        assert_eq!(
                            with(on, false),
                            with(on, true),
                            "seed {seed}: {other:?} at {leaf:?} {on} in {entries:?}"
                        );
                    }
                    let (on, other_on) = (random.below(2) == 1, random.below(2) == 1);
                    let by_other = restriction.forces(&expression, j, other_on, k);
                    if by_other.is_some() && by_other == forced[usize::from(on)] {
                        let message = || format!("seed {seed}: {leaf:?} {on} as {other:?} {other_on} in {entries:?}");
                        assert_eq!(with(on, !other_on), with(!on, other_on), "{}", message());
                    }
                }
            }
            for (k, leaf) in KeptLeafId::all(near.len()).zip(&near).filter(|(k, _)| !restriction.matters(*k)) {
                let mut other = all.clone();
                other[leaf.index()] ^= true;
                assert_eq!(value(&entries, &all), value(&entries, &other), "seed {seed}: leaf {k:?} of {near:?}");
            }
        }
    }
}
