//! Adding a plane: climb to the extreme vertex, cut what it violates, close the hole with the new face.

use super::redundant::Link;
use super::store::{NONE, PlaneState};
use super::{AddPlaneResult, IncrementalPolytope, external};
use crate::half_space::HalfSpace;
use crate::sign::Row;

/// What inserting one plane into the structure did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Insertion {
    /// It has a face now.
    Cut,
    /// It is redundant.
    Redundant,
    /// Every vertex violates it; nothing was changed.
    Empty,
}

impl IncrementalPolytope {
    /// Adds a half-space: the set becomes its intersection with it (paper §3 and Appendix C; orphaned faces need no
    /// repair here, because the structure is simple).
    ///
    /// Cost: a climb from the place of the last change, then proportional to the vertices cut away.
    pub fn add_plane(&mut self, half_space: HalfSpace) -> AddPlaneResult {
        let slot = self.planes.insert(half_space, Row::new(&half_space));
        self.certificates.grow_to(self.planes.row.len());
        let plane = external(slot);
        if self.is_empty() {
            self.planes.state[slot as usize] = PlaneState::Pending;
            self.pending.push(slot);
            return AddPlaneResult::Empty { plane };
        }
        match self.insert_into_structure(slot) {
            Insertion::Cut => AddPlaneResult::Added { plane },
            Insertion::Redundant => AddPlaneResult::Redundant { plane },
            Insertion::Empty => {
                self.become_empty(slot);
                AddPlaneResult::Empty { plane }
            }
        }
    }

    /// Lets a stored plane take part; it must carry no certificate.
    pub(super) fn insert_into_structure(&mut self, plane: u32) -> Insertion {
        let top = self.climb(self.row(plane), self.hint);
        self.hint = top;
        if !self.is_outside(top, plane) {
            self.certify(plane, top);
            return Insertion::Redundant;
        }
        if !self.collect_cut(plane, top) {
            return Insertion::Empty;
        }
        self.cut_away(plane);
        Insertion::Cut
    }

    /// Collects all vertices outside `plane` into the scratch, beginning with `top`; false where no vertex is left.
    pub(super) fn collect_cut(&mut self, plane: u32, top: u32) -> bool {
        let visit = self.vertices.begin_visit();
        let mut cut = std::mem::take(&mut self.scratch.cut);
        cut.clear();
        cut.push(top);
        self.vertices.visited[top as usize] = visit;
        let mut some_stay = false;
        let mut next = 0;
        while let Some(&vertex) = cut.get(next) {
            next += 1;
            for neighbour in self.vertices.neighbours[vertex as usize] {
                if self.vertices.visited[neighbour as usize] == visit {
                    continue;
                }
                if self.is_outside(neighbour, plane) {
                    self.vertices.visited[neighbour as usize] = visit;
                    cut.push(neighbour);
                } else {
                    some_stay = true;
                }
            }
        }
        self.scratch.cut = cut;
        some_stay
    }

    /// Replaces the collected vertices by the face of `plane`.
    fn cut_away(&mut self, plane: u32) {
        let cut = std::mem::take(&mut self.scratch.cut);
        let mut created = std::mem::take(&mut self.scratch.created);
        created.clear();
        self.create_horizon(plane, &cut, &mut created);
        self.link_horizon(plane, &created);
        self.planes.state[plane as usize] = PlaneState::Face;
        self.planes.face_vertex[plane as usize] = created[0];
        self.hint = created[0];
        self.hide_orphans(plane, &cut);
        for &vertex in &created {
            let planes = self.vertices.planes[vertex as usize];
            self.planes.mark[planes[1] as usize] = NONE;
        }
        for &vertex in &cut {
            self.vertices.remove(vertex);
        }
        self.scratch.cut = cut;
        self.scratch.created = created;
    }

    /// One new vertex `(plane, p, q)` for each edge that leaves the cut vertices; `mark[p]` remembers it.
    fn create_horizon(&mut self, plane: u32, cut: &[u32], created: &mut Vec<u32>) {
        let visit = self.vertices.visited[cut[0] as usize];
        for &vertex in cut {
            let planes = self.vertices.planes[vertex as usize];
            let neighbours = self.vertices.neighbours[vertex as usize];
            for k in 0..3 {
                let kept = neighbours[k];
                if self.vertices.visited[kept as usize] == visit {
                    continue;
                }
                // The cut vertex (a, p, q) moves to where its edge p, q meets the plane.
                let (p, q) = (planes[(k + 1) % 3], planes[(k + 2) % 3]);
                let point = self.meeting_point([plane, p, q]);
                let fresh = self.vertices.insert([plane, p, q], point);
                self.vertices.visited[fresh as usize] = 0;
                let back = self.vertices.link_to(kept, vertex);
                self.vertices.neighbours[kept as usize][back] = fresh;
                self.vertices.neighbours[fresh as usize][0] = kept;
                self.planes.mark[p as usize] = fresh;
                self.planes.face_vertex[p as usize] = fresh;
                created.push(fresh);
            }
        }
    }

    /// Links the new vertices around the new face: `(plane, p, q)` is followed by the one that has `q` in second place.
    fn link_horizon(&mut self, plane: u32, created: &[u32]) {
        for &vertex in created {
            let [_, _, q] = self.vertices.planes[vertex as usize];
            let following = self.planes.mark[q as usize];
            debug_assert_eq!(self.vertices.planes[following as usize][0], plane);
            self.vertices.neighbours[vertex as usize][1] = following;
            self.vertices.neighbours[following as usize][2] = vertex;
        }
    }

    /// Planes that lost all their vertices ("orphaned faces", paper Appendix C) are redundant from now on.
    fn hide_orphans(&mut self, plane: u32, cut: &[u32]) {
        for &vertex in cut {
            for p in self.vertices.planes[vertex as usize] {
                let on_horizon = self.planes.mark[p as usize] != NONE;
                if !on_horizon && self.planes.state[p as usize] == PlaneState::Face {
                    self.planes.state[p as usize] = PlaneState::Uncertified;
                    self.planes.face_vertex[p as usize] = NONE;
                    self.certificates.push_uncertified(Link { plane: p, hidden_by: plane });
                }
            }
        }
    }
}
