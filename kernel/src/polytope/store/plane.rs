//! Planes by slot: their rows for signs, and what the structure knows of them.

use super::NONE;
use crate::half_space::HalfSpace;
use crate::polytope::infinity;
use crate::sign::Row;

/// What a plane slot holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::polytope) enum PlaneState {
    /// Nothing.
    Free,
    /// A plane with a face.
    Face,
    /// A redundant plane with a certificate.
    Certified,
    /// A redundant plane whose certificate was not needed yet.
    Uncertified,
    /// A plane that waits because the set is empty.
    Pending,
}

/// What the structure knows of a plane.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct PlaneRecord {
    row: Row,
    stamp: u64,
    /// The number of the certificate, where it is certified.
    certificate: u32,
    /// The first entry of the list of certificates that the plane takes part in.
    carried: u32,
    mark: u32,
    /// What the plane is where it has no face.
    state: PlaneState,
    leaving: Leaving,
}

/// Where a plane stands in the removal of several planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::polytope) enum Leaving {
    /// It stays.
    No,
    /// It will be removed.
    Yes,
    /// It will be removed with the patch at hand.
    WithPatch,
}

/// Planes by slot; the first slots hold the infinity planes.
#[derive(Debug, Default)]
pub(in crate::polytope) struct PlaneStore {
    records: Vec<PlaneRecord>,
    half_spaces: Vec<HalfSpace>,
    /// For each plane with a face one vertex of it, else [`NONE`]; then the vertex that stood there before, perhaps on the other
    /// side of the face, perhaps gone. Apart from the records: with very many planes, these few bytes are still at hand where
    /// the records are not.
    faces: Vec<[u32; 2]>,
    free: Vec<u32>,
    next_stamp: u64,
}

impl Clone for PlaneStore {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    fn clone_from(&mut self, source: &Self) {
        self.records.clone_from(&source.records);
        self.half_spaces.clone_from(&source.half_spaces);
        self.faces.clone_from(&source.faces);
        self.free.clone_from(&source.free);
        self.next_stamp = source.next_stamp;
    }
}

impl PlaneStore {
    /// Empty, with room for some planes.
    pub(in crate::polytope) fn with_capacity(planes: usize) -> Self {
        Self {
            records: Vec::with_capacity(planes),
            half_spaces: Vec::with_capacity(planes),
            faces: Vec::with_capacity(planes),
            ..Self::default()
        }
    }

    /// Stores a plane with the next stamp; it is uncertified.
    #[inline(always)]
    pub(in crate::polytope) fn insert(&mut self, half_space: HalfSpace, row: Row) -> u32 {
        let stamp = self.next_stamp;
        self.next_stamp += 1;
        self.insert_with_stamp(half_space, row, stamp)
    }

    /// Stores a plane with a stamp of the caller's.
    #[inline(always)]
    pub(in crate::polytope) fn insert_with_stamp(&mut self, half_space: HalfSpace, row: Row, stamp: u64) -> u32 {
        let state = PlaneState::Uncertified;
        let record =
            PlaneRecord { row, stamp, certificate: NONE, carried: NONE, mark: NONE, state, leaving: Leaving::No };
        if let Some(slot) = self.free.pop() {
            self.records[slot as usize] = record;
            self.half_spaces[slot as usize] = half_space;
            self.faces[slot as usize] = [NONE; 2];
            return slot;
        }
        let slot = self.records.len() as u32;
        self.records.push(record);
        self.half_spaces.push(half_space);
        self.faces.push([NONE; 2]);
        slot
    }

    /// The free slots, the next one to be given last.
    #[cfg(feature = "serde")]
    pub(in crate::polytope) fn free_slots(&self) -> &[u32] {
        &self.free
    }

    /// The stamp of the next plane.
    #[cfg(feature = "serde")]
    pub(in crate::polytope) fn next_stamp(&self) -> u64 {
        self.next_stamp
    }

    /// Fills a store of nothing but infinity planes: `planes` by slot, with their stamps. The slots without one must be those in
    /// `free`.
    #[cfg(feature = "serde")]
    pub(in crate::polytope) fn restore(
        &mut self,
        planes: &[Option<(HalfSpace, u64)>],
        free: Vec<u32>,
        next_stamp: u64,
    ) {
        // what a free slot holds is never looked at
        let nothing = self.half_spaces[0];
        for plane in planes {
            let (half_space, stamp) = plane.unwrap_or((nothing, 0));
            let slot = self.insert_with_stamp(half_space, Row::new(&half_space), stamp);
            if plane.is_none() {
                self.records[slot as usize].state = PlaneState::Free;
            }
        }
        self.free = free;
        self.next_stamp = next_stamp;
    }

    /// Gives a plane other coefficients.
    pub(in crate::polytope) fn replace(&mut self, slot: u32, half_space: HalfSpace, row: Row) {
        self.records[slot as usize].row = row;
        self.half_spaces[slot as usize] = half_space;
    }

    /// Gives a plane another row; its half-space stays.
    pub(in crate::polytope) fn set_row(&mut self, slot: u32, row: Row) {
        self.records[slot as usize].row = row;
    }

    /// How many planes there are, without the infinity planes.
    pub(in crate::polytope) fn live_count(&self) -> usize {
        self.records.len() - self.free.len() - infinity::COUNT as usize
    }

    /// Forgets all planes, keeping the memory.
    pub(in crate::polytope) fn clear(&mut self) {
        self.records.clear();
        self.half_spaces.clear();
        self.faces.clear();
        self.free.clear();
        self.next_stamp = 0;
    }

