//! A tree of set operations made ready for asking it about a few leaves at a time.
//!
//! Far from a leaf its value is 0. So near a face only the leaves that reach it are unknown; all others are 0, and what
//! they leave of the tree ([`Restriction`]) is as small as their number, however large or deep the tree is: chains of
//! operations between two branchings come to nothing, a negation, or a constant, which is looked up.

#[cfg(test)]
pub(crate) mod random_trees;
mod repeats;
mod restriction;

use std::sync::OnceLock;

use smallvec::SmallVec;

use crate::ids::{Id, LeafId, TreeNodeId, number32};
use crate::model::{Operation, TreeNode};
pub(crate) use restriction::Restriction;

/// What is known of a node of the tree. *Base* is the value where all leaves are 0.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// `None` for a leaf.
    operation: Option<Operation>,
    depth: u32,
    /// The leaves below are `first_leaf..end_leaf`.
    first_leaf: LeafId,
    end_leaf: LeafId,
    operands: u32,
    base: bool,
    /// Operands with base 1; for a difference without the first operand.
    true_operands: u32,
    /// For a difference: the end of the leaves of its first operand, and the base of that.
    first_operand: (LeafId, bool),
    /// Whether the root sees the negation of this node where all that is beside its way to the root is at base; not
    /// counting constants on that way.
    is_negated: bool,
    /// The largest depth of a node on the way to the root (this one included) whose parent is constant whatever the node is,
    /// as long as its siblings are at base; counted from 1, 0 where there is none.
    blocked_at: u32,
    polarity: Polarity,
}

/// Whether a node adds to the solid or takes from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Polarity {
    /// What is added to the node can only take from the solid.
    Takes,
    /// Either, depending on other operands of an exclusive or.
    Both,
    /// What is added to the node can only add to the solid.
    Adds,
}

impl Polarity {
    pub(crate) fn flipped(self) -> Self {
        match self {
            Self::Adds => Self::Takes,
            Self::Both => Self::Both,
            Self::Takes => Self::Adds,
        }
    }

    /// That of an operand of a node of this polarity; of a difference the first operand is told from the others.
    pub(crate) fn below(self, operation: Operation, is_first: bool) -> Self {
        match operation {
            Operation::Xor => Self::Both,
            Operation::Complement => self.flipped(),
            Operation::Difference if !is_first => self.flipped(),
            Operation::Union | Operation::Intersection | Operation::Difference => self,
        }
    }

    /// That of something that is found in two places.
    fn with(self, other: Self) -> Self {
        if self == other { self } else { Self::Both }
    }
}

/// For each leaf the polarity of all leaves that equal it: both, where one adds and another takes. `kinds` gives one number to equal leaves: that of the first of them.
pub(crate) fn common_polarities(kinds: &[LeafId], polarity: impl Fn(LeafId) -> Polarity) -> Vec<Polarity> {
    let mut common: Vec<Polarity> = LeafId::all(kinds.len()).map(&polarity).collect();
    for (k, kind) in kinds.iter().enumerate() {
        common[kind.index()] = common[kind.index()].with(common[k]);
    }
    kinds.iter().map(|kind| common[kind.index()]).collect()
}

/// What a tree of one level does with its leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OneLevel {
    /// It is their union.
    Union,
    /// All others are taken from the first.
    Difference,
}

/// A tree of set operations over leaves that are numbered from left to right.
#[derive(Debug, Clone)]
pub(crate) struct Expression {
    nodes: Vec<Node>,
    /// The node above each node.
    parents: Vec<TreeNodeId>,
    leaves: Vec<TreeNodeId>,
    /// For the leaves `k` and `k + 1` the lowest node above both, then minima over ranges of powers of two of it. Trees of one level are never asked for it.
    between: OnceLock<Vec<Vec<TreeNodeId>>>,
}

