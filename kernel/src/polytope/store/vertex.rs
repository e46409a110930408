//! Vertices by slot, and the edges between them.

use super::places::{Farthest, Places};
use super::{NEXT, NONE, Steps};
use crate::polytope::VertexIdx;
use crate::sign::{Corner, Row};

/// One end of an edge: a vertex and the index at which the edge leaves it, which is that of the plane the edge does not
/// lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::polytope) struct Link(u32);

impl Link {
    /// Nowhere yet.
    pub(in crate::polytope) const NONE: Self = Self(NONE);

    #[inline]
    pub(in crate::polytope) fn new(vertex: u32, index: usize) -> Self {
        Self(vertex << 2 | index as u32)
    }

    #[inline]
    pub(in crate::polytope) fn vertex(self) -> u32 {
        self.0 >> 2
    }

    #[inline]
    pub(in crate::polytope) fn index(self) -> usize {
        (self.0 & 3) as usize
    }
}

/// One cache line: what a step around a face reads, and what is asked of the vertex that it comes to.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct VertexRecord {
    pub(super) point: Corner,
    /// The first is [`NONE`] where the slot is free.
    pub(super) planes: [u32; 3],
    links: [Link; 3],
}

impl VertexRecord {
    const FREE: Self = Self { point: Corner::NOWHERE, planes: [NONE; 3], links: [Link::NONE; 3] };
}

/// Mark of a vertex that the operation that runs made.
const FRESH: u8 = 1;
/// Mark of a vertex that the current visit came to.
const VISITED: u8 = 2;

/// Vertices by slot.
#[derive(Debug, Default)]
pub(in crate::polytope) struct VertexStore {
    records: Vec<VertexRecord>,
    /// Marks of the slots, apart from the records: they are few bytes even where there are very many vertices. A free slot has
    /// none.
    marks: Vec<u8>,
    places: Places,
    free: Vec<u32>,
    steps: Steps,
}

impl Clone for VertexStore {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    fn clone_from(&mut self, source: &Self) {
        self.records.clone_from(&source.records);
        self.marks.clone_from(&source.marks);
        self.places.forget();
        self.free.clone_from(&source.free);
    }
}

impl VertexStore {
    /// Empty, with room for some vertices.
    pub(in crate::polytope) fn with_capacity(vertices: usize) -> Self {
        Self { records: Vec::with_capacity(vertices), marks: Vec::with_capacity(vertices), ..Self::default() }
    }

    /// Stores a vertex, its links still open. `planes` are counter-clockwise seen from outside; `point` is the position
    /// for the filter: its constant part, or its part in `M` where an infinity plane takes part.
    #[inline(always)]
    pub(in crate::polytope) fn insert(&mut self, planes: [u32; 3], point: Corner) -> u32 {
        let record = VertexRecord { point, planes, links: [Link::NONE; 3] };
        let mark = self.mark_of_new();
        self.places.forget();
        if let Some(slot) = self.free.pop() {
            self.records[slot as usize] = record;
            self.marks[slot as usize] = mark;
            return slot;
        }
        let slot = self.records.len() as u32;
        self.records.push(record);
        self.marks.push(mark);
        slot
    }

    fn mark_of_new(&self) -> u8 {
        if self.steps == Steps::Several { FRESH } else { 0 }
    }

    /// Takes slots for new vertices, which must be written at once.
    #[inline]
    pub(in crate::polytope) fn claim(&mut self, count: usize, claimed: &mut Vec<VertexIdx>) {
        self.places.forget();
        let reused = count.min(self.free.len());
        let kept = self.free.len() - reused;
        claimed.extend(self.free[kept..].iter().rev().map(|slot| VertexIdx(*slot)));
        self.free.truncate(kept);
        if reused < count {
            self.claim_new(count - reused, claimed);
        }
    }

    #[inline(never)]
    fn claim_new(&mut self, count: usize, claimed: &mut Vec<VertexIdx>) {
        let first = self.records.len();
        self.records.resize(first + count, VertexRecord::FREE);
        self.marks.resize(first + count, 0);
        claimed.extend((first as u32..).take(count).map(VertexIdx));
    }

