//! Several edits as one step for undo and redo: what a user does as one thing, or the many moves of a drag.

use std::collections::BTreeMap;

use super::history::{States, Step};
use super::{Change, EditError, LiveModel};

/// What the edits of an open step have changed: each brush and operation before the first of them and after the last, however many there are.
#[derive(Clone, Default)]
pub(super) struct OpenStep {
    before: States,
    after: States,
}

impl OpenStep {
    /// Takes an edit in.
    pub(super) fn add(&mut self, before: States, after: States) {
        keep_first(&mut self.before.brushes, before.brushes);
        keep_first(&mut self.before.nodes, before.nodes);
        self.after.brushes.extend(after.brushes);
        self.after.nodes.extend(after.nodes);
    }

    /// The step, without what is as it was before.
    fn to_step(&self) -> Step {
        let mut step = Step { before: self.before.clone(), after: self.after.clone() };
        let Step { before, after } = &mut step;
        before.brushes.retain(|id, before| match (before, &after.brushes[id]) {
            (Some(before), Some(after)) => !before.is_same(after),
            (before, after) => before.is_some() || after.is_some(),
        });
        before.nodes.retain(|id, before| *before != after.nodes[id]);
        after.brushes.retain(|id, _| before.brushes.contains_key(id));
        after.nodes.retain(|id, _| before.nodes.contains_key(id));
        step
    }
}

fn keep_first<K: Ord, V>(known: &mut BTreeMap<K, V>, new: BTreeMap<K, V>) {
    for (id, state) in new {
        known.entry(id).or_insert(state);
    }
}

impl LiveModel {
    /// Opens a step: all edits until [`commit_step`](Self::commit_step) are one for [`undo`](Self::undo) and [`redo`](Self::redo). Each is visible at
    /// once, and the history does not grow with their number: a drag is a step of many moves.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// let block = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0));
    /// let (block, _) = model.add_brush(block, Role::Add)?;
    /// model.begin_step()?;
    /// for x in 2..100 {
    ///     model.move_plane(block, PlaneIdx(0), HalfSpace::new(DVec3::X, f64::from(x))?)?;
    /// }
    /// assert!(model.commit_step()?);
    /// assert_eq!(model.history_len(), (2, 0));
    /// model.undo()?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`EditError::StepOpen`]: steps do not nest.
    pub fn begin_step(&mut self) -> Result<(), EditError> {
        if self.history.open.is_some() {
            return Err(EditError::StepOpen);
        }
        self.history.open = Some(OpenStep::default());
        Ok(())
    }

    /// Ends the open step; whether it is one for [`undo`](Self::undo). It is none where its edits have changed nothing in the end: then what was undone can still be redone.
    ///
    /// # Errors
    /// [`EditError::NoStep`].
    pub fn commit_step(&mut self) -> Result<bool, EditError> {
        let step = self.history.open.take().ok_or(EditError::NoStep)?.to_step();
        let is_step = step.before != States::default();
        if is_step {
            self.history.push(step);
        }
        Ok(is_step)
    }

    /// Ends the open step and takes its edits back. What could be undone and redone before it can be so again; numbers of brushes and planes that it gave are
    /// not given again.
    ///
    /// # Errors
    /// [`EditError::NoStep`].
    pub fn cancel_step(&mut self) -> Result<Change, EditError> {
        let before = self.history.open.as_ref().ok_or(EditError::NoStep)?.to_step().before;
        let change = self.go_to(&before)?;
        self.history.open = None;
        Ok(change)
    }

    /// Whether a step is open.
    #[must_use]
    pub fn is_step_open(&self) -> bool {
        self.history.open.is_some()
    }
}
