//! Edits of the tree: where brushes and operations are, and what they do.

use rustc_hash::FxHashSet;

use super::{LiveTree, NodeId, NodeState, OrderKey, Place, Room, TreeOperand};
use crate::live::history::States;
use crate::live::operand::Role;
use crate::live::{BrushId, Change, EditError, LiveModel};
use crate::model::Operation;

impl LiveTree {
    /// Numbers for operations to come.
    pub(in crate::live) fn new_nodes(&self) -> impl Iterator<Item = NodeId> + use<> {
        (self.next_node..).map(NodeId)
    }
}

impl LiveModel {
    /// Gives a brush or an operation another role. Only parts of the model itself have one.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::UnknownNode`], [`EditError::Nested`], [`EditError::Evaluate`].
    pub fn set_role(&mut self, operand: impl Into<TreeOperand>, role: Role) -> Result<Change, EditError> {
        let operand = operand.into();
        let place = self.place_of(operand)?;
        if place.parent.is_some() {
            return Err(EditError::Nested(operand));
        }
        let mut new = States::default();
        new.set_place(self, operand, place)?;
        new.set_role(operand, role);
        self.edit(new)
    }

    /// Makes another operation of an operation, on the same operands.
    ///
    /// # Errors
    /// [`EditError::UnknownNode`], [`EditError::Evaluate`].
    pub fn set_operation(&mut self, node: NodeId, operation: Operation) -> Result<Change, EditError> {
        let state = NodeState { operation, ..self.node_state(node)? };
        let mut new = States::default();
        new.nodes.insert(node, Some(state));
        self.edit(new)
    }

