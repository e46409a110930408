//! Flat arrays of planes and vertices with free lists: a clone is a few copies of memory.

use super::infinity;
use crate::half_space::HalfSpace;
use crate::sign::{Homogeneous, Row};

/// No plane, no vertex.
pub(super) const NONE: u32 = u32::MAX;

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

/// Planes by slot; the first slots hold the infinity planes.
#[derive(Debug, Clone, Default)]
pub(super) struct PlaneStore {
    pub(super) row: Vec<Row>,
    pub(super) half_space: Vec<HalfSpace>,
    pub(super) stamp: Vec<u64>,
    pub(super) state: Vec<PlaneState>,
    /// One vertex of the plane's face, [`NONE`] where it has no face.
    pub(super) face_vertex: Vec<u32>,
    /// Scratch of one operation: where a plane stands on the horizon or the ring.
    pub(super) mark: Vec<u32>,
    free: Vec<u32>,
    next_stamp: u64,
}

impl PlaneStore {
    /// Stores a plane with the next stamp.
    pub(super) fn insert(&mut self, half_space: HalfSpace, row: Row) -> u32 {
        let stamp = self.next_stamp;
        self.next_stamp += 1;
        self.insert_with_stamp(half_space, row, stamp)
    }

    /// Stores a plane with a stamp of the caller's.
    pub(super) fn insert_with_stamp(&mut self, half_space: HalfSpace, row: Row, stamp: u64) -> u32 {
        if let Some(slot) = self.free.pop() {
            let i = slot as usize;
            self.row[i] = row;
            self.half_space[i] = half_space;
            self.stamp[i] = stamp;
            self.face_vertex[i] = NONE;
            return slot;
        }
        let slot = self.row.len() as u32;
        self.row.push(row);
        self.half_space.push(half_space);
        self.stamp.push(stamp);
        self.state.push(PlaneState::Free);
        self.face_vertex.push(NONE);
        self.mark.push(NONE);
        slot
    }

    /// Forgets all planes, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.row.clear();
        self.half_space.clear();
        self.stamp.clear();
        self.state.clear();
        self.face_vertex.clear();
        self.mark.clear();
        self.free.clear();
        self.next_stamp = 0;
    }

    /// Gives a slot back.
    pub(super) fn remove(&mut self, slot: u32) {
        self.state[slot as usize] = PlaneState::Free;
        self.face_vertex[slot as usize] = NONE;
        self.free.push(slot);
    }
}

/// Vertices by slot.
#[derive(Debug, Clone, Default)]
pub(super) struct VertexStore {
    /// The three planes, counter-clockwise seen from outside; a free slot has [`NONE`] first.
    pub(super) planes: Vec<[u32; 3]>,
    /// The neighbour across the edge that does not lie on the plane of the same index.
    pub(super) neighbours: Vec<[u32; 3]>,
    /// The position for the filter: its constant part, or its part in `M` where an infinity plane takes part.
    pub(super) point: Vec<Homogeneous>,
    /// Scratch: the number of the last operation that visited the vertex.
    pub(super) visited: Vec<u32>,
    free: Vec<u32>,
    visit: u32,
    live: usize,
}

impl VertexStore {
    /// Stores a vertex, its neighbours still open.
    pub(super) fn insert(&mut self, planes: [u32; 3], point: Homogeneous) -> u32 {
        self.live += 1;
        if let Some(slot) = self.free.pop() {
            let i = slot as usize;
            self.planes[i] = planes;
            self.point[i] = point;
            self.neighbours[i] = [NONE; 3];
            return slot;
        }
        let slot = self.planes.len() as u32;
        self.planes.push(planes);
        self.neighbours.push([NONE; 3]);
        self.point.push(point);
        self.visited.push(0);
        slot
    }

    /// Forgets all vertices, keeping the memory.
    pub(super) fn clear(&mut self) {
        self.planes.clear();
        self.neighbours.clear();
        self.point.clear();
        self.visited.clear();
        self.free.clear();
        self.live = 0;
    }

    /// Gives a slot back.
    pub(super) fn remove(&mut self, slot: u32) {
        self.live -= 1;
        self.planes[slot as usize] = [NONE; 3];
        self.free.push(slot);
    }

    /// How many vertices there are.
    pub(super) fn len(&self) -> usize {
        self.live
    }

    /// All live slots.
    pub(super) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.planes.len() as u32).filter(|v| self.is_live(*v))
    }

    /// Whether a slot holds a vertex.
    pub(super) fn is_live(&self, slot: u32) -> bool {
        self.planes.get(slot as usize).is_some_and(|planes| planes[0] != NONE)
    }

    /// Whether an infinity plane takes part in a vertex.
    pub(super) fn is_ideal(&self, slot: u32) -> bool {
        self.planes[slot as usize].iter().any(|plane| infinity::is_infinity(*plane))
    }

    /// A number that no vertex's `visited` has yet.
    pub(super) fn begin_visit(&mut self) -> u32 {
        if self.visit == u32::MAX {
            self.visited.fill(0);
            self.visit = 0;
        }
        self.visit += 1;
        self.visit
    }

    /// At which index of a vertex a plane stands.
    pub(super) fn index_of(&self, slot: u32, plane: u32) -> usize {
        let planes = &self.planes[slot as usize];
        if planes[0] == plane {
            0
        } else if planes[1] == plane {
            1
        } else {
            debug_assert_eq!(planes[2], plane, "the plane passes through the vertex");
            2
        }
    }

    /// At which index of `slot` the neighbour `other` stands.
    pub(super) fn link_to(&self, slot: u32, other: u32) -> usize {
        let neighbours = &self.neighbours[slot as usize];
        if neighbours[0] == other {
            0
        } else if neighbours[1] == other {
            1
        } else {
            debug_assert_eq!(neighbours[2], other, "neighbours know each other");
            2
        }
    }

    /// The vertices of the face of `plane` in counter-clockwise order, beginning at `start`.
    pub(super) fn face_ring(&self, plane: u32, start: u32) -> impl Iterator<Item = u32> + '_ {
        let mut next = Some(start);
        std::iter::from_fn(move || {
            let vertex = next?;
            let k = self.index_of(vertex, plane);
            let following = self.neighbours[vertex as usize][(k + 1) % 3];
            next = (following != start).then_some(following);
            Some(vertex)
        })
    }
}
