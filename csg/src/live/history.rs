//! Undo and redo of edits.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use super::operand::{Role, State};
use super::step::OpenStep;
use super::tree::{NodeId, NodeState, Place, TreeOperand};
use super::{BrushId, Change, EditError, LiveModel};
use crate::ids::Id;

/// A brush as it is to be; nothing where it is not to be there.
pub(super) type New = (BrushId, Option<Arc<State>>);

/// Brushes and operations as they are to be, or were; nothing where one is not to be there, or was not.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct States {
    pub(super) brushes: BTreeMap<BrushId, Option<Arc<State>>>,
    pub(super) nodes: BTreeMap<NodeId, Option<NodeState>>,
}

impl States {
    /// A brush as it is to be.
    pub(super) fn of_brush(id: BrushId, state: Option<Arc<State>>) -> Self {
        Self { brushes: BTreeMap::from([(id, state)]), ..Self::default() }
    }

    /// An operand elsewhere.
    pub(super) fn set_place(&mut self, model: &LiveModel, operand: TreeOperand, place: Place) -> Result<(), EditError> {
        match operand {
            TreeOperand::Brush(id) => {
                let state = State { place, ..State::clone(model.state(id)?) };
                self.brushes.insert(id, Some(Arc::new(state)));
            }
            TreeOperand::Node(id) => {
                self.nodes.insert(id, Some(NodeState { place, ..model.node_state(id)? }));
            }
        }
        Ok(())
    }

    /// Gives one that is to be there another role.
    pub(super) fn set_role(&mut self, operand: TreeOperand, role: Role) {
        match operand {
            TreeOperand::Brush(id) => {
                if let Some(Some(state)) = self.brushes.get_mut(&id) {
                    Arc::make_mut(state).role = role;
                }
            }
            TreeOperand::Node(id) => {
                if let Some(Some(state)) = self.nodes.get_mut(&id) {
                    state.role = role;
                }
            }
        }
    }
}

/// Number of edits that can be undone unless another number is set.
const LIMIT: usize = 1000;

/// What edits have changed, the last one last.
#[derive(Clone)]
pub(super) struct History {
    done: VecDeque<Step>,
    undone: Vec<Step>,
    limit: usize,
    /// The step that edits are part of, while one is open.
    pub(super) open: Option<OpenStep>,
}

/// The brushes and operations that an edit has changed, before and after it.
#[derive(Clone)]
pub(super) struct Step {
    pub(super) before: States,
    pub(super) after: States,
}

impl Default for History {
    fn default() -> Self {
        Self { done: VecDeque::new(), undone: Vec::new(), limit: LIMIT, open: None }
    }
}

impl History {
    /// Notes an edit, of the open step where there is one.
    pub(super) fn note(&mut self, before: States, after: States) {
        match &mut self.open {
            Some(open) => open.add(before, after),
            None => self.push(Step { before, after }),
        }
    }

    /// Adds a step; what was undone cannot be redone after it.
    pub(super) fn push(&mut self, step: Step) {
        self.undone.clear();
        self.done.push_back(step);
        self.shorten();
    }

    fn refuse_in_step(&self) -> Result<(), EditError> {
        if self.open.is_some() { Err(EditError::StepOpen) } else { Ok(()) }
    }

    fn shorten(&mut self) {
        let surplus = self.done.len().saturating_sub(self.limit);
        self.done.drain(..surplus);
    }
}

impl LiveModel {
    /// Undoes the last edit or [step](Self::begin_step) that is not yet undone. Brushes, planes and operations have the numbers again that they had.
    ///
    /// # Errors
    /// [`EditError::NothingToUndo`], [`EditError::StepOpen`].
    pub fn undo(&mut self) -> Result<Change, EditError> {
        self.history.refuse_in_step()?;
        let mut step = self.history.done.pop_back().ok_or(EditError::NothingToUndo)?;
        self.keep_handles(&step.before, &mut step.after);
        let outcome = self.go_to(&step.before);
        match outcome {
            Ok(_) => self.history.undone.push(step),
            Err(_) => self.history.done.push_back(step),
        }
        outcome
    }

    /// Redoes the edit or step that was last undone.
    ///
    /// # Errors
    /// [`EditError::NothingToRedo`], [`EditError::StepOpen`].
    pub fn redo(&mut self) -> Result<Change, EditError> {
        self.history.refuse_in_step()?;
        let mut step = self.history.undone.pop().ok_or(EditError::NothingToRedo)?;
        self.keep_handles(&step.after, &mut step.before);
        let outcome = self.go_to(&step.after);
        match outcome {
            Ok(_) => self.history.done.push_back(step),
            Err(_) => self.history.undone.push(step),
        }
        outcome
    }

    /// How many edits and steps can be undone, and how many redone.
    #[must_use]
    pub fn history_len(&self) -> (usize, usize) {
        (self.history.done.len(), self.history.undone.len())
    }

    /// Maximum number of edits and steps that can be undone, 1,000 unless another number is set: a model that is edited for long does not
    /// grow.
    pub fn set_history_limit(&mut self, limit: usize) {
        self.history.limit = limit;
        self.history.shorten();
    }

    /// Brushes that are there now and not in the states to come have given handles of planes since they were in the states to
    /// come back to: those are not given again.
    fn keep_handles(&self, to_come: &States, to_come_back: &mut States) {
        for (id, coming) in &to_come.brushes {
            let state = to_come_back.brushes.get_mut(id).and_then(Option::as_mut);
            if let (None, Some(state), Some(number)) = (coming, state, self.by_id.get(id)) {
                let next_plane = self.operand(*number).state.next_plane;
                if state.next_plane < next_plane {
                    Arc::make_mut(state).next_plane = next_plane;
                }
            }
        }
    }

    pub(super) fn go_to(&mut self, states: &States) -> Result<Change, EditError> {
        let again = |(id, state): (&BrushId, &Option<Arc<State>>)| {
            let known = self.by_id.get(id).and_then(|number| self.operands[number.index()].as_ref());
            let next_plane = known.map_or(0, |operand| operand.state.next_plane);
            // no handle of a plane is given twice
            let state = state.as_ref().map(|state| match state.next_plane < next_plane {
                true => Arc::new(State { next_plane, ..State::clone(state) }),
                false => Arc::clone(state),
            });
            (*id, state)
        };
        let brushes = states.brushes.iter().map(again).collect();
        Ok(self.change(States { brushes, nodes: states.nodes.clone() })?.0)
    }
}
