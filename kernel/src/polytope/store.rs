//! Flat arrays of planes and vertices with free lists: a clone is a few copies of memory.
//!
//! A record of a plane is one cache line, a record of a vertex half of one, and a link between vertices names the way
//! back: walking around a face touches one line a vertex and searches nothing.

use super::VertexIdx;
use super::infinity;
use crate::half_space::HalfSpace;
use crate::sign::{Homogeneous, Row};

/// No plane, no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// The index that follows 0, 1, 2 in the cyclic order of the three planes of a vertex.
pub(super) const NEXT: [usize; 3] = [1, 2, 0];
/// The index before.
pub(super) const BEFORE: [usize; 3] = [2, 0, 1];

/// What a plane slot holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlaneState {
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
    /// With a face: one vertex of it. Certified: the number of the certificate. Else [`NONE`].
    anchor: u32,
    /// The first entry of the list of certificates that the plane takes part in.
    carried: u32,
    mark: u32,
    state: PlaneState,
    leaving: Leaving,
}

/// Where a plane stands in the removal of several planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Leaving {
    /// It stays.
    No,
    /// It will be removed.
    Yes,
    /// It will be removed with the patch at hand.
    WithPatch,
}

/// Planes by slot; the first slots hold the infinity planes.
#[derive(Debug, Default)]
pub(super) struct PlaneStore {
    records: Vec<PlaneRecord>,
    half_spaces: Vec<HalfSpace>,
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
        self.free.clone_from(&source.free);
        self.next_stamp = source.next_stamp;
    }
}

impl PlaneStore {
    /// Empty, with room for some planes.
    pub(super) fn with_capacity(planes: usize) -> Self {
        Self { records: Vec::with_capacity(planes), half_spaces: Vec::with_capacity(planes), ..Self::default() }
    }

    /// Stores a plane with the next stamp; it is uncertified.
    pub(super) fn insert(&mut self, half_space: HalfSpace, row: Row) -> u32 {
        let stamp = self.next_stamp;
        self.next_stamp += 1;
        self.insert_with_stamp(half_space, row, stamp)
    }

    /// Stores a plane with a stamp of the caller's.
    pub(super) fn insert_with_stamp(&mut self, half_space: HalfSpace, row: Row, stamp: u64) -> u32 {
        let state = PlaneState::Uncertified;
        let record = PlaneRecord { row, stamp, anchor: NONE, carried: NONE, mark: NONE, state, leaving: Leaving::No };
        if let Some(slot) = self.free.pop() {
            self.records[slot as usize] = record;
            self.half_spaces[slot as usize] = half_space;
            return slot;
        }
        let slot = self.records.len() as u32;
        self.records.push(record);
        self.half_spaces.push(half_space);
        slot
    }

    /// Gives a plane other coefficients.
    pub(super) fn replace(&mut self, slot: u32, half_space: HalfSpace, row: Row) {
        self.records[slot as usize].row = row;
        self.half_spaces[slot as usize] = half_space;
    }

    /// Gives a plane another row; its half-space stays.
    pub(super) fn set_row(&mut self, slot: u32, row: Row) {
        self.records[slot as usize].row = row;
    }

    /// How many planes there are, without the infinity planes.
    pub(super) fn live_count(&self) -> usize {
        self.records.len() - self.free.len() - infinity::COUNT as usize
    }

