//! Operations written one after another, as the boundary needs them.

use super::{LiveTree, Member, NodeId, OrderKey, Place, Position, TreeOperand};
use crate::expression::Polarity;
use crate::ids::number32;
use crate::live::{BrushId, Role};
use crate::model::{Operation, TreeNode};

/// An operation in the list of a model with all below it.
#[derive(Debug, Clone, Default)]
pub(super) struct Subtree {
    /// In postfix order.
    entries: Vec<TreeNode>,
    pub(super) leaves: Vec<BrushId>,
    /// Whether each leaf adds to what the operation makes.
    polarities: Vec<Polarity>,
}

/// An operation whose operands are being written down.
struct Open {
    node: NodeId,
    operation: Operation,
    /// Whether it adds to what the topmost operation makes.
    polarity: Polarity,
    /// Those still to come, the last one first.
    rest: Vec<TreeOperand>,
    /// What those before are far from all brushes.
    values: Vec<bool>,
}

impl LiveTree {
    /// Writes down an operation in the list of the model again after something below it has changed.
    pub(super) fn flatten(&mut self, top: OrderKey, root: NodeId) {
        let mut subtree = Subtree::default();
        let mut open = vec![self.begin(root, Polarity::Adds)];
        while let Some(last) = open.last_mut() {
            let polarity = last.polarity.below(last.operation, last.values.is_empty());
            match last.rest.pop() {
                Some(TreeOperand::Brush(id)) => {
                    last.values.push(false);
                    subtree.polarities.push(polarity);
                    self.positions.insert(id, Position { top, leaf: number32(subtree.leaves.len()) });
                    subtree.leaves.push(id);
                    subtree.entries.push(TreeNode::Leaf);
                }
                Some(TreeOperand::Node(id)) => {
                    let next = self.begin(id, polarity);
                    open.push(next);
                }
                None => {
                    let Some(Open { node, operation, values, .. }) = open.pop() else { break };
                    let node = self.nodes.get_mut(&node).expect("an operation that is an operand is there");
                    node.far = operation.value(&values);
                    subtree.entries.push(TreeNode::Operation { operation, operands: number32(values.len()) });
                    let far = node.far;
                    open.last_mut().into_iter().for_each(|above| above.values.push(far));
                }
            }
        }
        self.subtrees.insert(top, subtree);
    }

    fn begin(&self, node: NodeId, polarity: Polarity) -> Open {
        let rest = self.operands(Some(node)).rev().map(|(_, operand)| operand).collect();
        Open { node, operation: self.nodes[&node].state.operation, polarity, rest, values: Vec::new() }
    }

    /// The brushes below an operation.
    pub(super) fn leaves(&self, node: NodeId) -> Vec<BrushId> {
        let (mut leaves, mut open) = (Vec::new(), vec![node]);
        while let Some(node) = open.pop() {
            for (_, operand) in self.operands(Some(node)) {
                match operand {
                    TreeOperand::Brush(id) => leaves.push(id),
                    TreeOperand::Node(id) => open.push(id),
                }
            }
        }
        leaves
    }

    /// The operations below an operation, itself included.
    pub(super) fn nodes_below(&self, node: NodeId) -> Vec<NodeId> {
        let (mut nodes, mut next) = (vec![node], 0);
        while let Some(node) = nodes.get(next).copied() {
            next += 1;
            let below = self.operands(Some(node)).filter_map(|(_, operand)| match operand {
                TreeOperand::Node(id) => Some(id),
                TreeOperand::Brush(_) => None,
            });
            nodes.extend(below);
        }
        nodes
    }

    /// What is left of the tree where all brushes but some, sorted, are nothing. Those that cannot matter then are taken out of them.
    pub(in crate::live) fn near(&self, members: &mut Vec<Member>, role: impl Fn(&Member) -> Role) -> Vec<TreeNode> {
        let is_near = |key: &OrderKey| members.binary_search_by(|member| member.at.top.cmp(key)).is_ok();
        let far = self.barriers.iter().rev().find(|(key, _)| !is_near(key));
        let mut sequence = Sequence { nodes: Vec::with_capacity(members.len() + 4), ..Sequence::default() };
        if let Some((key, is_full)) = far {
            members.retain(|member| member.at.top > *key);
            sequence = Sequence::of_constant(*is_full);
        }
        for group in members.chunk_by(|a, b| a.at.top == b.at.top) {
            let Position { top, leaf } = group[0].at;
            if leaf == Position::ALONE {
                sequence.push(role(&group[0]), &[TreeNode::Leaf]);
                continue;
            }
            let is_member = |leaf: u32| group.binary_search_by_key(&leaf, |member| member.at.leaf).is_ok();
            let (role, subtree) = self.part(top);
            sequence.push(role, &restricted(&subtree.entries, is_member));
        }
        // an operation none of whose brushes is near matters only as a barrier
        sequence.finish()
    }