    /// The vertices by slot, for a loop that makes and links many.
    #[inline(always)]
    pub(in crate::polytope) fn slots_mut(&mut self) -> VertexSlots<'_> {
        let mark_of_new = self.mark_of_new();
        VertexSlots { records: &mut self.records, marks: &mut self.marks, mark_of_new }
    }

    /// Gives a vertex the position that it has after one of its planes moved.
    pub(in crate::polytope) fn set_point(&mut self, slot: u32, point: Corner) {
        self.records[slot as usize].point = point;
        self.places.forget();
    }

    /// Forgets all vertices, keeping the memory.
    pub(in crate::polytope) fn clear(&mut self) {
        self.records.clear();
        self.marks.clear();
        self.places.forget();
        self.free.clear();
    }

    /// Gives a slot back.
    pub(in crate::polytope) fn remove(&mut self, slot: u32) {
        self.records[slot as usize].planes[0] = NONE;
        self.marks[slot as usize] = 0;
        self.places.forget();
        self.free.push(slot);
    }

    /// Gives slots back, the last one to be taken first.
    #[inline]
    pub(in crate::polytope) fn remove_all(&mut self, slots: &[u32]) {
        self.places.forget();
        for &slot in slots {
            self.records[slot as usize].planes[0] = NONE;
            self.marks[slot as usize] = 0;
        }
        self.free.extend_from_slice(slots);
    }

    /// How many vertices there are.
    pub(in crate::polytope) fn len(&self) -> usize {
        self.records.len() - self.free.len()
    }

    /// How many slots there are, free ones included.
    pub(in crate::polytope) fn slot_count(&self) -> usize {
        self.records.len()
    }

    /// All live slots.
    pub(in crate::polytope) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.records.len() as u32).filter(|v| self.is_live(*v))
    }

    /// Whether a slot holds a vertex.
    pub(in crate::polytope) fn is_live(&self, slot: u32) -> bool {
        self.records.get(slot as usize).is_some_and(|record| record.planes[0] != NONE)
    }

    /// Whether a slot holds a vertex of a plane.
    #[inline]
    pub(in crate::polytope) fn is_on(&self, slot: u32, plane: u32) -> bool {
        let Some(record) = self.records.get(slot as usize) else { return false };
        let [a, b, c] = record.planes;
        a != NONE && (a == plane || b == plane || c == plane)
    }

    /// The three planes of a vertex, counter-clockwise seen from outside.
    #[inline]
    pub(in crate::polytope) fn planes(&self, slot: u32) -> [u32; 3] {
        self.records[slot as usize].planes
    }

    #[inline]
    pub(in crate::polytope) fn point(&self, slot: u32) -> &Corner {
        &self.records[slot as usize].point
    }

    /// The three planes of a vertex and its position.
    #[inline(always)]
    pub(in crate::polytope) fn planes_and_point(&self, slot: u32) -> (&[u32; 3], &Corner) {
        let VertexRecord { planes, point, .. } = &self.records[slot as usize];
        (planes, point)
    }

    /// Whether an infinity plane takes part in a vertex.
    #[inline]
    pub(in crate::polytope) fn is_ideal(&self, slot: u32) -> bool {
        self.records[slot as usize].point.is_ideal()
    }

    /// The other end of the edge that does not lie on the plane of index `k`.
    #[inline]
    pub(in crate::polytope) fn link(&self, slot: u32, k: usize) -> Link {
        self.records[slot as usize].links[k]
    }

    /// The other ends of the three edges.
    #[inline]
    pub(in crate::polytope) fn links(&self, slot: u32) -> [Link; 3] {
        self.records[slot as usize].links
    }

    /// The neighbours across the three edges.
    pub(in crate::polytope) fn neighbours(&self, slot: u32) -> [u32; 3] {
        self.links(slot).map(Link::vertex)
    }

    /// Makes two ends one edge.
    #[inline]
    pub(in crate::polytope) fn join(&mut self, a: Link, b: Link) {
        self.records[a.vertex() as usize].links[a.index()] = b;
        self.records[b.vertex() as usize].links[b.index()] = a;
    }

    /// Whether the current visit came to a vertex.
    #[inline]
    pub(in crate::polytope) fn is_visited(&self, slot: u32) -> bool {
        self.marks[slot as usize] & VISITED != 0
    }

    /// Notes that the current visit came to a vertex. The visit ends with the removal of all vertices that it came to, or with
    /// [`end_visit`](Self::end_visit).
    #[inline]
    pub(in crate::polytope) fn set_visited(&mut self, slot: u32) {
        self.marks[slot as usize] |= VISITED;
    }

    /// Forgets that the current visit came to some vertices.
    pub(in crate::polytope) fn end_visit(&mut self, slots: &[u32]) {
        for &slot in slots {
            self.marks[slot as usize] &= !VISITED;
        }
    }

    /// Says whether new vertices are marked from now on.
    #[inline]
    pub(in crate::polytope) fn set_steps(&mut self, steps: Steps) {
        self.steps = steps;
    }

    /// Whether new vertices are marked.
    #[inline]
    pub(in crate::polytope) fn steps(&self) -> Steps {
        self.steps
    }

    /// Notes that the operation that runs made a vertex.
    pub(in crate::polytope) fn set_fresh(&mut self, slot: u32) {
        self.marks[slot as usize] |= FRESH;
    }

    /// Whether a vertex was made by the operation that runs; forgets it.
    #[inline]
    pub(in crate::polytope) fn take_fresh(&mut self, slot: u32) -> bool {
        let mark = &mut self.marks[slot as usize];
        let is_fresh = *mark & FRESH != 0;
        *mark &= !FRESH;
        is_fresh
    }

    /// Whether [`seemingly_farthest`](Self::seemingly_farthest) answers at once.
    #[inline(always)]
    pub(in crate::polytope) fn are_places_known(&self) -> bool {
        self.places.are_known()
    }

    /// Finds the places for [`seemingly_farthest`](Self::seemingly_farthest), where there are few vertices.
    pub(in crate::polytope) fn find_places(&mut self) {
        self.places.find(&self.records);
    }

    /// Forgets the places.
    pub(in crate::polytope) fn forget_places(&mut self) {
        self.places.forget();
    }

    /// The vertex that seems to be farthest in the direction of a plane, and what is known of it; `None` where the places are not
    /// known.
    #[inline(always)]
    pub(in crate::polytope) fn seemingly_farthest(&self, plane: &Row) -> Option<Farthest> {
        self.places.farthest(plane)
    }

    /// At which index of a vertex a plane stands.
    #[inline]
    pub(in crate::polytope) fn index_of(&self, slot: u32, plane: u32) -> usize {
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
    pub(in crate::polytope) fn face_corners(&self, plane: u32, start: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let first = (start, self.index_of(start, plane));
        std::iter::successors(Some(first), move |(vertex, k)| {
            // the edge to the next vertex leaves off the plane after this one, and arrives off the plane before it
            let link = self.link(*vertex, NEXT[*k]);
            (link.vertex() != start).then(|| (link.vertex(), NEXT[link.index()]))
        })
    }

    /// The vertices of the face of `plane` in counter-clockwise order, beginning at `start`.
    pub(in crate::polytope) fn face_ring(&self, plane: u32, start: u32) -> impl Iterator<Item = u32> + '_ {
        self.face_corners(plane, start).map(|(vertex, _)| vertex)
    }
}