    /// Forgets all planes, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.records.clear();
        self.half_spaces.clear();
        self.free.clear();
        self.next_stamp = 0;
    }

    /// Gives a slot back.
    pub(super) fn remove(&mut self, slot: u32) {
        let record = &mut self.records[slot as usize];
        record.state = PlaneState::Free;
        record.leaving = Leaving::No;
        record.anchor = NONE;
        self.free.push(slot);
    }

    /// How many slots there are, free ones included.
    pub(super) fn slot_count(&self) -> u32 {
        self.records.len() as u32
    }

    /// The slots of the planes that have a face, infinity planes included.
    pub(super) fn faces(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.slot_count()).filter(|plane| self.has_face(*plane))
    }

    /// The slots of all planes that are there, without the infinity planes.
    pub(super) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (infinity::COUNT..self.slot_count()).filter(|plane| self.state(*plane) != PlaneState::Free)
    }

    #[inline]
    pub(super) fn row(&self, plane: u32) -> &Row {
        &self.records[plane as usize].row
    }

    pub(super) fn half_space(&self, plane: u32) -> &HalfSpace {
        &self.half_spaces[plane as usize]
    }

    #[inline]
    pub(super) fn stamp(&self, plane: u32) -> u64 {
        self.records[plane as usize].stamp
    }

    #[inline]
    pub(super) fn state(&self, plane: u32) -> PlaneState {
        self.records[plane as usize].state
    }

    /// Whether a plane has a face in the structure.
    #[inline]
    pub(super) fn has_face(&self, plane: u32) -> bool {
        self.state(plane) == PlaneState::Face
    }

    /// One vertex of a plane's face, [`NONE`] where it has no face.
    #[inline]
    pub(super) fn face_vertex(&self, plane: u32) -> u32 {
        let record = &self.records[plane as usize];
        if record.state == PlaneState::Face { record.anchor } else { NONE }
    }

    /// The number of a plane's certificate, where it is certified.
    pub(super) fn certificate(&self, plane: u32) -> Option<u32> {
        let record = &self.records[plane as usize];
        (record.state == PlaneState::Certified).then_some(record.anchor)
    }

    /// The plane has a face, and `vertex` is one of its vertices.
    #[inline]
    pub(super) fn set_face(&mut self, plane: u32, vertex: u32) {
        let record = &mut self.records[plane as usize];
        record.state = PlaneState::Face;
        record.anchor = vertex;
    }

    /// The plane has no face, and its certificate is number `certificate`.
    pub(super) fn set_certified(&mut self, plane: u32, certificate: u32) {
        let record = &mut self.records[plane as usize];
        record.state = PlaneState::Certified;
        record.anchor = certificate;
    }

    /// The plane has neither face nor certificate.
    pub(super) fn set_without_face(&mut self, plane: u32, state: PlaneState) {
        debug_assert!(matches!(state, PlaneState::Uncertified | PlaneState::Pending));
        let record = &mut self.records[plane as usize];
        record.state = state;
        record.anchor = NONE;
    }

    #[inline]
    pub(super) fn leaving(&self, plane: u32) -> Leaving {
        self.records[plane as usize].leaving
    }

    pub(super) fn set_leaving(&mut self, plane: u32, leaving: Leaving) {
        self.records[plane as usize].leaving = leaving;
    }

    /// The first place of the list of certificates that a plane takes part in.
    #[inline]
    pub(super) fn carried(&self, plane: u32) -> u32 {
        self.records[plane as usize].carried
    }

    pub(super) fn set_carried(&mut self, plane: u32, place: u32) {
        self.records[plane as usize].carried = place;
    }

    /// Scratch of one operation: where a plane stands on the horizon or the ring. What an earlier one left is there.
    #[inline]
    pub(super) fn mark(&self, plane: u32) -> u32 {
        self.records[plane as usize].mark
    }

    #[inline]
    pub(super) fn set_mark(&mut self, plane: u32, mark: u32) {
        self.records[plane as usize].mark = mark;
    }
}

/// One end of an edge: a vertex and the index at which the edge leaves it, which is that of the plane the edge does not
/// lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Link(u32);

impl Link {
    /// Nowhere yet.
    pub(super) const NONE: Self = Self(NONE);

    #[inline]
    pub(super) fn new(vertex: u32, index: usize) -> Self {
        Self(vertex << 2 | index as u32)
    }

    #[inline]
    pub(super) fn vertex(self) -> u32 {
        self.0 >> 2
    }

    #[inline]
    pub(super) fn index(self) -> usize {
        (self.0 & 3) as usize
    }
}

#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
struct VertexRecord {
    planes: [u32; 3],
    links: [Link; 3],
    visited: u32,
    ideal: bool,
    fresh: bool,
}

impl VertexRecord {
    const FREE: Self = Self { planes: [NONE; 3], links: [Link::NONE; 3], visited: 0, ideal: false, fresh: false };
}

/// Whether an operation can take away vertices that it made itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    /// It cannot.
    One,
    /// It can: new vertices are marked until it ends.
    Several,
}

/// A cached position that fills one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Position(Homogeneous);

/// Vertices by slot.
#[derive(Debug, Default)]
pub(super) struct VertexStore {
    records: Vec<VertexRecord>,
    positions: Vec<Position>,
    free: Vec<u32>,
    visit: u32,
    marks_fresh: bool,
}

impl Clone for VertexStore {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    fn clone_from(&mut self, source: &Self) {
        self.records.clone_from(&source.records);
        self.positions.clone_from(&source.positions);
        self.free.clone_from(&source.free);
        self.visit = source.visit;
    }
}

impl VertexStore {
    /// Empty, with room for some vertices.
    pub(super) fn with_capacity(vertices: usize) -> Self {
        Self { records: Vec::with_capacity(vertices), positions: Vec::with_capacity(vertices), ..Self::default() }
    }

