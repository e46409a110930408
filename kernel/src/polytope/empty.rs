//! The empty state: a witness of at most four planes, and the planes that wait for its end.
//!
//! The structure stays as it was before the plane with which the set became empty. Planes that are added wait, and
//! planes of the structure are removed as always; only where the witness loses one of its planes, those that wait are
//! tried again.

use super::IncrementalPolytope;
use super::add::Insertion;
use super::store::PlaneState;
use crate::sign::Row;

impl IncrementalPolytope {
    /// Every vertex violates `plane`: keep the structure as it is without it and remember why.
    ///
    /// At the vertex that violates it least, the opposite normal is a non-negative combination of the three normals, so
    /// the three planes and this one have no interior in common (Farkas, Helly).
    pub(super) fn become_empty(&mut self, plane: u32) {
        let opposite: Row = self.row(plane).flipped();
        let bottom = self.climb(&opposite, self.start(&opposite));
        let [a, b, c] = self.vertices.planes(bottom);
        self.witness = [a, b, c, plane];
        self.planes.set_without_face(plane, PlaneState::Pending);
        if self.pending.first() != Some(&plane) {
            self.pending.insert(0, plane);
        }
    }

    /// Removes a plane that waits.
    pub(super) fn remove_pending(&mut self, plane: u32) {
        self.pending.retain(|waiting| *waiting != plane);
        self.planes.remove(plane);
        self.after_loss(&[plane]);
    }

    /// While the set is empty, planes were removed or moved: where the witness needed one, the waiting planes try
    /// again. What comes back is new, all of it.
    pub(super) fn after_loss(&mut self, planes: &[u32]) {
        if planes.iter().any(|plane| self.witness.contains(plane)) {
            self.wake_pending();
        }
        self.report_all_as_new();
    }

    /// The witness is broken: let the waiting planes take part, oldest first, until the set is empty again or all do.
    fn wake_pending(&mut self) {
        let waiting = std::mem::take(&mut self.pending);
        for (k, &plane) in waiting.iter().enumerate() {
            self.planes.set_without_face(plane, PlaneState::Uncertified);
            if self.insert_into_structure(plane) == Insertion::Empty {
                self.pending = waiting[k..].to_vec();
                self.become_empty(plane);
                return;
            }
        }
    }
}
