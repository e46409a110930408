//! Brushes and operations come, go and move in the tree, and how far that reaches.
//!
//! Outside of a brush its value is 0, and outside of all brushes below an operation its value is a constant. So where something changes below an operation, and
//! the operation does with its other operands what it did as long as what has changed is at its constant, all stays as it was outside of the brushes that belong to what has changed.
//! Otherwise all brushes of that part of the model are affected. Outside of those, too, all stays as it was unless the constant of the part itself is another one and matters.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::{LiveTree, Node, NodeId, NodeState, OrderKey, Place, TreeOperand};
use crate::live::BrushId;
use crate::live::operand::Role;
use crate::model::Operation;

/// Number of operations that change from which all brushes of their parts of the model count as affected.
const MANY_NODES: usize = 8;

/// Where a brush or an operation is, and what it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::live) struct Spot {
    pub(in crate::live) place: Place,
    pub(in crate::live) role: Role,
    /// None of a brush.
    pub(in crate::live) operation: Option<Operation>,
}

/// A brush or an operation that comes, goes or moves: where it was, and where it is to be.
#[derive(Debug, Clone, Copy)]
pub(in crate::live) struct Placed {
    pub(in crate::live) operand: TreeOperand,
    pub(in crate::live) old: Option<Spot>,
    pub(in crate::live) new: Option<Spot>,
}

impl Placed {
    pub(in crate::live) fn reversed(self) -> Self {
        Self { old: self.new, new: self.old, ..self }
    }
}

/// How far changes of the tree reach.
#[derive(Debug, Clone, Default)]
pub(in crate::live) struct Extent {
    /// Whether to everything.
    pub(in crate::live) is_everywhere: bool,
    /// Whether nothing but brushes came, after all that was there, which do not intersect.
    pub(in crate::live) is_appended: bool,
    /// The brushes beside those that have changed themselves where the solid may be another.
    pub(in crate::live) brushes: BTreeSet<BrushId>,
}

/// What an operation does, its operands that have changed being at their constants: without operands that then make no difference.
#[derive(PartialEq, Eq)]
struct Reduced {
    operation: Operation,
    operands: Vec<Result<TreeOperand, bool>>,
}

impl LiveTree {
    /// Moves, adds and removes brushes and operations.
    pub(in crate::live) fn apply(&mut self, changes: &[Placed]) -> Extent {
        let last = self.last_key(None);
        let is_appended = !changes.is_empty()
            && changes.iter().all(|change| {
                let is_simple = |spot: &Spot| {
                    spot.operation.is_none() && spot.place.parent.is_none() && spot.role != Role::Intersect
                };
                change.old.is_none()
                    && change.new.as_ref().is_some_and(|spot| is_simple(spot) && last < Some(spot.place.key))
            });
        if !is_appended && !changes.is_empty() {
            return self.apply_widely(changes);
        }
        self.put(changes);
        Extent { is_appended, ..Extent::default() }
    }

    fn apply_widely(&mut self, changes: &[Placed]) -> Extent {
        let mut extent = Extent::default();
        let changed: BTreeSet<TreeOperand> = changes.iter().map(|change| change.operand).collect();
        let spots = || changes.iter().flat_map(|change| [change.old, change.new]).flatten();
        let is_other = |node: &NodeId| !changed.contains(&TreeOperand::Node(*node));
        let parents: BTreeSet<NodeId> = spots().filter_map(|spot| spot.place.parent).filter(is_other).collect();
        let nodes: Vec<NodeId> = changed.iter().filter_map(|operand| node_of(*operand)).collect();
        let reduced = |tree: &Self| -> Vec<Option<Reduced>> {
            parents.iter().map(|parent| tree.reduced(*parent, &changed)).collect()
        };
        let leaves = |tree: &Self| -> Vec<BrushId> {
            let few = if nodes.len() < MANY_NODES { &nodes[..] } else { &[] };
            few.iter().filter(|node| tree.nodes.contains_key(node)).flat_map(|node| tree.leaves(*node)).collect()
        };
        let all_nodes = || parents.iter().copied().chain(nodes.iter().copied());
        let tops_before = self.tops(all_nodes());
        let (before, barriers) = (reduced(self), self.barriers_at(&tops_before, changes));
        extent.brushes.extend(leaves(self));
        let old_leaves: Vec<BrushId> = self.leaves_of(tops_before.values());
        self.put(changes);
        for top in tops_before.values() {
            self.subtrees.remove(top);
        }
        let tops = self.tops(all_nodes());
        let gone: BTreeSet<&OrderKey> = tops_before.values().chain(tops.values()).collect();
        for leaf in &old_leaves {
            self.positions.remove(leaf);
        }
        for top in gone {
            if let Some(TreeOperand::Node(root)) = self.operands.get(&Place { parent: None, key: *top }) {
                self.flatten(*top, *root);
            }
        }
        self.set_barriers(&tops_before, &tops, changes);
        extent.brushes.extend(leaves(self));
        let is_narrow = nodes.len() < MANY_NODES && before == reduced(self);
        if !is_narrow {
            extent.brushes.extend(old_leaves);
            extent.brushes.extend(self.leaves_of(tops.values()));
        }
        let tops = tops_before.into_iter().chain(tops).collect();
        extent.is_everywhere = barriers != self.barriers_at(&tops, changes);
        extent
    }