    /// Whether a brush adds to the solid or takes from it; `role` is that of a brush in the list of the model.
    pub(in crate::live) fn polarity(&self, at: Position, role: Role) -> Polarity {
        let (role, polarity) = if at.leaf == Position::ALONE {
            (role, Polarity::Adds)
        } else {
            let (role, subtree) = self.part(at.top);
            (role, subtree.polarities[at.leaf as usize])
        };
        if role == Role::Subtract { polarity.flipped() } else { polarity }
    }

    fn part(&self, top: OrderKey) -> (Role, &Subtree) {
        let role = match self.operands.get(&Place { parent: None, key: top }) {
            Some(TreeOperand::Node(id)) => self.nodes[id].state.role,
            _ => Role::Add,
        };
        (role, &self.subtrees[&top])
    }

    /// The whole tree: its nodes in postfix order, and the brushes in the order of its leaves; `role` is that of a brush in the list of the model.
    pub(in crate::live) fn whole(&self, role: impl Fn(BrushId) -> Role) -> (Vec<TreeNode>, Vec<BrushId>) {
        let (mut sequence, mut leaves) = (Sequence::default(), Vec::new());
        for (key, operand) in self.operands(None) {
            match operand {
                TreeOperand::Brush(id) => {
                    leaves.push(id);
                    sequence.push(role(id), &[TreeNode::Leaf]);
                }
                TreeOperand::Node(_) => {
                    let (role, subtree) = self.part(key);
                    leaves.extend_from_slice(&subtree.leaves);
                    sequence.push(role, &subtree.entries);
                }
            }
        }
        (sequence.finish(), leaves)
    }
}

/// Operands added, subtracted and intersected one after another, as nodes in postfix order.
struct Sequence {
    nodes: Vec<TreeNode>,
    /// What is not yet noted: the union of what is there, or of nothing, at first.
    operation: Operation,
    operands: u32,
}

impl Default for Sequence {
    fn default() -> Self {
        Self { nodes: Vec::new(), operation: Operation::Union, operands: 0 }
    }
}

impl Sequence {
    /// One that begins with nothing, or with everything.
    fn of_constant(is_full: bool) -> Self {
        let nodes = if is_full { vec![constant(true)] } else { Vec::new() };
        Self { operands: number32(nodes.len()), nodes, operation: Operation::Union }
    }

    /// Adds an operand, which is made of nodes.
    fn push(&mut self, role: Role, nodes: &[TreeNode]) {
        let next = match role {
            Role::Add => Operation::Union,
            Role::Subtract => Operation::Difference,
            Role::Intersect => Operation::Intersection,
        };
        if next != self.operation {
            self.nodes.push(TreeNode::Operation { operation: self.operation, operands: self.operands });
            (self.operation, self.operands) = (next, 1);
        }
        self.nodes.extend_from_slice(nodes);
        self.operands += 1;
    }

    fn finish(mut self) -> Vec<TreeNode> {
        self.nodes.push(TreeNode::Operation { operation: self.operation, operands: self.operands });
        self.nodes
    }
}

/// What is left of the nodes of a tree where all leaves but some are empty: these become the leaves, in their order.
fn restricted(nodes: &[TreeNode], stays: impl Fn(u32) -> bool) -> Vec<TreeNode> {
    let mut rest: Vec<TreeNode> = Vec::new();
    // for each operand that no operation has taken its value, where it is a constant: then it has no nodes
    let mut open: Vec<Option<bool>> = Vec::new();
    let mut leaf = 0;
    for node in nodes {
        match *node {
            TreeNode::Leaf => {
                let is_there = stays(leaf);
                leaf += 1;
                if is_there {
                    rest.push(TreeNode::Leaf);
                }
                open.push(if is_there { None } else { Some(false) });
            }
            TreeNode::Operation { operation, operands } => {
                let operands = open.split_off(open.len() - operands as usize);
                let mut value = combine(operation, &operands, &mut rest);
                let kept = number32(operands.iter().filter(|value| value.is_none()).count());
                if let Some(constant_value) = value.filter(|_| kept > 0) {
                    // the leaves that stay are there, whatever they come to
                    let operation = if constant_value { Operation::Union } else { Operation::Intersection };
                    rest.extend([constant(constant_value), TreeNode::Operation { operation, operands: kept + 1 }]);
                    value = None;
                }
                open.push(value);
            }
        }
    }
    if let Some(Some(value)) = open.pop() {
        rest.push(constant(value));
    }
    rest
}

