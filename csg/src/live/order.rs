//! How the brushes of a live model are combined: one after another, or first as in a tree.

use std::collections::BTreeMap;

use super::history::New;
use super::operand::{Role, State};
use super::{BrushId, LiveModel};
use crate::ids::{Id, number32};
use crate::model::{Model, Operation, Tree, TreeNode};

impl LiveModel {
    /// The model as a tree, once some brushes have other states.
    pub(super) fn model_after(&self, new: &[New]) -> Model {
        let operands = self.by_id.values().filter_map(|number| self.operands[number.index()].as_ref());
        let mut states: BTreeMap<BrushId, &State> = operands.map(|operand| (operand.id, &*operand.state)).collect();
        for (id, state) in new {
            match state {
                Some(state) => states.insert(*id, state),
                None => states.remove(id),
            };
        }
        let leaves = self.base.as_ref().map_or(0, |base| u64::from(base.leaves));
        let base = self.base.as_ref().map(|base| {
            let nothing = TreeNode::Operation { operation: Operation::Union, operands: 0 };
            let mut leaf = 0..base.leaves;
            let node = |node: &TreeNode| match node {
                TreeNode::Leaf if leaf.next().is_none_or(|id| !states.contains_key(&BrushId(id.into()))) => nothing,
                other => *other,
            };
            base.nodes.iter().map(node).collect::<Vec<TreeNode>>()
        });
        let roles = states.range(BrushId(leaves)..).map(|(_, state)| state.role);
        let nodes = sequence(base.unwrap_or_default(), roles);
        let brushes = states.values().map(|state| state.brush.clone()).collect();
        let lines = states.values().map(|state| state.line).collect();
        Model { materials: self.materials.clone(), tree: Tree::of_parts(brushes, nodes).with_source_lines(lines) }
    }
}

/// The roles of a tree's brushes where it does no more than to add, subtract and intersect one brush after another; nothing
/// where it does more.
pub(super) fn roles_of(tree: &Tree) -> Option<Vec<Role>> {
    let mut open: Vec<Part> = Vec::new();
    for node in tree.nodes() {
        let part = match *node {
            TreeNode::Leaf => Part { roles: Some(vec![Role::Add]), is_union: true, is_intersection: true },
            TreeNode::Operation { operation, operands } => {
                Part::combined(operation, open.split_off(open.len() - operands as usize))
            }
        };
        open.push(part);
    }
    open.pop()?.roles
}

/// What a part of a tree does with its leaves.
struct Part {
    /// Their roles, where it is a sequence.
    roles: Option<Vec<Role>>,
    /// Whether it is the union, or the intersection, of all of them.
    is_union: bool,
    is_intersection: bool,
}

impl Part {
    fn combined(operation: Operation, parts: Vec<Self>) -> Self {
        let is_union = operation == Operation::Union && parts.iter().all(|part| part.is_union);
        let is_intersection =
            operation == Operation::Intersection && !parts.is_empty() && parts.iter().all(|part| part.is_intersection);
        let mut parts = parts.into_iter();
        let role = match operation {
            Operation::Union => Some((Role::Add, true)),
            Operation::Difference => Some((Role::Subtract, true)),
            Operation::Intersection => Some((Role::Intersect, false)),
            Operation::Xor | Operation::Complement => None,
        };
        let roles = role.and_then(|(role, of_unions)| {
            let Some(first) = parts.next() else { return of_unions.then(Vec::new) };
            parts.try_fold(first.roles?, |mut roles, part| {
                let serves = if of_unions { part.is_union } else { part.is_intersection };
                let others = part.roles.filter(|_| serves)?.len();
                roles.extend(std::iter::repeat_n(role, others));
                Some(roles)
            })
        });
        Self { roles, is_union, is_intersection }
    }
}

/// Brushes added, subtracted and intersected one after another to what nodes make of others before them.
pub(super) fn sequence(base: Vec<TreeNode>, roles: impl Iterator<Item = Role>) -> Vec<TreeNode> {
    let mut nodes = base;
    // what is not yet noted: the union of what is there, or of nothing, at first
    let (mut operation, mut operands) = (Operation::Union, u32::from(!nodes.is_empty()));
    for role in roles {
        let next = operation_of(role);
        if next != operation {
            nodes.push(TreeNode::Operation { operation, operands });
            (operation, operands) = (next, 1);
        }
        nodes.push(TreeNode::Leaf);
        operands += 1;
    }
    nodes.push(TreeNode::Operation { operation, operands });
    nodes
}

fn operation_of(role: Role) -> Operation {
    match role {
        Role::Add => Operation::Union,
        Role::Subtract => Operation::Difference,
        Role::Intersect => Operation::Intersection,
    }
}

/// What is left of the nodes of a tree where all leaves but some are empty: these become the leaves, in their order.
pub(super) fn restricted(nodes: &[TreeNode], stays: impl Fn(u32) -> bool) -> Vec<TreeNode> {
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
    use crate::model::Brush;

    fn leaf() -> Tree {
        Tree::from(Brush::default())
    }

    #[test]
    fn chains_of_brushes_are_sequences_and_nested_ones_are_not() {
        use Role::{Add, Intersect, Subtract};
        let chain = (((leaf() | leaf()) - (leaf() | leaf())) | leaf()) & (leaf() & leaf());
        let expected = [Add, Add, Subtract, Subtract, Add, Intersect, Intersect];
        assert_eq!(roles_of(&chain).as_deref(), Some(&expected[..]));
        assert_eq!(roles_of(&Tree::empty()).as_deref(), Some(&[][..]));
        for nested in
            [leaf() | (leaf() - leaf()), leaf() & (leaf() | leaf()), leaf() ^ leaf(), !leaf(), Tree::everything()]
        {
            assert_eq!(roles_of(&nested), None, "{nested:?}");
        }
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