    /// Stores a vertex, its links still open. `planes` are counter-clockwise seen from outside; `point` is the position
    /// for the filter: its constant part, or its part in `M` where an infinity plane takes part.
    #[inline(always)]
    pub(super) fn insert(&mut self, planes: [u32; 3], point: Homogeneous) -> u32 {
        let ideal = planes.into_iter().any(infinity::is_infinity);
        let record = VertexRecord { planes, links: [Link::NONE; 3], visited: 0, ideal, fresh: self.marks_fresh };
        if let Some(slot) = self.free.pop() {
            self.records[slot as usize] = record;
            self.positions[slot as usize] = Position(point);
            return slot;
        }
        let slot = self.records.len() as u32;
        self.records.push(record);
        self.positions.push(Position(point));
        slot
    }

    /// Takes slots for new vertices, which must be written at once.
    pub(super) fn claim(&mut self, count: usize, claimed: &mut Vec<VertexIdx>) {
        for _ in 0..count {
            let slot = self.free.pop().unwrap_or_else(|| {
                self.records.push(VertexRecord::FREE);
                self.positions.push(Position(Homogeneous::default()));
                self.records.len() as u32 - 1
            });
            claimed.push(VertexIdx(slot));
        }
    }

    /// The vertices by slot, for a loop that makes and links many.
    #[inline(always)]
    pub(super) fn slots_mut(&mut self) -> VertexSlots<'_> {
        VertexSlots {
            records: &mut self.records,
            positions: &mut self.positions,
            visit: self.visit,
            marks_fresh: self.marks_fresh,
        }
    }

    /// Gives a vertex the position that it has after one of its planes moved.
    pub(super) fn set_point(&mut self, slot: u32, point: Homogeneous) {
        self.positions[slot as usize] = Position(point);
    }

    /// Forgets all vertices, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.records.clear();
        self.positions.clear();
        self.free.clear();
    }

    /// Gives a slot back.
    pub(super) fn remove(&mut self, slot: u32) {
        self.records[slot as usize].planes[0] = NONE;
        self.free.push(slot);
    }

    /// How many vertices there are.
    pub(super) fn len(&self) -> usize {
        self.records.len() - self.free.len()
    }

    /// How many slots there are, free ones included.
    pub(super) fn slot_count(&self) -> usize {
        self.records.len()
    }

    /// All live slots.
    pub(super) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.records.len() as u32).filter(|v| self.is_live(*v))
    }

    /// Whether a slot holds a vertex.
    pub(super) fn is_live(&self, slot: u32) -> bool {
        self.records.get(slot as usize).is_some_and(|record| record.planes[0] != NONE)
    }

    /// Whether a slot holds a vertex of a plane.
    #[inline]
    pub(super) fn is_on(&self, slot: u32, plane: u32) -> bool {
        let Some(record) = self.records.get(slot as usize) else { return false };
        let [a, b, c] = record.planes;
        a != NONE && (a == plane || b == plane || c == plane)
    }

    /// The three planes of a vertex, counter-clockwise seen from outside.
    #[inline]
    pub(super) fn planes(&self, slot: u32) -> [u32; 3] {
        self.records[slot as usize].planes
    }

    #[inline]
    pub(super) fn point(&self, slot: u32) -> &Homogeneous {
        &self.positions[slot as usize].0
    }

    /// Whether an infinity plane takes part in a vertex.
    #[inline]
    pub(super) fn is_ideal(&self, slot: u32) -> bool {
        self.records[slot as usize].ideal
    }

    /// The other end of the edge that does not lie on the plane of index `k`.
    #[inline]
    pub(super) fn link(&self, slot: u32, k: usize) -> Link {
        self.records[slot as usize].links[k]
    }

    /// The other ends of the three edges.
    #[inline]
    pub(super) fn links(&self, slot: u32) -> [Link; 3] {
        self.records[slot as usize].links
    }

    /// The neighbours across the three edges.
    pub(super) fn neighbours(&self, slot: u32) -> [u32; 3] {
        self.links(slot).map(Link::vertex)
    }

    /// Makes two ends one edge.
    #[inline]
    pub(super) fn join(&mut self, a: Link, b: Link) {
        self.records[a.vertex() as usize].links[a.index()] = b;
        self.records[b.vertex() as usize].links[b.index()] = a;
    }

    /// Whether the current visit came to a vertex.
    #[inline]
    pub(super) fn is_visited(&self, slot: u32) -> bool {
        self.records[slot as usize].visited == self.visit
    }

    /// Notes that the current visit came to a vertex.
    #[inline]
    pub(super) fn set_visited(&mut self, slot: u32) {
        self.records[slot as usize].visited = self.visit;
    }

    /// A new visit, which came to no vertex yet.
    pub(super) fn begin_visit(&mut self) {
        if self.visit == u32::MAX {
            for record in &mut self.records {
                record.visited = 0;
            }
            self.visit = 0;
        }
        self.visit += 1;
    }

    /// Says whether new vertices are marked from now on.
    #[inline]
    pub(super) fn set_steps(&mut self, steps: Steps) {
        self.marks_fresh = steps == Steps::Several;
    }

    /// Whether new vertices are marked.
    pub(super) fn marks_fresh(&self) -> bool {
        self.marks_fresh
    }

    /// Notes that the operation that runs made a vertex.
    pub(super) fn set_fresh(&mut self, slot: u32) {
        self.records[slot as usize].fresh = true;
    }

    /// Whether a vertex was made by the operation that runs; forgets it.
    #[inline]
    pub(super) fn take_fresh(&mut self, slot: u32) -> bool {
        std::mem::take(&mut self.records[slot as usize].fresh)
    }

    /// At which index of a vertex a plane stands.
    #[inline]
    pub(super) fn index_of(&self, slot: u32, plane: u32) -> usize {
        let planes = self.planes(slot);
        if planes[0] == plane {
            0
        } else if planes[1] == plane {
            1
        } else {
            debug_assert_eq!(planes[2], plane, "the plane passes through the vertex");
            2
        }
    }

    /// The vertices of the face of `plane` in counter-clockwise order, beginning at `start`, each with the index of
    /// the plane there.
    #[inline]
    pub(super) fn face_corners(&self, plane: u32, start: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let first = (start, self.index_of(start, plane));
        std::iter::successors(Some(first), move |(vertex, k)| {
            // the edge to the next vertex leaves off the plane after this one, and arrives off the plane before it
            let link = self.link(*vertex, NEXT[*k]);
            (link.vertex() != start).then(|| (link.vertex(), NEXT[link.index()]))
        })
    }

    /// The vertices of the face of `plane` in counter-clockwise order, beginning at `start`.
    pub(super) fn face_ring(&self, plane: u32, start: u32) -> impl Iterator<Item = u32> + '_ {
        self.face_corners(plane, start).map(|(vertex, _)| vertex)
    }
}