impl Expression {
    /// Reads the postfix order of a tree.
    pub(crate) fn new(entries: &[TreeNode]) -> Self {
        let mut nodes: Vec<Node> = Vec::with_capacity(entries.len());
        let mut parents: Vec<TreeNodeId> = Vec::with_capacity(entries.len());
        let mut open: SmallVec<[TreeNodeId; 16]> = SmallVec::new();
        let mut leaves = Vec::with_capacity(entries.len());
        for (number, entry) in TreeNodeId::all(entries.len()).zip(entries) {
            let next_leaf = LeafId::from_index(leaves.len());
            let node = match *entry {
                TreeNode::Leaf => {
                    leaves.push(number);
                    Node::leaf(next_leaf)
                }
                TreeNode::Operation { operation, operands } => {
                    let taken = open.drain(open.len() - operands as usize..);
                    let below = taken.map(|operand| {
                        parents[operand.index()] = number;
                        &nodes[operand.index()]
                    });
                    let operands: SmallVec<[&Node; 8]> = below.collect();
                    Node::operation(operation, &operands, next_leaf)
                }
            };
            nodes.push(node);
            parents.push(TreeNodeId::NONE);
            open.push(number);
        }
        descend(&mut nodes, &parents);
        Self { nodes, parents, leaves, between: OnceLock::new() }
    }

    /// The union of as many leaves.
    pub(crate) fn union_of(leaves: usize) -> Self {
        let mut entries = vec![TreeNode::Leaf; leaves];
        entries.push(TreeNode::Operation { operation: Operation::Union, operands: number32(leaves) });
        Self::new(&entries)
    }

    /// The value where all leaves are 0.
    pub(crate) fn base(&self) -> bool {
        self.nodes.last().is_some_and(|root| root.base)
    }

    /// The operation of a tree of one level, or of one that is the same.
    pub(crate) fn one_level(&self) -> Option<OneLevel> {
        let (root, others) = self.nodes.split_last()?;
        let is_union = |node: &Node| matches!(node.operation, None | Some(Operation::Union));
        if !others.iter().all(is_union) {
            return None;
        }
        match root.operation {
            None | Some(Operation::Union) => Some(OneLevel::Union),
            Some(Operation::Difference) if root.first_operand.0.index() == 1 => Some(OneLevel::Difference),
            _ => None,
        }
    }

    /// Whether a leaf adds to the solid or takes from it.
    pub(crate) fn polarity(&self, leaf: LeafId) -> Polarity {
        self.nodes[self.leaves[leaf.index()].index()].polarity
    }

    /// For each leaf the polarity of all leaves that equal it; as [`common_polarities`].
    pub(crate) fn common_polarities(&self, kinds: &[LeafId]) -> Vec<Polarity> {
        common_polarities(kinds, |leaf| self.polarity(leaf))
    }

    /// Whether the tree, of which the value is 0 where all leaves are, is 1 where only this leaf is.
    pub(crate) fn is_solid_alone(&self, leaf: LeafId) -> bool {
        let node = &self.nodes[self.leaves[leaf.index()].index()];
        node.blocked_at == 0 && !node.is_negated
    }

    /// The lowest node above two different leaves, `p < q`.
    fn lowest_above(&self, p: LeafId, q: LeafId) -> TreeNodeId {
        let (p, q) = (p.index(), q.index());
        let level = (q - p).ilog2() as usize;
        let between = self.between.get_or_init(|| lowest_between(&self.nodes, &self.leaves, &self.parents));
        let (a, b) = (between[level][p], between[level][q - (1 << level)]);
        shallower(&self.nodes, a, b)
    }
}

impl Node {
    fn leaf(number: LeafId) -> Self {
        Self {
            operation: None,
            depth: 0,
            first_leaf: number,
            end_leaf: number.plus(1),
            operands: 0,
            base: false,
            true_operands: 0,
            first_operand: (number, false),
            is_negated: false,
            blocked_at: 0,
            polarity: Polarity::Adds,
        }
    }

    /// An operation on operands, of which the last leaf before it is `end_leaf - 1`.
    fn operation(operation: Operation, operands: &[&Self], end_leaf: LeafId) -> Self {
        let first_leaf = operands.first().map_or(end_leaf, |first| first.first_leaf);
        let first_operand = operands.first().map_or((end_leaf, false), |first| (first.end_leaf, first.base));
        // of a difference without operands nothing is taken away either
        let counted = if operation == Operation::Difference { operands.get(1..).unwrap_or_default() } else { operands };
        let true_operands = number32(counted.iter().filter(|operand| operand.base).count());
        let mut node = Self {
            operation: Some(operation),
            first_leaf,
            end_leaf,
            operands: number32(operands.len()),
            true_operands,
            first_operand,
            ..Self::leaf(first_leaf)
        };
        node.base = node.value(true_operands, first_operand.1);
        node
    }

