//! A fresh build of the planes that are there: handles and stamps stay, vertices are made again.
//!
//! It is used where most planes are removed at once, so that adding the others again is less work, and where a validation fails
//! (which should never happen).

use super::IncrementalPolytope;
use super::add::Insertion;
use super::store::{NONE, PlaneState, Steps};

impl IncrementalPolytope {
    /// Builds the structure again from the planes alone, in the order of their stamps.
    pub(super) fn rebuild(&mut self) {
        let mut order: Vec<u32> = self.planes.slots().collect();
        order.sort_unstable_by_key(|plane| self.planes.stamp(*plane));
        self.vertices.clear();
        self.certificates.clear();
        self.pending.clear();
        for plane in 0..self.planes.slot_count() {
            self.planes.set_carried(plane, NONE);
        }
        for &plane in &order {
            self.planes.set_without_face(plane, PlaneState::Uncertified);
        }
        self.change.removed.clear();
        self.change.created.clear();
        self.close_at_infinity();
        for plane in order {
            if self.is_empty() {
                self.planes.set_without_face(plane, PlaneState::Pending);
                self.pending.push(plane);
            } else if self.insert_into_structure(plane) == Insertion::Empty {
                self.become_empty(plane);
            }
            self.change.created.clear();
        }
        self.report_all_as_new();
    }

    /// Makes all that is there the change: an operation began from nothing.
    pub(super) fn report_all_as_new(&mut self) {
        self.begin_change(Steps::Several);
        if self.is_empty() {
            return;
        }
        for slot in 0..self.vertices.slot_count() as u32 {
            if self.vertices.is_live(slot) {
                self.vertices.set_fresh(slot);
                self.change.created.push(super::VertexIdx(slot));
            }
        }
    }
}
