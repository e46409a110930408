//! Undo and redo of edits.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use super::operand::State;
use super::{BrushId, Change, EditError, LiveModel};
use crate::ids::Id;

/// A brush as it is to be; nothing where it is not to be there.
pub(super) type New = (BrushId, Option<Arc<State>>);

/// Number of edits that can be undone unless another number is set.
const LIMIT: usize = 1000;

/// What edits have changed, the last one last.
pub(super) struct History {
    done: VecDeque<Step>,
    undone: Vec<Step>,
    limit: usize,
}

/// The brushes that an edit has changed, before and after it.
struct Step {
    before: Vec<New>,
    after: Vec<New>,
}

impl Default for History {
    fn default() -> Self {
        Self { done: VecDeque::new(), undone: Vec::new(), limit: LIMIT }
    }
}

impl History {
    /// Notes an edit; what was undone cannot be redone after it.
    pub(super) fn note(&mut self, before: Vec<New>, after: Vec<New>) {
        self.undone.clear();
        self.done.push_back(Step { before, after });
        self.shorten();
    }

    fn shorten(&mut self) {
        let surplus = self.done.len().saturating_sub(self.limit);
        self.done.drain(..surplus);
    }
}

impl LiveModel {
    /// Undoes the last edit that is not yet undone. Brushes and planes have the numbers again that they had.
    ///
    /// # Errors
    /// [`EditError::NothingToUndo`].
    pub fn undo(&mut self) -> Result<Change, EditError> {
        let mut step = self.history.done.pop_back().ok_or(EditError::NothingToUndo)?;
        self.keep_handles(&step.before, &mut step.after);
        let outcome = self.go_to(&step.before);
        match outcome {
            Ok(_) => self.history.undone.push(step),
            Err(_) => self.history.done.push_back(step),
        }
        outcome
    }

    /// Redoes the edit that was last undone.
    ///
    /// # Errors
    /// [`EditError::NothingToRedo`].
    pub fn redo(&mut self) -> Result<Change, EditError> {
        let mut step = self.history.undone.pop().ok_or(EditError::NothingToRedo)?;
        self.keep_handles(&step.after, &mut step.before);
        let outcome = self.go_to(&step.after);
        match outcome {
            Ok(_) => self.history.done.push_back(step),
            Err(_) => self.history.undone.push(step),
        }
        outcome
    }

    /// Makes one edit of the last `count` ones, for [`undo`](Self::undo) and [`redo`](Self::redo): what a user does as one thing may take several calls. Edits that
    /// can no longer be undone stay so.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EditError> {
    /// let cube = |at: f64| Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 1.0), MaterialId(0));
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// model.add_brush(cube(0.0), Role::Add)?;
    /// model.add_brush(cube(2.0), Role::Add)?;
    /// model.join_edits(2);
    /// model.undo()?;
    /// assert_eq!(model.brushes().len(), 0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn join_edits(&mut self, count: usize) {
        let done = &mut self.history.done;
        if count < 2 || done.len() < 2 {
            return;
        }
        let mut brushes: BTreeMap<BrushId, [Option<Arc<State>>; 2]> = BTreeMap::new();
        for Step { before, after } in done.drain(done.len().saturating_sub(count)..) {
            for ((id, before), (_, after)) in before.into_iter().zip(after) {
                brushes.entry(id).and_modify(|states| states[1].clone_from(&after)).or_insert([before, after]);
            }
        }
        // one that came and went again is none
        brushes.retain(|_, states| states.iter().any(Option::is_some));
        let (before, after) = brushes.into_iter().map(|(id, [before, after])| ((id, before), (id, after))).unzip();
        done.push_back(Step { before, after });
    }

    /// Forgets what was undone: it cannot be redone.
    pub fn forget_undone(&mut self) {
        self.history.undone.clear();
    }

    /// Maximum number of edits that can be undone, 1,000 unless another number is set: a model that is edited for long does not
    /// grow.
    pub fn set_history_limit(&mut self, limit: usize) {
        self.history.limit = limit;
        self.history.shorten();
    }

    /// Brushes that are there now and not in the states to come have given handles of planes since they were in the states to
    /// come back to: those are not given again.
    fn keep_handles(&self, to_come: &[New], to_come_back: &mut [New]) {
        for ((id, coming), (_, state)) in to_come.iter().zip(to_come_back) {
            if let (None, Some(state), Some(number)) = (coming, state, self.by_id.get(id)) {
                let next_plane = self.operand(*number).state.next_plane;
                if state.next_plane < next_plane {
                    Arc::make_mut(state).next_plane = next_plane;
                }
            }
        }
    }

    fn go_to(&mut self, states: &[New]) -> Result<Change, EditError> {
        let again = |(id, state): &New| {
            let known = self.by_id.get(id).and_then(|number| self.operands[number.index()].as_ref());
            let next_plane = known.map_or(0, |operand| operand.state.next_plane);
            // no handle of a plane is given twice
            let state = state.as_ref().map(|state| match state.next_plane < next_plane {
                true => Arc::new(State { next_plane, ..State::clone(state) }),
                false => Arc::clone(state),
            });
            (*id, state)
        };
        let new = states.iter().map(again).collect();
        Ok(self.change(new)?.0)
    }
}
