//! Brushes of a live model that are closed meshes.
//!
//! As long as there is one, the boundary is that of the model as a tree, evaluated again by each edit. What is kept for edits of
//! convex brushes is kept up all the time, with nothing in the place of each mesh: when the last mesh goes, it is all there.

use super::evaluated::EvaluatedBoundary;
use super::history::New;
use super::tree::Extent;
use super::{Change, EditError, LiveModel};
use crate::evaluate::evaluate_built;
use crate::ids::FaceId;

impl LiveModel {
    /// Gives brushes other states, in a tree that is already another; gives the ones before.
    ///
    /// # Errors
    /// Where the boundary of what they come to cannot be had: then all is as it was. [`EvaluateError::Weld`](crate::EvaluateError::Weld): a bug
    /// in this crate.
    pub(super) fn change_brushes(&mut self, new: Vec<New>, extent: &Extent) -> Result<(Change, Vec<New>), EditError> {
        let (change, before) = self.change_boundary(new, extent)?;
        self.measured.note(&change.removed, &change.added);
        Ok((change, before))
    }

    fn change_boundary(&mut self, new: Vec<New>, extent: &Extent) -> Result<(Change, Vec<New>), EditError> {
        let meshes = self.meshes_after(&new);
        if meshes == 0 && self.evaluated.is_none() {
            return self.change_convex(new, extent);
        }
        let mesh = match meshes {
            0 => None,
            _ => Some(evaluate_built(&self.model_after(&new), self.unbounded, &self.built)?.mesh),
        };
        let before = match &self.evaluated {
            Some(evaluated) => evaluated.ids().to_vec(),
            None => self.welded_faces(),
        };
        let (change, states) = self.change_convex(new, extent)?;
        self.meshes = meshes;
        let (removed, added) = match (self.evaluated.take(), mesh) {
            (Some(old), Some(mesh)) => {
                let (evaluated, removed, added) = old.replaced_by(mesh);
                self.evaluated = Some(evaluated);
                (removed, added)
            }
            (None, Some(mesh)) => {
                let (evaluated, _, added) = EvaluatedBoundary::default().replaced_by(mesh);
                self.evaluated = Some(evaluated);
                (before, added)
            }
            (_, None) => (before, self.welded_faces()),
        };
        Ok((Change { brushes: change.brushes, removed, added }, states))
    }

    /// How many brushes are meshes once some have other states.
    fn meshes_after(&self, new: &[New]) -> usize {
        let is_mesh_now = |(id, _): &&New| self.state(*id).is_ok_and(|state| state.brush.is_mesh());
        let is_mesh_then = |(_, state): &&New| state.as_ref().is_some_and(|state| state.brush.is_mesh());
        self.meshes + new.iter().filter(is_mesh_then).count() - new.iter().filter(is_mesh_now).count()
    }

    fn welded_faces(&self) -> Vec<FaceId> {
        self.welded.faces().map(|(id, _)| id).collect()
    }
}
