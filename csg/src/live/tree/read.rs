//! The tree of a model to begin with.
//!
//! What combines its operands one after another is taken apart: they are the list of the live model, with roles. So are unions within unions, and what is subtracted as a union. All else stays an operation, numbered
//! in the order in which operations begin when the tree is read from left to right.

use super::{NodeId, NodeState, OrderKey, Place};
use crate::live::operand::Role;
use crate::model::{Operation, TreeNode};

/// Where each brush is and its role, and each operation.
pub(in crate::live) struct Read {
    pub(in crate::live) brushes: Vec<(Place, Role)>,
    pub(in crate::live) nodes: Vec<(NodeId, NodeState)>,
}

/// Operations by the place of their node, each with the places of its operands.
struct Operations<'a> {
    nodes: &'a [TreeNode],
    operands: Vec<Vec<usize>>,
}

impl Operations<'_> {
    fn operation(&self, node: usize) -> Option<Operation> {
        match self.nodes[node] {
            TreeNode::Leaf => None,
            TreeNode::Operation { operation, .. } => Some(operation),
        }
    }

    /// What is combined one after another, each with what it does.
    fn sequence(&self, root: usize) -> Vec<(Role, usize)> {
        // from the last to the first
        let mut parts: Vec<(Role, usize)> = Vec::new();
        let mut first = root;
        loop {
            let (role, joined) = match self.operation(first) {
                Some(Operation::Union) => (Role::Add, Operation::Union),
                Some(Operation::Difference) => (Role::Subtract, Operation::Union),
                Some(Operation::Intersection) => (Role::Intersect, Operation::Intersection),
                _ => break,
            };
            let Some((next, others)) = self.operands[first].split_first() else {
                if joined == Operation::Intersection {
                    break;
                }
                parts.reverse();
                return parts;
            };
            for other in others.iter().rev() {
                parts.extend(self.joined(*other, joined).into_iter().rev().map(|part| (role, part)));
            }
            first = *next;
        }
        parts.push((Role::Add, first));
        parts.reverse();
        parts
    }

    /// The operands of an operation of a kind, and of those of the same kind among them; otherwise the node itself.
    fn joined(&self, node: usize, kind: Operation) -> Vec<usize> {
        let (mut parts, mut rest) = (Vec::new(), vec![node]);
        while let Some(node) = rest.pop() {
            if self.operation(node) == Some(kind) {
                rest.extend(self.operands[node].iter().rev());
            } else {
                parts.push(node);
            }
        }
        parts
    }
}

/// Reads well-formed nodes in postfix order.
pub(in crate::live) fn read(nodes: &[TreeNode]) -> Read {
    let (mut operands, mut open, mut leaves) = (vec![Vec::new(); nodes.len()], Vec::new(), 0);
    let mut leaf_of = vec![usize::MAX; nodes.len()];
    for (at, node) in nodes.iter().enumerate() {
        match node {
            TreeNode::Leaf => {
                leaf_of[at] = leaves;
                leaves += 1;
            }
            TreeNode::Operation { operands: count, .. } => {
                operands[at] = open.split_off(open.len() - *count as usize);
            }
        }
        open.push(at);
    }
    let operations = Operations { nodes, operands };
    let nowhere = Place { parent: None, key: OrderKey::FIRST };
    let mut read = Read { brushes: vec![(nowhere, Role::Add); leaves], nodes: Vec::new() };
    // the next one last
    let mut rest: Vec<(usize, Place, Role)> = Vec::new();
    for (index, (role, part)) in operations.sequence(nodes.len() - 1).into_iter().enumerate().rev() {
        rest.push((part, Place { parent: None, key: OrderKey::of_index(index) }, role));
    }
    while let Some((at, place, role)) = rest.pop() {
        let Some(operation) = operations.operation(at) else {
            read.brushes[leaf_of[at]] = (place, role);
            continue;
        };
        let id = NodeId(read.nodes.len() as u64);
        read.nodes.push((id, NodeState { operation, role, place }));
        for (index, operand) in operations.operands[at].iter().enumerate().rev() {
            rest.push((*operand, Place { parent: Some(id), key: OrderKey::of_index(index) }, Role::Add));
        }
    }
    read
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Brush, Tree};

    fn leaf() -> Tree {
        Tree::from(Brush::default())
    }

    /// The roles of the brushes in the list of the model, and the operations with their roles there.
    fn roles(tree: &Tree) -> (Vec<Role>, Vec<(Operation, Role)>) {
        let Read { brushes, nodes } = read(tree.nodes());
        let mut listed: Vec<&(Place, Role)> = brushes.iter().filter(|brush| brush.0.parent.is_none()).collect();
        listed.sort_by_key(|brush| brush.0);
        let nodes = nodes.iter().filter(|node| node.1.place.parent.is_none());
        (listed.iter().map(|brush| brush.1).collect(), nodes.map(|node| (node.1.operation, node.1.role)).collect())
    }

    #[test]
    fn what_is_combined_one_after_another_has_roles_and_all_else_is_an_operation() {
        use Role::{Add, Intersect, Subtract};
        let chain = (((leaf() | leaf()) - (leaf() | leaf())) | leaf()) & (leaf() & leaf());
        assert_eq!(roles(&chain), (vec![Add, Add, Subtract, Subtract, Add, Intersect, Intersect], vec![]));
        assert_eq!(roles(&Tree::empty()), (vec![], vec![]));
        assert_eq!(roles(&(leaf() | (leaf() - leaf()))), (vec![Add], vec![(Operation::Difference, Add)]));
        assert_eq!(roles(&(leaf() & (leaf() | leaf()))), (vec![Add], vec![(Operation::Union, Intersect)]));
        assert_eq!(roles(&((leaf() ^ leaf()) - leaf())), (vec![Subtract], vec![(Operation::Xor, Add)]));
        assert_eq!(roles(&!leaf()), (vec![], vec![(Operation::Complement, Add)]));
        assert_eq!(roles(&(leaf() - Tree::everything())), (vec![Add], vec![(Operation::Intersection, Subtract)]));
    }

    #[test]
    fn operations_are_numbered_as_they_begin() {
        // a ∪ (b − (c ⊕ d)) ∪ (e ∩ f)
        let tree = leaf() | (leaf() - (leaf() ^ leaf())) | (leaf() & leaf());
        let Read { brushes, nodes } = read(tree.nodes());
        let operations: Vec<(u64, Operation)> = nodes.iter().map(|node| (node.0.0, node.1.operation)).collect();
        assert_eq!(operations, [(0, Operation::Difference), (1, Operation::Xor), (2, Operation::Intersection)]);
        let parents: Vec<Option<u64>> = brushes.iter().map(|brush| brush.0.parent.map(|node| node.0)).collect();
        assert_eq!(parents, [None, Some(0), Some(1), Some(1), Some(2), Some(2)]);
    }

    #[test]
    fn deep_trees_need_no_deep_stack() {
        let mut nodes = vec![TreeNode::Leaf; 100_001];
        nodes.extend(std::iter::repeat_n(TreeNode::Operation { operation: Operation::Xor, operands: 2 }, 100_000));
        assert_eq!(read(&nodes).nodes.len(), 100_000);
    }
}