    /// Makes a brush or an operation an operand of an operation, or a part of the model itself, before one of the operands there or behind all of them. What it was before gets no other operand in
    /// its place: of a difference whose first operand goes, the second one becomes the first. As a part of the model it has the role that it last had, at first [`Role::Add`].
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::UnknownNode`], [`EditError::NotAnOperand`], [`EditError::WithinItself`], [`EditError::Evaluate`].
    pub fn move_operand(
        &mut self,
        operand: impl Into<TreeOperand>,
        to: Option<NodeId>,
        before: Option<TreeOperand>,
    ) -> Result<Change, EditError> {
        let operand = operand.into();
        let old = self.place_of(operand)?;
        let mut above = to;
        while let Some(node) = above {
            if operand == TreeOperand::Node(node) {
                return Err(EditError::WithinItself(node));
            }
            above = self.node_state(node)?.place.parent;
        }
        // it stands there already
        if old.parent == to && (before == Some(operand) || before == self.next_operand(old)) {
            let mut same = States::default();
            same.set_place(self, operand, old)?;
            return self.edit(same);
        }
        let leaving = FxHashSet::from_iter([operand]);
        let (_, change) = self.edit_in_order(|model| {
            let places = model.places_before(to, before, &leaving, 1, Room::Behind)?;
            let new = |places: Vec<Place>| {
                let mut new = States::default();
                new.set_place(model, operand, places[0])?;
                Ok(((), new))
            };
            places.map(new).map_or_else(|none| Ok(Err(none)), |new| new.map(Ok))
        })?;
        Ok(change)
    }

    /// Moves a brush before another one, to where that one is; without another one behind all others where it is.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Evaluate`].
    pub fn move_brush_before(&mut self, id: BrushId, before: Option<BrushId>) -> Result<Change, EditError> {
        let to = self.state(before.unwrap_or(id))?.place.parent;
        self.move_operand(id, to, before.map(TreeOperand::Brush))
    }

    /// Makes operands of one operation, or parts of the model, those of a new operation, in their order; it takes the place, and the role, of the first of them. Gives its number.
    ///
    /// # Errors
    /// [`EditError::NoOperands`], [`EditError::Twice`], [`EditError::Apart`], [`EditError::UnknownBrush`], [`EditError::UnknownNode`], [`EditError::Evaluate`].
    pub fn wrap(&mut self, operands: &[TreeOperand], operation: Operation) -> Result<(NodeId, Change), EditError> {
        let mut sorted: Vec<(Place, TreeOperand)> = Vec::with_capacity(operands.len());
        for operand in operands {
            sorted.push((self.place_of(*operand)?, *operand));
        }
        sorted.sort_unstable();
        let (place, first) = *sorted.first().ok_or(EditError::NoOperands)?;
        for pair in sorted.windows(2) {
            let [(p, a), (q, b)] = [pair[0], pair[1]];
            if p == q {
                return Err(EditError::Twice(a));
            }
            if p.parent != q.parent {
                return Err(EditError::Apart([a, b]));
            }
        }
        let node = NodeId(self.tree.next_node);
        let mut new = States::default();
        for (index, (_, operand)) in sorted.iter().enumerate() {
            new.set_place(self, *operand, Place { parent: Some(node), key: OrderKey::of_index(index) })?;
        }
        new.nodes.insert(node, Some(NodeState { operation, role: self.role_of(first)?, place }));
        Ok((node, self.edit(new)?))
    }

    /// Puts the operands of an operation in its place. As parts of the model itself the first of them has its role; the others of a difference are subtracted, those of an intersection
    /// intersected, and all others have its role, too. So the solid stays the same where the operation is a union that is added or subtracted, or the first part of the model and added.
    ///
    /// # Errors
    /// [`EditError::UnknownNode`], [`EditError::Evaluate`].
    pub fn dissolve(&mut self, node: NodeId) -> Result<Change, EditError> {
        let NodeState { operation, role, place } = self.node_state(node)?;
        let leaving = FxHashSet::from_iter([TreeOperand::Node(node)]);
        let others = match operation {
            Operation::Difference => Role::Subtract,
            Operation::Intersection => Role::Intersect,
            Operation::Union | Operation::Xor | Operation::Complement => role,
        };
        let (_, change) = self.edit_in_order(|model| {
            let operands: Vec<TreeOperand> = model.tree.operands(Some(node)).map(|(_, operand)| operand).collect();
            let next = model.next_operand(model.node_state(node)?.place);
            let places = match model.places_before(place.parent, next, &leaving, operands.len(), Room::Behind)? {
                Ok(places) => places,
                Err(none) => return Ok(Err(none)),
            };
            let mut new = States::default();
            for (index, (operand, to)) in operands.into_iter().zip(places).enumerate() {
                new.set_place(model, operand, to)?;
                if to.parent.is_none() {
                    new.set_role(operand, if index == 0 { role } else { others });
                }
            }
            new.nodes.insert(node, None);
            Ok(Ok(((), new)))
        })?;
        Ok(change)
    }

    /// Takes an operation out with all brushes and operations below it. As of a brush, in its place stays nothing.
    ///
    /// # Errors
    /// [`EditError::UnknownNode`], [`EditError::Evaluate`].
    pub fn remove_node(&mut self, node: NodeId) -> Result<Change, EditError> {
        let place = self.node_state(node)?.place;
        let mut new = States::default();
        new.brushes.extend(self.tree.leaves(node).into_iter().map(|brush| (brush, None)));
        new.nodes.extend(self.tree.nodes_below(node).into_iter().map(|node| (node, None)));
        self.leave_nothing(place, &mut new);
        self.edit(new)
    }

    /// Puts an operation on nothing where an operand goes that is needed.
    pub(in crate::live) fn leave_nothing(&self, place: Place, new: &mut States) {
        if self.tree.is_needed(place) {
            let nothing = NodeState { operation: Operation::Union, role: Role::Add, place };
            new.nodes.insert(NodeId(self.tree.next_node), Some(nothing));
        }
    }

    fn role_of(&self, operand: TreeOperand) -> Result<Role, EditError> {
        match operand {
            TreeOperand::Brush(id) => Ok(self.state(id)?.role),
            TreeOperand::Node(id) => Ok(self.node_state(id)?.role),
        }
    }
}
