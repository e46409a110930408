//! How the brushes of a live model are combined, as a tree, and states in their order.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::history::{New, States};
use super::operand::State;
use super::tree::{Placed, TreeOperand};
use super::{BrushId, Change, EditError, LiveModel};
use crate::evaluate::EvaluateError;
use crate::model::{Model, Tree};

impl LiveModel {
    /// Gives brushes and operations other states; gives the ones before.
    ///
    /// # Errors
    /// Where the boundary of what they come to cannot be had: then all is as it was. [`EvaluateError::Weld`]: a bug in this crate.
    pub(super) fn change(&mut self, new: States) -> Result<(Change, States), EditError> {
        let States { brushes, nodes } = new;
        let before = nodes.keys().map(|id| (*id, self.tree.node(*id))).collect();
        let brush = |(id, new): (&BrushId, &Option<Arc<State>>)| Placed {
            operand: TreeOperand::Brush(*id),
            old: self.state(*id).ok().map(|state| state.spot()),
            new: new.as_ref().map(|state| state.spot()),
        };
        let of_nodes = nodes.iter().map(|(id, new)| Placed {
            operand: TreeOperand::Node(*id),
            old: self.tree.node(*id).map(|state| state.spot()),
            new: new.as_ref().map(|state| state.spot()),
        });
        let placed: Vec<Placed> =
            brushes.iter().map(brush).chain(of_nodes).filter(|placed| placed.old != placed.new).collect();
        let is_beginning = self.by_id.is_empty() && !self.tree.is_nested();
        let extent = if is_beginning { self.tree.begin_with(&placed) } else { self.tree.apply(&placed) };
        let outcome = match self.tree.is_unbounded() {
            true => Err(EvaluateError::Unbounded.into()),
            false => self.change_brushes(brushes.into_iter().collect(), &extent),
        };
        match outcome {
            Ok((change, brushes)) => Ok((change, States { brushes: brushes.into_iter().collect(), nodes: before })),
            Err(error) => {
                let back: Vec<Placed> = placed.into_iter().map(Placed::reversed).collect();
                self.tree.apply(&back);
                Err(error)
            }
        }
    }

    /// The model as a tree, once some brushes have other states; the tree has them already.
    pub(super) fn model_after(&self, new: &[New]) -> Model {
        let changed: BTreeMap<BrushId, &State> =
            new.iter().filter_map(|(id, state)| Some((*id, state.as_deref()?))).collect();
        let state = |id: BrushId| -> &State {
            let known = changed.get(&id).copied();
            known.or_else(|| self.state(id).ok().map(|state| &**state)).expect("a brush of the tree has a state")
        };
        let (nodes, leaves) = self.tree.whole(|id| state(id).role);
        let brushes = leaves.iter().map(|id| state(*id).brush.clone()).collect();
        let lines = leaves.iter().map(|id| state(*id).line).collect();
        Model { materials: self.materials.clone(), tree: Tree::of_parts(brushes, nodes).with_source_lines(lines) }
    }
}