    /// Sets places and operations, and barriers of brushes; what depends on the places of others stays to be worked out.
    fn put(&mut self, changes: &[Placed]) {
        for old in changes.iter().filter_map(|change| change.old) {
            self.operands.remove(&old.place);
        }
        for Placed { operand, new, .. } in changes {
            if let Some(new) = new {
                self.operands.insert(new.place, *operand);
            }
            let TreeOperand::Node(id) = operand else { continue };
            match new {
                Some(Spot { place, role, operation: Some(operation) }) => {
                    self.next_node = self.next_node.max(id.0 + 1);
                    let state = NodeState { operation: *operation, role: *role, place: *place };
                    let far = self.nodes.get(id).is_some_and(|node| node.far);
                    self.nodes.insert(*id, Node { state, far });
                }
                _ => drop(self.nodes.remove(id)),
            }
        }
    }

    /// Makes the tree of brushes and operations to begin with.
    pub(in crate::live) fn begin_with(&mut self, operands: &[Placed]) -> Extent {
        self.put(operands);
        let tops: Vec<(OrderKey, TreeOperand)> = self.operands(None).collect();
        for (key, operand) in &tops {
            if let TreeOperand::Node(root) = operand {
                self.flatten(*key, *root);
            }
        }
        let nodes = tops.iter().filter_map(|(key, operand)| Some((node_of(*operand)?, *key))).collect();
        self.set_barriers(&BTreeMap::new(), &nodes, operands);
        Extent { is_everywhere: true, ..Extent::default() }
    }

    /// The key in the list of the model of each of some operations, or of the one above it, where it is there.
    fn tops(&self, nodes: impl Iterator<Item = NodeId>) -> BTreeMap<NodeId, OrderKey> {
        let mut known: FxHashMap<NodeId, OrderKey> = FxHashMap::default();
        let mut tops = BTreeMap::new();
        for node in nodes {
            let (mut way, mut at) = (Vec::new(), Some(node));
            let top = loop {
                let Some(id) = at else { break None };
                if let Some(top) = known.get(&id) {
                    break Some(*top);
                }
                let Some(Node { state, .. }) = self.nodes.get(&id) else { break None };
                way.push(id);
                if state.place.parent.is_none() {
                    break Some(state.place.key);
                }
                at = state.place.parent;
            };
            if let Some(top) = top {
                known.extend(way.into_iter().map(|id| (id, top)));
                tops.insert(node, top);
            }
        }
        tops
    }

    fn leaves_of<'a>(&self, tops: impl Iterator<Item = &'a OrderKey>) -> Vec<BrushId> {
        let tops: BTreeSet<&OrderKey> = tops.collect();
        tops.into_iter().filter_map(|top| self.subtrees.get(top)).flat_map(|subtree| subtree.leaves.clone()).collect()
    }

    /// What an operation that is there does.
    fn reduced(&self, node: NodeId, changed: &BTreeSet<TreeOperand>) -> Option<Reduced> {
        let operation = self.nodes.get(&node)?.state.operation;
        let mut operands = Vec::new();
        for (place, (_, operand)) in self.operands(Some(node)).enumerate() {
            let far = node_of(operand).is_some_and(|id| self.nodes[&id].far);
            let makes_none = match operation {
                Operation::Union | Operation::Xor | Operation::Complement => !far,
                Operation::Intersection => far,
                Operation::Difference => !far && place > 0,
            };
            match changed.contains(&operand) {
                true if makes_none => {}
                true => operands.push(Err(far)),
                false => operands.push(Ok(operand)),
            }
        }
        Some(Reduced { operation, operands })
    }

    /// The barriers among parts of the model.
    fn barriers_at(&self, tops: &BTreeMap<NodeId, OrderKey>, changes: &[Placed]) -> Vec<(OrderKey, bool)> {
        let keys = tops.values().copied().chain(keys_of_brushes(changes));
        let keys: BTreeSet<OrderKey> = keys.collect();
        keys.into_iter().filter_map(|key| Some((key, *self.barriers.get(&key)?))).collect()
    }

    fn set_barriers(
        &mut self,
        tops_before: &BTreeMap<NodeId, OrderKey>,
        tops: &BTreeMap<NodeId, OrderKey>,
        changes: &[Placed],
    ) {
        for key in tops_before.values().copied().chain(keys_of_brushes(changes)) {
            self.barriers.remove(&key);
        }
        for Placed { operand, new, .. } in changes {
            if let (TreeOperand::Brush(_), Some(Spot { place: Place { parent: None, key }, role, .. })) = (operand, new)
            {
                self.set_barrier(*key, *role, false);
            }
        }
        for key in tops.values() {
            if let Some(TreeOperand::Node(id)) = self.operands.get(&Place { parent: None, key: *key }) {
                let Node { state, far } = self.nodes[id];
                self.set_barrier(*key, state.role, far);
            }
        }
    }

    fn set_barrier(&mut self, key: OrderKey, role: Role, far: bool) {
        match (role, far) {
            (Role::Intersect, false) | (Role::Subtract, true) => drop(self.barriers.insert(key, false)),
            (Role::Add, true) => drop(self.barriers.insert(key, true)),
            _ => drop(self.barriers.remove(&key)),
        }
    }
}

/// The keys that brushes have and had in the list of the model.
fn keys_of_brushes(changes: &[Placed]) -> impl Iterator<Item = OrderKey> + '_ {
    let brushes = changes.iter().filter(|change| matches!(change.operand, TreeOperand::Brush(_)));
    let places = brushes.flat_map(|change| [change.old, change.new]).flatten().map(|spot| spot.place);
    places.filter(|place| place.parent.is_none()).map(|place| place.key)
}

fn node_of(operand: TreeOperand) -> Option<NodeId> {
    match operand {
        TreeOperand::Node(id) => Some(id),
        TreeOperand::Brush(_) => None,
    }
}
