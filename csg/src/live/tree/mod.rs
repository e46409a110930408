//! The tree of a live model: its brushes in order, each with a role, and operations on brushes and other operations.
//!
//! The model itself is a list of brushes and operations that are combined one after another. Each brush and each operation has a place: the
//! operation that it is an operand of, or the list of the model, and a key by which operands are in order. So an edit of the tree is an edit of the states of a few brushes and
//! operations, and is undone like any other.
//!
//! - [`edits`]: what users do to the tree; [`keys`]: places between others.
//! - [`placement`]: brushes and operations come, go and move, and how far that reaches.
//! - [`flat`]: operations written one after another, as the boundary needs them; [`read`]: the tree of a model to begin with.

mod edits;
mod flat;
mod keys;
mod placement;
mod read;

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use rustc_hash::FxHashMap;

use super::operand::{Role, State};
use super::{BrushId, EditError, LiveModel};
use crate::ids::OperandId;
use crate::model::Operation;
use flat::Subtree;
pub(super) use keys::{OrderKey, Planned, Room};
pub(super) use placement::{Extent, Placed, Spot};
pub(super) use read::{Read, read};

/// An operation of the tree of a [`LiveModel`]: operations are numbered from 0 as they are added, and no number is given twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u64);

/// What an operation of the tree of a [`LiveModel`] is done to, or the model consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TreeOperand {
    /// A brush.
    Brush(BrushId),
    /// What another operation makes of its own operands.
    Node(NodeId),
}

impl From<BrushId> for TreeOperand {
    fn from(id: BrushId) -> Self {
        Self::Brush(id)
    }
}

impl From<NodeId> for TreeOperand {
    fn from(id: NodeId) -> Self {
        Self::Node(id)
    }
}

impl std::fmt::Display for TreeOperand {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Brush(id) => write!(out, "brush {}", id.0),
            Self::Node(id) => write!(out, "node {}", id.0),
        }
    }
}

/// Where a brush or an operation is in the tree: the operation that it is an operand of, none for the model itself, and its place among the operands of that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Place {
    pub(super) parent: Option<NodeId>,
    pub(super) key: OrderKey,
}

/// All that the user has said of an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NodeState {
    pub(super) operation: Operation,
    /// What it does as a part of the model itself.
    pub(super) role: Role,
    pub(super) place: Place,
}

/// Where a brush comes in the order of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Position {
    /// The key of the brush, or of the operation above it, in the list of the model.
    top: OrderKey,
    /// Its place among the leaves of that operation; [`ALONE`](Self::ALONE) for a brush in the list.
    leaf: u32,
}

impl Position {
    const ALONE: u32 = u32::MAX;
}

/// A brush by its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Member {
    pub(super) at: Position,
    pub(super) operand: OperandId,
}

/// The tree, but for what is said of brushes.
#[derive(Clone, Default)]
pub(super) struct LiveTree {
    operands: BTreeMap<Place, TreeOperand>,
    nodes: BTreeMap<NodeId, Node>,
    next_node: u64,
    /// What each operation in the list of the model is, by its key there.
    subtrees: BTreeMap<OrderKey, Subtree>,
    /// Where brushes are that are below operations.
    positions: FxHashMap<BrushId, Position>,
    /// The keys in the list of the model after which it is known what lies far from all brushes, whatever came before: nothing or everything.
    barriers: BTreeMap<OrderKey, bool>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    state: NodeState,
    /// Its value far from all brushes.
    far: bool,
}