fn constant(value: bool) -> TreeNode {
    TreeNode::Operation { operation: if value { Operation::Intersection } else { Operation::Union }, operands: 0 }
}

/// Adds an operation on operands, some of them constant; its value, where it is constant itself.
fn combine(operation: Operation, operands: &[Option<bool>], rest: &mut Vec<TreeNode>) -> Option<bool> {
    let count = number32(operands.iter().filter(|value| value.is_none()).count());
    let any = |value: bool| operands.contains(&Some(value));
    let mut push = |operation, operands| rest.push(TreeNode::Operation { operation, operands });
    match operation {
        Operation::Union | Operation::Complement => {
            let is_complement = operation == Operation::Complement;
            if any(true) || count == 0 {
                return Some(any(true) != is_complement);
            }
            push(operation, count);
        }
        Operation::Intersection => {
            if any(false) || count == 0 {
                return Some(!any(false));
            }
            push(operation, count);
        }
        Operation::Xor => {
            let is_odd = operands.iter().filter(|value| **value == Some(true)).count() % 2 == 1;
            if count == 0 {
                return Some(is_odd);
            }
            push(operation, count);
            if is_odd {
                push(Operation::Complement, 1);
            }
        }
        Operation::Difference => {
            let (first, others) = match operands.split_first() {
                Some((first, others)) => (*first, others),
                None => (Some(false), operands),
            };
            if first == Some(false) || others.contains(&Some(true)) {
                return Some(false);
            }
            match (first, count) {
                (Some(_), 0) => return Some(true),
                // everything but the others
                (Some(_), _) => push(Operation::Complement, count),
                (None, _) => push(operation, count),
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Brush, Tree};

    fn leaf() -> Tree {
        Tree::from(Brush::default())
    }

    #[test]
    fn a_restricted_tree_has_the_value_of_the_whole_where_the_other_leaves_are_empty() {
        // the value of nodes where some leaves are 1
        fn value(nodes: &[TreeNode], leaves: &[bool]) -> bool {
            let (mut open, mut leaf) = (Vec::new(), leaves.iter());
            for node in nodes {
                let value = match *node {
                    TreeNode::Leaf => *leaf.next().expect("as many leaves as nodes say"),
                    TreeNode::Operation { operation, operands } => {
                        let operands: Vec<bool> = open.split_off(open.len() - operands as usize);
                        let any = operands.iter().any(|value| *value);
                        match operation {
                            Operation::Union => any,
                            Operation::Complement => !any,
                            Operation::Intersection => operands.iter().all(|value| *value),
                            Operation::Xor => operands.iter().filter(|value| **value).count() % 2 == 1,
                            Operation::Difference => {
                                operands.split_first().is_some_and(|(first, others)| *first && !others.contains(&true))
                            }
                        }
                    }
                };
                open.push(value);
            }
            assert_eq!(open.len(), 1, "{nodes:?}");
            open[0]
        }
        let trees = [
            (leaf() | leaf()) - (leaf() & leaf()),
            !(leaf() - leaf()) & (leaf() ^ leaf()),
            Tree::everything() - leaf() - (leaf() | leaf() | leaf()),
            leaf() ^ !leaf() ^ (leaf() - !leaf()),
            Tree::combine(Operation::Complement, [leaf(), leaf() & !leaf(), Tree::empty(), leaf()]),
        ];
        for tree in trees {
            assert_eq!(tree.brushes().len(), 4, "{tree:?}");
            for stays in 0..16_u32 {
                let rest = restricted(tree.nodes(), |leaf| stays >> leaf & 1 == 1);
                for leaves in (0..16_u32).filter(|leaves| leaves & !stays == 0) {
                    let all: Vec<bool> = (0..4).map(|leaf| leaves >> leaf & 1 == 1).collect();
                    let some: Vec<bool> = (0..4).filter(|leaf| stays >> leaf & 1 == 1).map(|leaf| all[leaf]).collect();
                    assert_eq!(
                        value(&rest, &some),
                        value(tree.nodes(), &all),
                        "{tree:?} {stays:b} {leaves:b} {rest:?}"
                    );
                }
            }
        }
    }
}
