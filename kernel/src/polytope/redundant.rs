//! Certificates of redundant planes.
//!
//! Where a climb ends at vertex `(a, b, c)`, the normal is a non-negative combination of the three normals there, so the
//! plane stays redundant for as long as `a`, `b`, `c` exist, whatever else is added. Each plane keeps the list of
//! the planes it helps to certify; removing it re-examines exactly that list. The lists are doubly linked through arrays,
//! three places for each redundant plane, so that an entry is never there twice and leaves in constant time.

use super::IncrementalPolytope;
use super::store::{NONE, PlaneState};

/// An orphaned plane and the plane that hid it, near which its certificate will be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Link {
    pub(super) plane: u32,
    pub(super) hidden_by: u32,
}

/// The certificates of all planes. Place `3·plane + k` is the entry of `plane` in the list of its `k`-th certifier.
#[derive(Debug, Clone, Default)]
pub(super) struct Certificates {
    certifiers: Vec<[u32; 3]>,
    next: Vec<u32>,
    previous: Vec<u32>,
    /// The first entry of the list that a plane carries.
    head: Vec<u32>,
    /// Planes that were orphaned since the last removal; entries of planes that are no longer uncertified are stale.
    uncertified: Vec<Link>,
}

impl Certificates {
    /// Room for one more plane slot.
    pub(super) fn grow(&mut self) {
        self.certifiers.push([NONE; 3]);
        self.next.extend([NONE; 3]);
        self.previous.extend([NONE; 3]);
        self.head.push(NONE);
    }

    /// Room for `slots` plane slots.
    pub(super) fn grow_to(&mut self, slots: usize) {
        while self.head.len() < slots {
            self.grow();
        }
    }

    /// Forgets all certificates, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.certifiers.clear();
        self.next.clear();
        self.previous.clear();
        self.head.clear();
        self.uncertified.clear();
    }

    pub(super) fn push_uncertified(&mut self, link: Link) {
        self.uncertified.push(link);
    }

    /// The planes that certify a redundant plane.
    pub(super) fn certifiers(&self, plane: u32) -> [u32; 3] {
        self.certifiers[plane as usize]
    }

    /// The planes that `certifier` helps to certify.
    pub(super) fn list(&self, certifier: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.head[certifier as usize];
        std::iter::successors((first != NONE).then_some(first), |place| {
            let following = self.next[*place as usize];
            (following != NONE).then_some(following)
        })
        .map(|place| place / 3)
    }

    fn link(&mut self, plane: u32, certifiers: [u32; 3]) {
        self.certifiers[plane as usize] = certifiers;
        for (k, certifier) in certifiers.into_iter().enumerate() {
            let place = 3 * plane + k as u32;
            let first = std::mem::replace(&mut self.head[certifier as usize], place);
            self.next[place as usize] = first;
            self.previous[place as usize] = NONE;
            if first != NONE {
                self.previous[first as usize] = place;
            }
        }
    }

    fn unlink(&mut self, plane: u32) {
        let certifiers = std::mem::replace(&mut self.certifiers[plane as usize], [NONE; 3]);
        for (k, certifier) in certifiers.into_iter().enumerate() {
            let place = (3 * plane) as usize + k;
            let (previous, next) = (self.previous[place], self.next[place]);
            if previous == NONE {
                self.head[certifier as usize] = next;
            } else {
                self.next[previous as usize] = next;
            }
            if next != NONE {
                self.previous[next as usize] = previous;
            }
        }
    }
}

impl IncrementalPolytope {
    /// Records that `plane` is redundant because of the planes of `vertex`.
    pub(super) fn certify(&mut self, plane: u32, vertex: u32) {
        self.planes.state[plane as usize] = PlaneState::Certified;
        self.planes.face_vertex[plane as usize] = NONE;
        self.certificates.link(plane, self.vertices.planes[vertex as usize]);
    }

    /// Takes a redundant plane out of the lists of its certifiers.
    pub(super) fn forget_certificate(&mut self, plane: u32) {
        if self.planes.state[plane as usize] == PlaneState::Certified {
            self.certificates.unlink(plane);
        }
        self.planes.state[plane as usize] = PlaneState::Uncertified;
    }

    /// Finds the certificates that were put off: a removal needs them.
    pub(super) fn certify_orphans(&mut self) {
        while let Some(Link { plane, hidden_by }) = self.certificates.uncertified.pop() {
            if self.planes.state[plane as usize] != PlaneState::Uncertified {
                continue;
            }
            let near = self.planes.face_vertex[hidden_by as usize];
            let top = self.climb(self.row(plane), if near == NONE { self.hint } else { near });
            debug_assert!(!self.is_outside(top, plane), "an orphaned plane is redundant");
            self.certify(plane, top);
        }
    }

    /// Takes all planes that `certifier` helps to certify out of their lists and puts them into `examine`.
    pub(super) fn take_certified(&mut self, certifier: u32, examine: &mut Vec<u32>) {
        examine.clear();
        examine.extend(self.certificates.list(certifier));
        for &plane in examine.iter() {
            self.forget_certificate(plane);
        }
    }
}
