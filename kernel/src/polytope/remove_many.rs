//! Taking several planes back at once: faces that touch are opened together, so that nothing is built between them, and
//! what the planes hid is looked at once. Where few planes remain, the whole is rebuilt.
//!
//! The faces of a connected patch leave one hole. As for a single face, only the planes around it and the planes whose
//! certificates the patch carried can bound what comes instead (`docs/kernel.md`), so the same means close it. A patch
//! whose border is not one simple ring of different planes is removed face by face.

use super::remove::RingEdge;
use super::store::{Leaving, Link, NEXT, PlaneState, Steps};
use super::{IncrementalPolytope, PlaneIdx, RemovePlanesResult, infinity};

/// After this many faces that did not make a patch, the others are not tried: they will hardly make one either.
const FUTILE: usize = 8;

impl IncrementalPolytope {
    /// Removes half-spaces: the same as [`remove_plane`](Self::remove_plane) one after the other (the paper's §8, "batch
    /// removal").
    ///
    /// Cost: what the neighbours around each patch of faces cost that leave together, several times less than one by one;
    /// where they are scattered, that of one by one (up to a sixth more, for the search for patches); where few planes stay,
    /// that of adding these.
    ///
    /// Handles that are not there, or there twice, do not count.
    pub fn remove_planes(&mut self, planes: &[PlaneIdx]) -> RemovePlanesResult<'_> {
        let mut leaving = std::mem::take(&mut self.scratch.leaving);
        leaving.clear();
        for idx in planes {
            if let Some(plane) = self.live(*idx).filter(|plane| self.planes.leaving(*plane) == Leaving::No) {
                self.planes.set_leaving(plane, Leaving::Yes);
                leaving.push(plane);
            }
        }
        self.begin_change(Steps::Several);
        if self.is_rebuild_cheaper(&leaving) {
            self.remove_by_rebuild(&leaving);
        } else {
            self.remove_patches(&leaving);
        }
        let count = leaving.len();
        self.scratch.leaving = leaving;
        let change = self.finish_change();
        RemovePlanesResult { count, removed_vertices: &change.removed, new_vertices: &change.created }
    }

    /// Whether adding the planes that stay is less work than removing those that leave. To remove a face costs
    /// about two thirds of adding a plane (`docs/benchmarks.md`); a plane without a face costs nothing to remove.
    fn is_rebuild_cheaper(&self, leaving: &[u32]) -> bool {
        let opened = leaving.iter().filter(|plane| self.planes.has_face(**plane)).count();
        2 * opened > 3 * (self.planes.live_count() - leaving.len())
    }

    fn remove_by_rebuild(&mut self, leaving: &[u32]) {
        let removed: Vec<_> = if self.is_empty() { Vec::new() } else { self.simple_handles().collect() };
        for &plane in leaving {
            self.planes.remove(plane);
        }
        self.rebuild();
        self.change.removed = removed;
    }

    fn remove_patches(&mut self, leaving: &[u32]) {
        let was_empty = self.is_empty();
        self.certify_orphans();
        let planes = &self.planes;
        self.pending.retain(|plane| planes.leaving(*plane) == Leaving::No);
        let mut futile = 0;
        self.scratch.waited = 0;
        for &plane in leaving {
            // first, because an infinity plane that comes back can take the face away
            self.refresh_infinity_planes();
            if futile < FUTILE && self.planes.has_face(plane) {
                futile += self.open_patch(plane);
            } else if self.planes.state(plane) != PlaneState::Pending {
                self.open_alone(plane);
            }
        }
        for &plane in leaving {
            self.planes.remove(plane);
        }
        self.examine_again();
        if was_empty {
            self.after_loss(leaving);
        }
    }

    /// Lets go what a leaving plane hides, to be looked at when all have left; what leaves itself lets go with it, because
    /// from now on it bounds nothing.
    fn release(&mut self, plane: u32) {
        let mut examine = std::mem::take(&mut self.scratch.to_examine);
        let known = examine.len();
        self.take_certified(plane, &mut examine);
        let mut at = known;
        while let Some(&hidden) = examine.get(at) {
            if self.planes.leaving(hidden) == Leaving::No {
                at += 1;
            } else {
                examine.swap_remove(at);
                self.take_certified(hidden, &mut examine);
            }
        }
        self.scratch.to_examine = examine;
    }

    /// Gives the hidden infinity planes certificates by planes that have a face, or shows them.
    ///
    /// Hidden planes that wait to be looked at again are missing from the structure, which may reach beyond an infinity
    /// plane that only they kept hidden; the next hole would then not fit what is around it.
    fn refresh_infinity_planes(&mut self) {
        // What certifies an infinity plane loses its face only by leaving, and then the infinity plane waits as well.
        if self.scratch.to_examine.len() == self.scratch.waited {
            return;
        }
        let mut all_hold = true;
        for plane in 0..infinity::COUNT {
            let is_stale = match self.planes.certificate(plane) {
                Some(number) => !self.certificates.certifiers(number).iter().all(|p| self.planes.has_face(*p)),
                None => !self.planes.has_face(plane),
            };
            if is_stale {
                all_hold = false;
                self.forget_certificate(plane);
                self.insert_into_structure(plane);
            }
        }
        self.certify_orphans();
        // One that was shown may have hidden what certifies another.
        self.scratch.waited = if all_hold { self.scratch.to_examine.len() } else { 0 };
    }

    /// Opens the face of `start` and, where it pays, all leaving faces that are connected with it, and closes the hole.
    ///
    /// Gives how many faces were looked at in vain.
    fn open_patch(&mut self, start: u32) -> usize {
        let mut ring = std::mem::take(&mut self.scratch.ring);
        let mut cut = std::mem::take(&mut self.scratch.cut);
        let mut patch = std::mem::take(&mut self.scratch.patch);
        ring.clear();
        cut.clear();
        patch.clear();
        patch.push(start);
        self.walk_ring(start, &mut ring, &mut cut);
        let mut is_whole = true;
        if ring.iter().any(|edge| self.is_leaving(edge.plane)) {
            is_whole = self.grow_patch(&mut patch, &mut ring, &mut cut);
        }
        for &plane in &patch {
            self.release(plane);
        }
        if is_whole {
            self.discard_vertices(&cut);
            self.close_hole(&ring, start);
            for &plane in &patch {
                self.planes.set_without_face(plane, PlaneState::Uncertified);
            }
        }
        self.scratch.ring = ring;
        self.scratch.cut = cut;
        for &plane in patch.iter().filter(|_| !is_whole) {
            self.open_alone(plane);
        }
        let futile = if is_whole { 0 } else { patch.len() };
        self.scratch.patch = patch;
        futile
    }

    /// Grows a patch over its leaving neighbours, with its vertices and the ring around it; false where its border is not
    /// one simple ring.
    fn grow_patch(&mut self, patch: &mut Vec<u32>, ring: &mut Vec<RingEdge>, cut: &mut Vec<u32>) -> bool {
        let mut border = std::mem::take(&mut self.scratch.border);
        ring.clear();
        cut.clear();
        border.clear();
        let is_collected = self.collect_patch(patch, cut, &mut border);
        // Euler's formula for a disc; a face that stays inside the patch may have no corner on its border.
        let is_disc = cut.len() + 2 == 2 * patch.len() + border.len();
        // Around two planes, the only edge between them would begin and end in the hole.
        let is_whole = is_collected && is_disc && border.len() > 2 && self.walk_border(&border, ring);
        self.scratch.border = border;
        if !is_whole {
            self.vertices.end_visit(cut);
        }
        is_whole
    }

    /// Takes one leaving plane out of the structure.
    fn open_alone(&mut self, plane: u32) {
        self.refresh_infinity_planes();
        self.release(plane);
        if self.planes.has_face(plane) {
            self.open_face(plane);
            self.planes.set_without_face(plane, PlaneState::Uncertified);
        } else {
            self.forget_certificate(plane);
        }
    }

    /// Grows a patch over its leaving neighbours and collects its vertices, and those on its border, each as the end off
    /// its one leaving plane. Gives up, and gives false, where the border grows with the patch: the leaving faces are
    /// scattered then. What was collected until then is only a part.
    fn collect_patch(&mut self, patch: &mut Vec<u32>, cut: &mut Vec<u32>, border: &mut Vec<Link>) -> bool {
        self.planes.set_leaving(patch[0], Leaving::WithPatch);
        let mut next = 0;
        while let Some(&plane) = patch.get(next) {
            next += 1;
            if border.len() > 2 * next / 3 + FUTILE {
                return false;
            }
            let first = cut.len();
            let corners = self.vertices.face_corners(plane, self.planes.face_vertex(plane));
            cut.extend(corners.map(|(vertex, _)| vertex).filter(|vertex| !self.vertices.is_visited(*vertex)));
            for &vertex in &cut[first..] {
                self.vertices.set_visited(vertex);
                let mut leaving = 0;
                for (k, p) in self.vertices.planes(vertex).into_iter().enumerate() {
                    if !self.is_leaving(p) {
                        continue;
                    }
                    leaving += 1;
                    if leaving == 1 {
                        border.push(Link::new(vertex, k));
                    } else if leaving == 2 {
                        border.pop();
                    }
                    if self.planes.leaving(p) == Leaving::Yes {
                        self.planes.set_leaving(p, Leaving::WithPatch);
                        patch.push(p);
                    }
                }
            }
        }
        true
    }

    fn is_leaving(&self, plane: u32) -> bool {
        self.planes.leaving(plane) != Leaving::No
    }

    /// The ring of planes around a patch; false where the border is not one ring of different planes.
    fn walk_border(&mut self, border: &[Link], ring: &mut Vec<RingEdge>) -> bool {
        let Some(&start) = border.first() else { return false };
        let mut corner = start;
        loop {
            let plane = self.vertices.planes(corner.vertex())[NEXT[corner.index()]];
            self.planes.set_mark(plane, ring.len() as u32);
            ring.push(RingEdge { plane, end: self.vertices.link(corner.vertex(), corner.index()) });
            corner = self.next_on_border(corner);
            if corner == start {
                break;
            }
        }
        let differ = ring.iter().zip(0..).all(|(edge, at)| self.planes.mark(edge.plane) == at);
        differ && ring.len() == border.len()
    }

    /// The next vertex on the border of a patch, along the plane that stays on the border: the planes of the patch that it
    /// touches before are passed.
    fn next_on_border(&self, corner: Link) -> Link {
        let (mut vertex, mut index) = (corner.vertex(), NEXT[corner.index()]);
        loop {
            let link = self.vertices.link(vertex, index);
            (vertex, index) = (link.vertex(), NEXT[link.index()]);
            if !self.is_leaving(self.vertices.planes(vertex)[link.index()]) {
                return Link::new(vertex, index);
            }
        }
    }
}
