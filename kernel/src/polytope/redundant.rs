//! Certificates of redundant planes.
//!
//! Where a climb ends at vertex `(a, b, c)`, the normal is a non-negative combination of the three normals there, so the
//! plane stays redundant for as long as `a`, `b`, `c` exist, whatever else is added, and whether or not they keep their
//! faces. Each plane keeps the list of the planes it helps to certify; removing it, with a face or without, re-examines
//! exactly that list. The lists are doubly linked through arrays, three places for each certificate, so that an entry is
//! never there twice and leaves in constant time.
//!
//! A plane that loses its face to another gets its certificate when the next removal or move needs it.

use super::IncrementalPolytope;
use super::store::{NONE, PlaneState, PlaneStore};

/// An orphaned plane and the plane that hid it, near which its certificate will be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Orphan {
    pub(super) plane: u32,
    pub(super) hidden_by: u32,
}

/// In place of a following entry: the certificate is in no list yet.
const UNLISTED: u32 = NONE - 1;

/// Why one plane is redundant, and its places in the lists of the planes that make it so.
#[derive(Debug, Clone, Copy)]
struct Certificate {
    plane: u32,
    certifiers: [u32; 3],
    next: [u32; 3],
    previous: [u32; 3],
}

/// The certificates of all planes. Place `4·certificate + k` is an entry in the list of the `k`-th certifier.
#[derive(Debug, Default)]
pub(super) struct Certificates {
    entries: Vec<Certificate>,
    free: Vec<u32>,
    /// Those that are not in the lists yet, the oldest first: only a removal needs the lists.
    unlisted: Vec<u32>,
    /// Planes that were orphaned since the last removal; entries of planes that are no longer uncertified are stale.
    uncertified: Vec<Orphan>,
}

impl Clone for Certificates {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    fn clone_from(&mut self, source: &Self) {
        self.entries.clone_from(&source.entries);
        self.free.clone_from(&source.free);
        self.unlisted.clone_from(&source.unlisted);
        self.uncertified.clone_from(&source.uncertified);
    }
}

impl Certificates {
    /// Forgets all certificates, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.entries.clear();
        self.free.clear();
        self.unlisted.clear();
        self.uncertified.clear();
    }

    pub(super) fn push_uncertified(&mut self, orphan: Orphan) {
        self.uncertified.push(orphan);
    }

    /// The planes that certify a redundant plane.
    pub(super) fn certifiers(&self, certificate: u32) -> [u32; 3] {
        self.entries[certificate as usize].certifiers
    }

    /// Whether a certificate is in the lists of its planes already.
    pub(super) fn is_listed(&self, certificate: u32) -> bool {
        self.entries[certificate as usize].next[0] != UNLISTED
    }

    /// The planes on the list that begins at a place; all certificates must be in the lists.
    pub(super) fn list(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors((first != NONE).then_some(first), |place| {
            let following = self.entries[(place >> 2) as usize].next[(place & 3) as usize];
            (following != NONE).then_some(following)
        })
        .map(|place| self.entries[(place >> 2) as usize].plane)
    }

    /// Stores a certificate that is in no list yet.
    #[inline(always)]
    fn insert(&mut self, planes: &mut PlaneStore, plane: u32, certifiers: [u32; 3]) {
        let entry = Certificate { plane, certifiers, next: [UNLISTED; 3], previous: [NONE; 3] };
        let number = if let Some(number) = self.free.pop() {
            self.entries[number as usize] = entry;
            number
        } else {
            self.entries.push(entry);
            self.entries.len() as u32 - 1
        };
        planes.set_certified(plane, number);
        self.unlisted.push(number);
    }

    /// Puts all certificates into the lists of their planes.
    fn link_all(&mut self, planes: &mut PlaneStore) {
        for at in 0..self.unlisted.len() {
            self.link(planes, self.unlisted[at]);
        }
        self.unlisted.clear();
    }

    fn link(&mut self, planes: &mut PlaneStore, number: u32) {
        for (k, certifier) in self.entries[number as usize].certifiers.into_iter().enumerate() {
            let place = number << 2 | k as u32;
            let first = planes.carried(certifier);
            planes.set_carried(certifier, place);
            self.entries[number as usize].next[k] = first;
            if first != NONE {
                self.entries[(first >> 2) as usize].previous[(first & 3) as usize] = place;
            }
        }
    }

    fn unlink(&mut self, planes: &mut PlaneStore, number: u32) {
        self.link_all(planes);
        let Certificate { certifiers, next, previous, .. } = self.entries[number as usize];
        for k in 0..3 {
            if previous[k] == NONE {
                planes.set_carried(certifiers[k], next[k]);
            } else {
                self.entries[(previous[k] >> 2) as usize].next[(previous[k] & 3) as usize] = next[k];
            }
            if next[k] != NONE {
                self.entries[(next[k] >> 2) as usize].previous[(next[k] & 3) as usize] = previous[k];
            }
        }
        self.free.push(number);
    }
}

impl IncrementalPolytope {
    /// Records that `plane` is redundant because of the planes of `vertex`.
    #[inline]
    pub(super) fn certify(&mut self, plane: u32, vertex: u32) {
        self.certificates.insert(&mut self.planes, plane, self.vertices.planes(vertex));
    }

    /// Takes a redundant plane out of the lists of its certifiers.
    pub(super) fn forget_certificate(&mut self, plane: u32) {
        if let Some(number) = self.planes.certificate(plane) {
            self.certificates.unlink(&mut self.planes, number);
        }
        self.planes.set_without_face(plane, PlaneState::Uncertified);
    }

    /// Finds the certificates that were put off, and makes the lists complete: a removal needs them.
    pub(super) fn certify_orphans(&mut self) {
        while let Some(Orphan { plane, hidden_by }) = self.certificates.uncertified.pop() {
            if self.planes.state(plane) != PlaneState::Uncertified {
                continue;
            }
            let near = self.planes.face_vertex(hidden_by);
            let start = if near == NONE { self.start(self.row(plane)) } else { near };
            let top = self.climb(self.row(plane), start);
            debug_assert!(!self.is_outside(top, plane), "an orphaned plane is redundant");
            self.certify(plane, top);
        }
        self.certificates.link_all(&mut self.planes);
    }

    /// Takes all planes that `certifier` helps to certify out of their lists and puts them into `examine`.
    #[inline]
    pub(super) fn take_certified(&mut self, certifier: u32, examine: &mut Vec<u32>) {
        let known = examine.len();
        self.certificates.link_all(&mut self.planes);
        if self.planes.carried(certifier) == NONE {
            return;
        }
        examine.extend(self.certificates.list(self.planes.carried(certifier)));
        for &plane in &examine[known..] {
            self.forget_certificate(plane);
        }
    }
}
