//! Adding a plane: climb to the extreme vertex, cut what it violates, close the hole with the new face.

use super::infinity::is_infinity;
use super::store::{Change, Farthest, PlaneState, Steps};
use super::{AddPlaneResult, IncrementalPolytope, VertexIdx, external};
use crate::half_space::HalfSpace;
use crate::sign::{OffsetColumn, Probe, Row};

/// How many climbs in a row find that nothing is to be cut before the places of all vertices are found.
const CLIMBS_BEFORE_PLACES: i32 = 2;
/// How many climbs are needed in spite of the places before these are given up.
const CLIMBS_IN_SPITE_OF_PLACES: i32 = 3;
/// How many climbs follow then before the places are tried again.
const CLIMBS_WITHOUT_PLACES: i32 = 30;

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
    /// Cost: a short climb, from where one in about this direction ended before, then proportional to the vertices cut away.
    pub fn add_plane(&mut self, half_space: HalfSpace) -> AddPlaneResult<'_> {
        let row = Row::new(&half_space);
        let slot = self.planes.insert(half_space, row);
        let plane = external(slot);
        if self.is_empty() {
            self.planes.set_without_face(slot, PlaneState::Pending);
            self.pending.push(slot);
            return AddPlaneResult::Empty { plane };
        }
        self.begin_change(Steps::One);
        let farthest = self.vertices.seemingly_farthest(&row);
        if let Some(Farthest { vertex, is_certain: true, is_inside: true }) = farthest {
            self.grow_starts();
            self.hide(slot, &row, vertex);
            return AddPlaneResult::Redundant { plane };
        }
        match self.insert_with_farthest(slot, &row, farthest) {
            Insertion::Cut => {
                let Change { removed, created, .. } = &self.change;
                AddPlaneResult::Added { plane, removed_vertices: removed, new_vertices: created }
            }
            Insertion::Redundant => AddPlaneResult::Redundant { plane },
            Insertion::Empty => {
                self.become_empty(slot);
                AddPlaneResult::Empty { plane }
            }
        }
    }

    /// Lets a stored plane take part; it must carry no certificate.
    pub(super) fn insert_into_structure(&mut self, plane: u32) -> Insertion {
        let row = *self.row(plane);
        let farthest = self.vertices.seemingly_farthest(&row);
        self.insert_with_farthest(plane, &row, farthest)
    }

    /// The same; `farthest` is what the places of the vertices tell, where they are known.
    #[inline(never)]
    fn insert_with_farthest(&mut self, plane: u32, row: &Row, farthest: Option<Farthest>) -> Insertion {
        self.grow_starts();
        let probe = Probe::new(row, OffsetColumn::Finite);
        let known_top = farthest.and_then(|farthest| self.certain_top(row, farthest));
        if let Some(top) = known_top
            && !self.violates(top, plane, &probe)
        {
            return self.hide(plane, row, top);
        }
        let start = self.start(row);
        let mut top = start;
        // a vertex that is cut away is as good a beginning as the extreme one
        if !self.violates(start, plane, &probe) {
            let is_outside;
            (top, is_outside) = match known_top {
                // it is known to be outside
                Some(top) => (top, true),
                None => self.climb_outside(row, start, plane, &probe),
            };
            if !is_outside {
                // a removal looks at these alone, and then changes what would be found
                if !is_infinity(plane) {
                    self.note_climb();
                }
                return self.hide(plane, row, top);
            }
        }
        self.scratch.climbs = self.scratch.climbs.min(0);
        if !self.collect_cut(plane, top, &probe) {
            return Insertion::Empty;
        }
        let face_vertex = self.cut_away(plane);
        self.note_start(row, plane, face_vertex);
        Insertion::Cut
    }

    /// Notes that a climb was needed to see that a plane is redundant. After several without a change in between, finding the
    /// places of all vertices pays, unless the directions are such that the places do not tell.
    #[inline(always)]
    fn note_climb(&mut self) {
        let climbs = &mut self.scratch.climbs;
        *climbs += 1;
        if self.vertices.are_places_known() {
            if *climbs > CLIMBS_IN_SPITE_OF_PLACES {
                self.vertices.forget_places();
                *climbs = -CLIMBS_WITHOUT_PLACES;
            }
        } else if *climbs == CLIMBS_BEFORE_PLACES {
            self.vertices.find_places();
            *climbs = 0;
        }
    }

    /// Notes that a plane is redundant, because `top` is the vertex that is extreme in its direction.
    #[inline(always)]
    fn hide(&mut self, plane: u32, row: &Row, top: u32) -> Insertion {
        self.note_start(row, self.vertices.planes(top)[0], top);
        self.certify(plane, top);
        Insertion::Redundant
    }

    /// Starts the record of what an operation changes.
    #[inline]
    pub(super) fn begin_change(&mut self, steps: Steps) {
        self.vertices.set_steps(steps);
        self.change.removed.clear();
        self.change.created.clear();
        self.change.moved.clear();
    }

    /// Takes vertices away: each counts as removed unless the same operation made it.
    #[inline]
    pub(super) fn discard_vertices(&mut self, gone: &[u32]) {
        let Self { vertices, change, .. } = self;
        if vertices.steps() == Steps::One {
            change.removed.extend(gone.iter().copied().map(VertexIdx));
        } else {
            for &vertex in gone {
                let is_fresh = vertices.take_fresh(vertex);
                // without a branch: in a batch, it would be mispredicted half the time
                change.removed.push(VertexIdx(vertex));
                change.removed.truncate(change.removed.len() - usize::from(is_fresh));
            }
        }
        vertices.remove_all(gone);
    }

    /// What an operation of several steps changed: vertices that it made and took away again are left out.
    #[inline]
    pub(super) fn finish_change(&mut self) -> &Change {
        if self.vertices.steps() == Steps::One {
            return &self.change;
        }
        let created = &mut self.change.created;
        let mut kept = 0;
        for at in 0..created.len() {
            let vertex = created[at];
            created[kept] = vertex;
            kept += usize::from(self.vertices.take_fresh(vertex.0));
        }
        created.truncate(kept);
        &self.change
    }
}
