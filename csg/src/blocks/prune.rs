//! What a tree is where only some of its brushes are.

use crate::ids::number32;
use std::num::NonZeroU32;

use crate::model::{Brush, Operation, Tree, TreeNode};

/// What a tree is where only the brushes numbered by `members`, ascending, are something; `brush` makes the brush of a number. The
/// brushes keep their source lines.
pub(super) fn tree_of_some(tree: &Tree, members: &[u32], brush: impl Fn(u32) -> Brush) -> Tree {
    let mut pruned = Pruned::default();
    let (mut leaf, mut members) = (0, members.iter().copied().peekable());
    for node in tree.nodes() {
        match *node {
            TreeNode::Leaf => {
                let member = members.next_if_eq(&leaf);
                pruned.leaf(member.map(|member| (brush(member), tree.source_line(member as usize))));
                leaf += 1;
            }
            TreeNode::Operation { operation, operands } => pruned.operation(operation, operands as usize),
        }
    }
    match pruned.results.pop().flatten() {
        Some(_) => Tree::of_parts(pruned.brushes, pruned.nodes).with_source_lines(pruned.lines),
        None => Tree::empty(),
    }
}

/// A tree on its way.
#[derive(Default)]
struct Pruned {
    brushes: Vec<Brush>,
    /// The source lines of the brushes.
    lines: Vec<Option<NonZeroU32>>,
    nodes: Vec<TreeNode>,
    /// The results that no operation has taken yet: where the brushes and the nodes of each begin; nothing for one that is
    /// nothing.
    results: Vec<Option<(usize, usize)>>,
}

impl Pruned {
    fn leaf(&mut self, brush: Option<(Brush, Option<NonZeroU32>)>) {
        let begin = (self.brushes.len(), self.nodes.len());
        self.results.push(brush.map(|(brush, line)| {
            self.brushes.push(brush);
            self.lines.push(line);
            self.nodes.push(TreeNode::Leaf);
            begin
        }));
    }

    fn operation(&mut self, operation: Operation, operands: usize) {
        let end = (self.brushes.len(), self.nodes.len());
        let taken = self.results.split_off(self.results.len() - operands);
        let left = taken.iter().flatten().count();
        let begin = taken.iter().flatten().next().copied().unwrap_or(end);
        let is_nothing = match operation {
            Operation::Union | Operation::Xor => left == 0,
            Operation::Intersection => left < operands,
            Operation::Difference => taken.first().is_none_or(Option::is_none),
            Operation::Complement => false,
        };
        if is_nothing {
            self.brushes.truncate(begin.0);
            self.lines.truncate(begin.0);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::Expression;

    /// The value of a tree for leaves that are given, by definition.
    fn value(nodes: &[TreeNode], mut leaves: impl Iterator<Item = bool>) -> bool {
        let mut stack: Vec<bool> = Vec::new();
        for node in nodes {
            match *node {
                TreeNode::Leaf => stack.push(leaves.next().unwrap()),
                TreeNode::Operation { operation, operands } => {
                    let taken = stack.split_off(stack.len() - operands as usize);
                    stack.push(match operation {
                        Operation::Union => taken.contains(&true),
                        Operation::Intersection => !taken.contains(&false),
                        Operation::Difference => taken.first() == Some(&true) && !taken[1..].contains(&true),
                        Operation::Xor => taken.iter().filter(|value| **value).count() % 2 == 1,
                        Operation::Complement => !taken.contains(&true),
                    });
                }
            }
        }
        stack.pop().unwrap()
    }

    #[test]
    fn a_pruned_tree_is_the_tree_where_the_others_are_nothing() {
        let mut state = 3_u64;
        let mut below = |bound: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % bound
        };
        for _ in 0..2000 {
            let (mut nodes, mut open) = (Vec::new(), 0);
            while nodes.len() < 20 || open > 1 {
                if open > 0 && (below(3) == 0 || nodes.len() >= 20) {
                    let operation = [
                        Operation::Union,
                        Operation::Intersection,
                        Operation::Difference,
                        Operation::Xor,
                        Operation::Complement,
                    ][below(5) as usize];
                    let operands = if operation == Operation::Complement { 1 } else { 1 + below(open) };
                    nodes.push(TreeNode::Operation { operation, operands: operands as u32 });
                    open -= operands - 1;
                } else {
                    nodes.push(TreeNode::Leaf);
                    open += 1;
                }
            }
            let leaves = nodes.iter().filter(|node| **node == TreeNode::Leaf).count() as u32;
            let members: Vec<u32> = (0..leaves).filter(|_| below(2) == 0).collect();
            // a brush tells by its source line which one it was
            let all = Tree::of_parts(vec![Brush::default(); leaves as usize], nodes.clone());
            let all = all.with_source_lines((1..=leaves).map(NonZeroU32::new).collect());
            let tree = tree_of_some(&all, &members, |_| Brush::default());
            // a base of 1 is kept as well
            let base = Expression::new(tree.nodes()).base();
            assert_eq!(base, value(&nodes, std::iter::repeat(false)));
            for _ in 0..20 {
                let values: Vec<bool> = (0..leaves).map(|leaf| members.contains(&leaf) && below(2) == 0).collect();
                let of_pruned = tree.source_lines().map(|line| values[line.unwrap().get() as usize - 1]);
                assert_eq!(
                    value(tree.nodes(), of_pruned),
                    value(&nodes, values.iter().copied()),
                    "{nodes:?} {members:?}"
                );
            }
        }
    }
}
