//! Leaves of a tree that alone decide what is solid.

use crate::arrangement::DecidingLeaves;
use crate::model::{Operation, TreeNode};

/// What the whole tree holds where an entry holds a point, and where it does not, as far as that entry alone decides.
type Decided = [Option<bool>; 2];

/// The leaves of a tree inside of which it holds all, or else nothing, whatever the other leaves hold: all operands of a union, all but the
/// first of a difference, and what is made of these. None where no leaf is one.
pub(super) fn deciding_leaves(nodes: &[TreeNode]) -> Option<DecidingLeaves> {
    // from the root down: the last operand of an operation comes right before it
    let mut waiting: Vec<Decided> = vec![[Some(false), Some(true)]];
    let mut leaves: Vec<Option<bool>> = Vec::new();
    for node in nodes.iter().rev() {
        let [if_out, if_in] = waiting.pop().expect("every entry is taken by another one, but for the root");
        match node {
            TreeNode::Leaf => leaves.push(if_in),
            TreeNode::Operation { operation, operands } => {
                let is_alone = *operands == 1;
                let operand = |k: u32| match operation {
                    Operation::Union => [if_out.filter(|_| is_alone), if_in],
                    Operation::Intersection => [if_out, if_in.filter(|_| is_alone)],
                    Operation::Difference if k == 0 => [if_out, if_in.filter(|_| is_alone)],
                    Operation::Difference => [None, if_out],
                    Operation::Xor if is_alone => [if_out, if_in],
                    Operation::Xor => [None; 2],
                    Operation::Complement => [if_in.filter(|_| is_alone), if_out],
                };
                waiting.extend((0..*operands).map(operand));
            }
        }
    }
    leaves.reverse();
    // where there are several, all decide alike: a point may lie in all of them
    let value = leaves.iter().flatten().next().copied()?;
    Some(DecidingLeaves { leaves: leaves.iter().map(Option::is_some).collect(), value })
}