impl LiveTree {
    /// The operands of an operation, or of the model, in their order.
    pub(super) fn operands(
        &self,
        parent: Option<NodeId>,
    ) -> impl DoubleEndedIterator<Item = (OrderKey, TreeOperand)> + '_ {
        self.operands_in(parent, OrderKey::FIRST..=OrderKey::LAST)
    }

    /// Those of them whose keys are in a range.
    fn operands_in(
        &self,
        parent: Option<NodeId>,
        keys: RangeInclusive<OrderKey>,
    ) -> impl DoubleEndedIterator<Item = (OrderKey, TreeOperand)> + '_ {
        let [first, last] = [*keys.start(), *keys.end()].map(|key| Place { parent, key });
        self.operands.range(first..=last).map(|(place, operand)| (place.key, *operand))
    }

    pub(super) fn node(&self, id: NodeId) -> Option<NodeState> {
        self.nodes.get(&id).map(|node| node.state)
    }

    /// Whether there are operations.
    pub(super) fn is_nested(&self) -> bool {
        !self.nodes.is_empty()
    }

    /// Whether what is far from all brushes is part of the solid.
    pub(super) fn is_unbounded(&self) -> bool {
        self.barriers.last_key_value().is_some_and(|(_, is_full)| *is_full)
    }

    /// Where a brush comes in the order of all.
    pub(super) fn position(&self, id: BrushId, place: Place) -> Position {
        match place.parent {
            None => Position { top: place.key, leaf: Position::ALONE },
            Some(_) => self.positions[&id],
        }
    }

    /// Whether an operand is the first one of its operation.
    fn is_first(&self, place: Place) -> bool {
        self.operands(place.parent).next().is_some_and(|(key, _)| key == place.key)
    }

    /// Whether it matters that there is an operand at a place, even if it is nothing.
    pub(super) fn is_needed(&self, place: Place) -> bool {
        let operation = place.parent.and_then(|parent| self.node(parent)).map(|parent| parent.operation);
        match operation {
            Some(Operation::Intersection) => true,
            Some(Operation::Difference) => self.is_first(place),
            _ => false,
        }
    }

    /// Whether what an operand of a role adds is taken away from the solid, as far as that can be told.
    pub(super) fn takes_away(&self, mut place: Place, mut role: Role) -> bool {
        let mut takes = false;
        while let Some(parent) = place.parent.and_then(|parent| self.node(parent)) {
            takes ^= match parent.operation {
                Operation::Difference => !self.is_first(place),
                Operation::Complement => true,
                Operation::Union | Operation::Intersection | Operation::Xor => false,
            };
            (place, role) = (parent.place, parent.role);
        }
        takes != (role == Role::Subtract)
    }
}

/// An operation of a live model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LiveNode {
    /// What it does with its operands.
    pub operation: Operation,
    /// What it does as a part of the model itself; says nothing for an operand of another operation.
    pub role: Role,
    /// The operation that it is an operand of; `None` for a part of the model itself.
    pub parent: Option<NodeId>,
}

impl LiveModel {
    /// The operands of an operation in their order; of `None` the parts of the model itself, which are combined one after another by their roles.
    ///
    /// # Errors
    /// [`EditError::UnknownNode`].
    pub fn operands(&self, of: Option<NodeId>) -> Result<impl Iterator<Item = TreeOperand> + '_, EditError> {
        of.map_or(Ok(()), |node| self.node(node).map(|_| ()))?;
        Ok(self.tree.operands(of).map(|(_, operand)| operand))
    }

    /// The operations, ascending by number.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.tree.nodes.keys().copied()
    }

    /// An operation.
    ///
    /// # Errors
    /// [`EditError::UnknownNode`].
    pub fn node(&self, id: NodeId) -> Result<LiveNode, EditError> {
        let NodeState { operation, role, place } = self.node_state(id)?;
        Ok(LiveNode { operation, role, parent: place.parent })
    }

    /// The operation that a brush or an operation is an operand of; `None` for a part of the model itself.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::UnknownNode`].
    pub fn parent(&self, operand: impl Into<TreeOperand>) -> Result<Option<NodeId>, EditError> {
        Ok(self.place_of(operand.into())?.parent)
    }

    pub(super) fn node_state(&self, id: NodeId) -> Result<NodeState, EditError> {
        self.tree.node(id).ok_or(EditError::UnknownNode(id))
    }

    pub(super) fn place_of(&self, operand: TreeOperand) -> Result<Place, EditError> {
        match operand {
            TreeOperand::Brush(id) => Ok(self.state(id)?.place),
            TreeOperand::Node(id) => Ok(self.node_state(id)?.place),
        }
    }

    /// Where a brush that is there comes in the order of all.
    pub(super) fn position(&self, number: OperandId) -> Position {
        let operand = self.operand(number);
        self.tree.position(operand.id, operand.state.place)
    }
}

impl State {
    pub(super) fn spot(&self) -> Spot {
        Spot { place: self.place, role: self.role, operation: None }
    }
}

impl NodeState {
    pub(super) fn spot(&self) -> Spot {
        Spot { place: self.place, role: self.role, operation: Some(self.operation) }
    }
}