    /// The value for a number of true operands; `first` is that of a difference's first operand.
    fn value(&self, true_operands: u32, first: bool) -> bool {
        match self.operation {
            None => false,
            Some(Operation::Union) => true_operands > 0,
            Some(Operation::Intersection) => true_operands == self.operands,
            Some(Operation::Difference) => first && true_operands == 0,
            Some(Operation::Xor) => true_operands % 2 == 1,
            Some(Operation::Complement) => true_operands == 0,
        }
    }

    /// Whether `leaf`, which is below, is below the first operand of this difference.
    fn is_in_first(&self, leaf: LeafId) -> bool {
        self.operation == Some(Operation::Difference) && leaf < self.first_operand.0
    }

    /// Whether an operand changes nothing while all others are at base; one without leaves never changes.
    fn ignores(&self, operand: &Self) -> bool {
        if operand.first_leaf == operand.end_leaf {
            return true;
        }
        let is_first = self.is_in_first(operand.first_leaf);
        let others_true = self.true_operands - u32::from(operand.base && !is_first);
        match self.operation {
            None => true,
            Some(Operation::Union | Operation::Complement) => others_true > 0,
            Some(Operation::Intersection) => others_true + 1 < self.operands,
            Some(Operation::Difference) => others_true > 0 || !(is_first || self.first_operand.1),
            Some(Operation::Xor) => false,
        }
    }

    /// Whether the value falls as the operand that holds `leaf` rises; of an exclusive or this is not told.
    fn negates(&self, leaf: LeafId) -> bool {
        match self.operation {
            Some(Operation::Difference) => !self.is_in_first(leaf),
            Some(Operation::Complement) => true,
            _ => false,
        }
    }
}

/// Fills in what depends on the way to the root.
fn descend(nodes: &mut [Node], parents: &[TreeNodeId]) {
    for k in (0..nodes.len()).rev() {
        let Some(parent) = nodes.get(parents[k].index()).copied() else { continue };
        let depth = parent.depth + 1;
        let node = &mut nodes[k];
        let negates = parent.negates(node.first_leaf);
        let is_odd = parent.operation == Some(Operation::Xor) && (parent.true_operands % 2 == 1) != node.base;
        node.depth = depth;
        node.is_negated = parent.is_negated ^ negates ^ is_odd;
        node.blocked_at = if parent.ignores(node) { depth + 1 } else { parent.blocked_at };
        let is_first = parent.is_in_first(node.first_leaf);
        node.polarity = parent.operation.map_or(parent.polarity, |above| parent.polarity.below(above, is_first));
    }
}

fn shallower(nodes: &[Node], a: TreeNodeId, b: TreeNodeId) -> TreeNodeId {
    if nodes[b.index()].depth < nodes[a.index()].depth { b } else { a }
}

/// The lowest nodes above neighbouring leaves, and minima over their ranges.
fn lowest_between(nodes: &[Node], leaves: &[TreeNodeId], parents: &[TreeNodeId]) -> Vec<Vec<TreeNodeId>> {
    // In postfix order a node's way up from its last leaf ends where the node that follows has it as an operand, so the
    // ways climbed from all leaves together are as long as the tree has nodes.
    let mut lowest: Vec<TreeNodeId> = Vec::with_capacity(leaves.len());
    for pair in leaves.windows(2) {
        let next_leaf = nodes[pair[1].index()].first_leaf;
        let mut node = pair[0];
        while nodes[node.index()].end_leaf <= next_leaf {
            node = parents[node.index()];
        }
        lowest.push(node);
    }
    let mut levels = vec![lowest];
    let mut width = 1;
    while let Some(last) = levels.last().filter(|last| last.len() > width) {
        let next = (0..last.len() - width).map(|k| shallower(nodes, last[k], last[k + width])).collect();
        levels.push(next);
        width *= 2;
    }
    levels
}
