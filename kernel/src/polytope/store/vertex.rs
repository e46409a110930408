//! Vertices by slot, and the edges between them.

use super::{NEXT, NONE};
use crate::polytope::{VertexIdx, infinity};
use crate::sign::Homogeneous;

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
pub(in crate::polytope) enum Steps {
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
pub(in crate::polytope) struct VertexStore {
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
    pub(in crate::polytope) fn with_capacity(vertices: usize) -> Self {
        Self { records: Vec::with_capacity(vertices), positions: Vec::with_capacity(vertices), ..Self::default() }
    }

    /// Stores a vertex, its links still open. `planes` are counter-clockwise seen from outside; `point` is the position
    /// for the filter: its constant part, or its part in `M` where an infinity plane takes part.
    #[inline(always)]
    pub(in crate::polytope) fn insert(&mut self, planes: [u32; 3], point: Homogeneous) -> u32 {
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
    pub(in crate::polytope) fn claim(&mut self, count: usize, claimed: &mut Vec<VertexIdx>) {
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
    pub(in crate::polytope) fn slots_mut(&mut self) -> VertexSlots<'_> {
        VertexSlots {
            records: &mut self.records,
            positions: &mut self.positions,
            visit: self.visit,
            marks_fresh: self.marks_fresh,
        }
    }

    /// Gives a vertex the position that it has after one of its planes moved.
    pub(in crate::polytope) fn set_point(&mut self, slot: u32, point: Homogeneous) {
        self.positions[slot as usize] = Position(point);
    }

    /// Forgets all vertices, keeping the memory.
    pub(in crate::polytope) fn clear(&mut self) {
        self.records.clear();
        self.positions.clear();
        self.free.clear();
    }

    /// Gives a slot back.
    pub(in crate::polytope) fn remove(&mut self, slot: u32) {
        self.records[slot as usize].planes[0] = NONE;
        self.free.push(slot);
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
    pub(in crate::polytope) fn point(&self, slot: u32) -> &Homogeneous {
        &self.positions[slot as usize].0
    }

    /// Whether an infinity plane takes part in a vertex.
    #[inline]
    pub(in crate::polytope) fn is_ideal(&self, slot: u32) -> bool {
        self.records[slot as usize].ideal
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
        self.records[slot as usize].visited == self.visit
    }

    /// Notes that the current visit came to a vertex.
    #[inline]
    pub(in crate::polytope) fn set_visited(&mut self, slot: u32) {
        self.records[slot as usize].visited = self.visit;
    }

    /// A new visit, which came to no vertex yet.
    pub(in crate::polytope) fn begin_visit(&mut self) {
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
    pub(in crate::polytope) fn set_steps(&mut self, steps: Steps) {
        self.marks_fresh = steps == Steps::Several;
    }

    /// Notes that the operation that runs made a vertex.
    pub(in crate::polytope) fn set_fresh(&mut self, slot: u32) {
        self.records[slot as usize].fresh = true;
    }

    /// Whether a vertex was made by the operation that runs; forgets it.
    #[inline]
    pub(in crate::polytope) fn take_fresh(&mut self, slot: u32) -> bool {
        std::mem::take(&mut self.records[slot as usize].fresh)
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
    positions: &'a mut [Position],
    visit: u32,
    marks_fresh: bool,
}

impl VertexSlots<'_> {
    /// The three planes of a vertex, counter-clockwise seen from outside.
    #[inline(always)]
    pub(in crate::polytope) fn planes(&self, slot: u32) -> [u32; 3] {
        self.records[slot as usize].planes
    }

    /// The other end of an edge.
    #[inline(always)]
    pub(in crate::polytope) fn other_end(&self, end: Link) -> Link {
        self.records[end.vertex() as usize].links[end.index()]
    }

    #[inline(always)]
    pub(in crate::polytope) fn point(&self, slot: u32) -> &Homogeneous {
        &self.positions[slot as usize].0
    }

    /// Whether an infinity plane takes part in a vertex.
    #[inline(always)]
    pub(in crate::polytope) fn is_ideal(&self, slot: u32) -> bool {
        self.records[slot as usize].ideal
    }

    /// Whether the current visit came to a vertex.
    #[inline(always)]
    pub(in crate::polytope) fn is_visited(&self, slot: u32) -> bool {
        self.records[slot as usize].visited == self.visit
    }

    /// Notes that the current visit came to a vertex.
    #[inline(always)]
    pub(in crate::polytope) fn set_visited(&mut self, slot: u32) {
        self.records[slot as usize].visited = self.visit;
    }

    /// Writes a vertex into a claimed slot.
    #[inline(always)]
    pub(in crate::polytope) fn put(
        &mut self,
        slot: u32,
        planes: [u32; 3],
        links: [Link; 3],
        ideal: bool,
        point: Homogeneous,
    ) {
        self.records[slot as usize] = VertexRecord { planes, links, visited: 0, ideal, fresh: self.marks_fresh };
        self.positions[slot as usize] = Position(point);
    }

    /// Says where the edge at an end leads; the other end is to be told as well.
    #[inline(always)]
    pub(in crate::polytope) fn set_other_end(&mut self, end: Link, other: Link) {
        self.records[end.vertex() as usize].links[end.index()] = other;
    }
}