/// The vertices of a store by slot: a loop over these keeps them at hand, which one over the store cannot.
pub(super) struct VertexSlots<'a> {
    records: &'a mut [VertexRecord],
    positions: &'a mut [Position],
    visit: u32,
    marks_fresh: bool,
}

impl VertexSlots<'_> {
    /// The three planes of a vertex, counter-clockwise seen from outside.
    #[inline(always)]
    pub(super) fn planes(&self, slot: u32) -> [u32; 3] {
        self.records[slot as usize].planes
    }

    /// The other end of an edge.
    #[inline(always)]
    pub(super) fn other_end(&self, end: Link) -> Link {
        self.records[end.vertex() as usize].links[end.index()]
    }

    #[inline(always)]
    pub(super) fn point(&self, slot: u32) -> &Homogeneous {
        &self.positions[slot as usize].0
    }

    /// Whether an infinity plane takes part in a vertex.
    #[inline(always)]
    pub(super) fn is_ideal(&self, slot: u32) -> bool {
        self.records[slot as usize].ideal
    }

    /// Whether the current visit came to a vertex.
    #[inline(always)]
    pub(super) fn is_visited(&self, slot: u32) -> bool {
        self.records[slot as usize].visited == self.visit
    }

    /// Notes that the current visit came to a vertex.
    #[inline(always)]
    pub(super) fn set_visited(&mut self, slot: u32) {
        self.records[slot as usize].visited = self.visit;
    }

    /// Writes a vertex into a claimed slot.
    #[inline(always)]
    pub(super) fn put(&mut self, slot: u32, planes: [u32; 3], links: [Link; 3], ideal: bool, point: Homogeneous) {
        self.records[slot as usize] = VertexRecord { planes, links, visited: 0, ideal, fresh: self.marks_fresh };
        self.positions[slot as usize] = Position(point);
    }

    /// Says where the edge at an end leads; the other end is to be told as well.
    #[inline(always)]
    pub(super) fn set_other_end(&mut self, end: Link, other: Link) {
        self.records[end.vertex() as usize].links[end.index()] = other;
    }
}

/// The vertices that an operation took away, made and moved.
#[derive(Debug, Default)]
pub(super) struct Change {
    pub(super) removed: Vec<VertexIdx>,
    pub(super) created: Vec<VertexIdx>,
    pub(super) moved: Vec<VertexIdx>,
}