/// The vertices of a store by slot: a loop over these keeps them at hand, which one over the store cannot.
pub(in crate::polytope) struct VertexSlots<'a> {
    records: &'a mut [VertexRecord],
    marks: &'a mut [u8],
    mark_of_new: u8,
}

impl VertexSlots<'_> {
    /// The plane of the vertex after the one that the edge at an end does not lie on.
    #[inline(always)]
    pub(in crate::polytope) fn plane_after(&self, end: Link) -> u32 {
        self.records[end.vertex() as usize].planes[NEXT[end.index()]]
    }

    /// The other end of an edge.
    #[inline(always)]
    pub(in crate::polytope) fn other_end(&self, end: Link) -> Link {
        self.records[end.vertex() as usize].links[end.index()]
    }

    /// The three planes of a vertex and its position.
    #[inline(always)]
    pub(in crate::polytope) fn planes_and_point(&self, slot: u32) -> (&[u32; 3], &Corner) {
        let VertexRecord { planes, point, .. } = &self.records[slot as usize];
        (planes, point)
    }

    /// Whether the current visit came to a vertex.
    #[inline(always)]
    pub(in crate::polytope) fn is_visited(&self, slot: u32) -> bool {
        self.marks[slot as usize] & VISITED != 0
    }

    /// Notes that the current visit came to a vertex.
    #[inline(always)]
    pub(in crate::polytope) fn set_visited(&mut self, slot: u32) {
        self.marks[slot as usize] |= VISITED;
    }

    /// Writes a vertex into a claimed slot.
    #[inline(always)]
    pub(in crate::polytope) fn put(&mut self, slot: u32, planes: [u32; 3], links: [Link; 3], point: Corner) {
        self.records[slot as usize] = VertexRecord { point, planes, links };
        if self.mark_of_new != 0 {
            self.marks[slot as usize] = self.mark_of_new;
        }
    }

    /// Says where the edge at an end leads; the other end is to be told as well.
    #[inline(always)]
    pub(in crate::polytope) fn set_other_end(&mut self, end: Link, other: Link) {
        self.records[end.vertex() as usize].links[end.index()] = other;
    }
}
