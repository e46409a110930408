//! Random trees, and what they say by the definitions.

use crate::model::{Operation, TreeNode};

/// Small random numbers (Marsaglia's xorshift).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }
}

pub(crate) fn random_tree(random: &mut Random) -> Vec<TreeNode> {
    use Operation::{Complement, Difference, Intersection, Union, Xor};
    let mut entries = Vec::new();
    let mut open = 0;
    let steps = 2 + random.below(24);
    for step in 0..steps {
        if open == 0 || random.below(5) < 3 && step + 1 < steps {
            entries.push(TreeNode::Leaf);
            open += 1;
        }
        if random.below(2) == 0 || step + 1 == steps {
            let operation = [Union, Intersection, Difference, Xor, Complement][random.below(5) as usize];
            let operands = if step + 1 == steps { open } else { random.below(open + 1) };
            entries.push(TreeNode::Operation { operation, operands: operands as u32 });
            open = open + 1 - operands;
        }
    }
    entries
}

/// The value of a tree from its definition.
pub(crate) fn value(entries: &[TreeNode], leaves: &[bool]) -> bool {
    let mut stack: Vec<bool> = Vec::new();
    let mut next = leaves.iter();
    for entry in entries {
        match *entry {
            TreeNode::Leaf => stack.push(*next.next().expect("a value for each leaf")),
            TreeNode::Operation { operation, operands } => {
                let taken = stack.split_off(stack.len() - operands as usize);
                let any = |values: &[bool]| values.iter().any(|v| *v);
                stack.push(match operation {
                    Operation::Union => any(&taken),
                    Operation::Intersection => taken.iter().all(|v| *v),
                    Operation::Difference => taken.first().is_some_and(|first| *first && !any(&taken[1..])),
                    Operation::Xor => taken.iter().filter(|v| **v).count() % 2 == 1,
                    Operation::Complement => !any(&taken),
                });
            }
        }
    }
    stack[0]
}