    /// Gives a slot back.
    pub(in crate::polytope) fn remove(&mut self, slot: u32) {
        let record = &mut self.records[slot as usize];
        record.state = PlaneState::Free;
        record.leaving = Leaving::No;
        self.faces[slot as usize][0] = NONE;
        self.free.push(slot);
    }

    /// How many slots there are, free ones included.
    pub(in crate::polytope) fn slot_count(&self) -> u32 {
        self.records.len() as u32
    }

    /// The slots of the planes that have a face, infinity planes included.
    pub(in crate::polytope) fn faces(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.slot_count()).filter(|plane| self.has_face(*plane))
    }

    /// The slots of all planes that are there, without the infinity planes.
    pub(in crate::polytope) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (infinity::COUNT..self.slot_count()).filter(|plane| self.state(*plane) != PlaneState::Free)
    }

    #[inline]
    pub(in crate::polytope) fn row(&self, plane: u32) -> &Row {
        &self.records[plane as usize].row
    }

    pub(in crate::polytope) fn half_space(&self, plane: u32) -> &HalfSpace {
        &self.half_spaces[plane as usize]
    }

    #[inline]
    pub(in crate::polytope) fn stamp(&self, plane: u32) -> u64 {
        self.records[plane as usize].stamp
    }

    #[inline]
    pub(in crate::polytope) fn state(&self, plane: u32) -> PlaneState {
        if self.has_face(plane) { PlaneState::Face } else { self.records[plane as usize].state }
    }

    /// Whether a plane has a face in the structure.
    #[inline]
    pub(in crate::polytope) fn has_face(&self, plane: u32) -> bool {
        self.face_vertex(plane) != NONE
    }

    /// One vertex of a plane's face, [`NONE`] where it has no face.
    #[inline]
    pub(in crate::polytope) fn face_vertex(&self, plane: u32) -> u32 {
        self.faces[plane as usize][0]
    }

    /// What may be another vertex of a plane's face.
    #[inline]
    pub(in crate::polytope) fn other_face_vertex(&self, plane: u32) -> u32 {
        self.faces[plane as usize][1]
    }

    /// The number of a plane's certificate, where it is certified.
    pub(in crate::polytope) fn certificate(&self, plane: u32) -> Option<u32> {
        (self.state(plane) == PlaneState::Certified).then_some(self.records[plane as usize].certificate)
    }

    /// The plane has a face, and `vertex` is one of its vertices.
    #[inline]
    pub(in crate::polytope) fn set_face(&mut self, plane: u32, vertex: u32) {
        let face = &mut self.faces[plane as usize];
        *face = [vertex, face[0]];
    }

    /// The planes by slot, for a loop that makes many vertices.
    #[inline(always)]
    pub(in crate::polytope) fn slots_mut(&mut self) -> PlaneSlots<'_> {
        PlaneSlots { records: &self.records, faces: &mut self.faces }
    }

    /// The plane has a face, and these are two of its vertices; the first is the one that counts.
    #[inline]
    pub(in crate::polytope) fn set_new_face(&mut self, plane: u32, vertices: [u32; 2]) {
        self.faces[plane as usize] = vertices;
    }

    /// The plane has no face, and its certificate is number `certificate`.
    #[inline]
    pub(in crate::polytope) fn set_certified(&mut self, plane: u32, certificate: u32) {
        let record = &mut self.records[plane as usize];
        record.state = PlaneState::Certified;
        record.certificate = certificate;
        self.faces[plane as usize][0] = NONE;
    }

    /// The plane has neither face nor certificate.
    pub(in crate::polytope) fn set_without_face(&mut self, plane: u32, state: PlaneState) {
        debug_assert!(matches!(state, PlaneState::Uncertified | PlaneState::Pending));
        self.records[plane as usize].state = state;
        self.faces[plane as usize][0] = NONE;
    }

    #[inline]
    pub(in crate::polytope) fn leaving(&self, plane: u32) -> Leaving {
        self.records[plane as usize].leaving
    }

    pub(in crate::polytope) fn set_leaving(&mut self, plane: u32, leaving: Leaving) {
        self.records[plane as usize].leaving = leaving;
    }

    /// The first place of the list of certificates that a plane takes part in.
    #[inline]
    pub(in crate::polytope) fn carried(&self, plane: u32) -> u32 {
        self.records[plane as usize].carried
    }

    pub(in crate::polytope) fn set_carried(&mut self, plane: u32, place: u32) {
        self.records[plane as usize].carried = place;
    }

    /// Scratch of one operation: where a plane stands on the horizon or the ring. What an earlier one left is there.
    #[inline]
    pub(in crate::polytope) fn mark(&self, plane: u32) -> u32 {
        self.records[plane as usize].mark
    }

    #[inline]
    pub(in crate::polytope) fn set_mark(&mut self, plane: u32, mark: u32) {
        self.records[plane as usize].mark = mark;
    }
}

/// The planes of a store by slot: a loop over these keeps them at hand.
pub(in crate::polytope) struct PlaneSlots<'a> {
    records: &'a [PlaneRecord],
    faces: &'a mut [[u32; 2]],
}

impl<'a> PlaneSlots<'a> {
    #[inline(always)]
    pub(in crate::polytope) fn row(&self, plane: u32) -> &'a Row {
        &self.records[plane as usize].row
    }

    /// The plane has a face, and `vertex` is one of its vertices.
    #[inline(always)]
    pub(in crate::polytope) fn set_face(&mut self, plane: u32, vertex: u32) {
        let face = &mut self.faces[plane as usize];
        *face = [vertex, face[0]];
    }
}
