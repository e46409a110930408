//! How a change of brushes goes through planes, bodies, skin and weld.

use std::sync::Arc;

use planecut_kernel::IncrementalPolytope;

use super::history::New;
use super::operand::{Operand, Role, State};
use super::planes::Settled;
use super::{BrushId, Change, EditError, LiveModel};
use crate::base::map_chunks;
use crate::body::{Body, BodyFace, BrushBody, built_or_build, mark_of};
use crate::boundary::{BoundaryEdge, misses};
use crate::evaluate::{EvaluateError, UnboundedBrushes};
use crate::model::{Brush, MaterialId};
use crate::plane_table::PlaneId;
use crate::weld::EdgeId;

/// How far a change of brushes reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// To what they or their old bodies touch.
    Near,
    /// To the boundary near them: they are the last ones, and new.
    Appended,
    /// To everything, as what lies outside of an intersecting brush is taken away.
    Everywhere,
}

/// A body in the place of which another is put, or was, and for each of its faces the edges of the boundary on it.
struct Placed {
    number: u32,
    body: Option<Body>,
    edges: Vec<Vec<(BoundaryEdge, EdgeId)>>,
}

impl LiveModel {
    /// Gives brushes other states; gives the ones before.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`]; then all is as it was. [`EvaluateError::Weld`]: a bug in this crate.
    pub(super) fn change(&mut self, new: Vec<New>) -> Result<(Change, Vec<New>), EditError> {
        let reach = self.reach(&new);
        let (before, numbers, settled) = self.set_states(new, &[]);
        let mut changed = numbers.clone();
        changed.extend(settled.users.iter().filter(|user| self.operands[**user as usize].is_some()));
        changed.sort_unstable();
        changed.dedup();
        let reach = if changed.len() > numbers.len() && reach == Reach::Appended { Reach::Near } else { reach };
        let bodies = self.build(&changed);
        let old = self.place(bodies);
        let faces = self.faces_to_redo(&changed, &old, reach);
        let found = self.skin(&faces);
        let outer = &self.outer;
        let is_outside =
            |edge: &BoundaryEdge| [edge.face, edge.edge, edge.start, edge.end].iter().any(|plane| outer.holds(*plane));
        if found.iter().flat_map(|(edges, _)| edges).any(is_outside) {
            self.place(old);
            let (_, numbers, unsettled) = self.set_states(before, &settled.retired);
            self.forget(&numbers);
            unsettled.retired.iter().for_each(|index| self.planes.free(*index));
            self.buffers.faces = faces;
            return Err(EvaluateError::Unbounded.into());
        }
        for (_, edge) in old.into_iter().flat_map(|placed| placed.edges).flatten() {
            self.welded.remove(edge);
        }
        self.exchange(&faces, found);
        self.buffers.faces = faces;
        let ids = changed.iter().filter_map(|number| self.operands[*number as usize].as_ref());
        let mut brushes: Vec<BrushId> = ids.map(|operand| BrushId(operand.id)).collect();
        brushes.sort_unstable();
        self.forget(&numbers);
        self.welded.update(&self.planes.table).map_err(EvaluateError::from)?;
        self.free_planes(&settled.retired);
        let (removed, added) = self.welded.changes();
        Ok((Change { brushes, removed: removed.to_vec(), added: added.to_vec() }, before))
    }

    fn reach(&self, new: &[New]) -> Reach {
        let role_now = |id: u64| {
            let operand = self.by_id.get(&id).and_then(|number| self.operands[*number as usize].as_ref());
            operand.map(|operand| operand.state.role)
        };
        let intersects_differently = |(id, state): &New| {
            let roles = [role_now(*id), state.as_ref().map(|state| state.role)];
            self.is_in_sequence(*id) && roles[0] != roles[1] && roles.contains(&Some(Role::Intersect))
        };
        let last = self.by_id.last_key_value().map(|(id, _)| *id);
        if new.iter().any(intersects_differently) {
            Reach::Everywhere
        } else if new.iter().all(|(id, _)| self.is_in_sequence(*id) && last.is_none_or(|last| *id > last)) {
            Reach::Appended
        } else {
            Reach::Near
        }
    }

    /// Sets what is said of brushes, and settles their planes; bodies stay. Gives what was said before, the numbers of the
    /// brushes, and what became of planes; `kept` are indices of planes that stay those of these planes.
    fn set_states(&mut self, new: Vec<New>, kept: &[u32]) -> (Vec<New>, Vec<u32>, Settled) {
        let (mut before, mut numbers) = (Vec::with_capacity(new.len()), Vec::with_capacity(new.len()));
        for (id, state) in new {
            let known = self.by_id.get(&id).copied();
            let Some(number) = known.or_else(|| state.as_ref().map(|_| self.make_room(id))) else { continue };
            let is_in_sequence = self.is_in_sequence(id);
            let operand = self.operands[number as usize].as_mut().expect("the brush is there");
            for (face, used) in operand.state.brush.faces.iter().zip(operand.uses.drain(..)) {
                self.planes.release(&face.half_space, used, number);
            }
            operand.is_there = state.is_some();
            self.intersecting.retain(|entry| entry.0 != id);
            let old = match state {
                Some(state) => {
                    let faces = state.brush.faces.iter();
                    operand.uses.extend(faces.map(|face| self.planes.take(&face.half_space, number)));
                    if state.role == Role::Intersect && is_in_sequence {
                        self.intersecting.push((id, number));
                    }
                    std::mem::replace(&mut operand.state, state)
                }
                None => Arc::clone(&operand.state),
            };
            before.push((id, known.map(|_| old)));
            numbers.push(number);
        }
        self.intersecting.sort_unstable();
        (before, numbers, self.planes.settle(kept))
    }

    /// The number of a brush that is new.
    fn make_room(&mut self, id: u64) -> u32 {
        let empty = State { brush: Brush::default(), planes: Vec::new(), next_plane: 0, role: Role::Add };
        let operand = Operand {
            id,
            is_there: true,
            state: Arc::new(empty),
            uses: Vec::new(),
            body: None,
            mark: 0,
            edges: Vec::new(),
        };
        let number = self.free.pop().unwrap_or(self.operands.len() as u32);
        match self.operands.get_mut(number as usize) {
            Some(place) => *place = Some(operand),
            None => self.operands.push(Some(operand)),
        }
        self.by_id.insert(id, number);
        number
    }

    /// Frees the numbers of those of some brushes that are no longer there.
    fn forget(&mut self, numbers: &[u32]) {
        for &number in numbers {
            if let Some(gone) = self.operands[number as usize].take_if(|operand| !operand.is_there) {
                self.by_id.remove(&gone.id);
                self.free.push(number);
            }
        }
    }

    /// The bodies of brushes as they are now; none for those that are gone.
    fn build(&mut self, numbers: &[u32]) -> Vec<Placed> {
        const MANY: usize = 32;
        let mut polytope = std::mem::take(&mut self.buffers.polytope);
        let build = |number: u32, polytope: &mut IncrementalPolytope| {
            let operand = self.operands[number as usize].as_ref().expect("the brush is there");
            let body = if operand.is_there { self.body(operand, polytope) } else { None };
            let edges = body.as_ref().map_or(Vec::new(), |body| vec![Vec::new(); body.faces.len()]);
            Placed { number, body, edges }
        };
        let placed = if numbers.len() < MANY {
            numbers.iter().map(|number| build(*number, &mut polytope)).collect()
        } else {
            let (chunks, _) = map_chunks(numbers, MANY, |chunk| {
                let mut polytope = IncrementalPolytope::with_epsilon(0.0);
                chunk.iter().map(|number| build(*number, &mut polytope)).collect::<Vec<Placed>>()
            });
            chunks.into_iter().flatten().collect()
        };
        self.buffers.polytope = polytope;
        placed
    }

    fn body(&self, operand: &Operand, polytope: &mut IncrementalPolytope) -> Option<Body> {
        let table = &self.planes.table;
        let planes: Vec<PlaneId> = operand.uses.iter().map(|used| self.planes.id(*used)).collect();
        let brush = &operand.state.brush;
        let bounded = match built_or_build(table, &self.built, brush, &planes, polytope) {
            BrushBody::Unbounded if self.unbounded == UnboundedBrushes::Keep => {
                let materials: Vec<MaterialId> = brush.faces.iter().map(|face| face.material).collect();
                self.outer.cut(table, &planes, &materials)
            }
            other => other,
        };
        match bounded {
            BrushBody::Bounded(body, _) => Some(body),
            BrushBody::Empty | BrushBody::Unbounded => None,
        }
    }

    /// Puts bodies in the place of others; gives these. Edges on faces of the same plane and material go over to the body
    /// that is there now.
    fn place(&mut self, bodies: Vec<Placed>) -> Vec<Placed> {
        self.bodies_on_plane.resize(self.planes.table.len(), 0);
        let mut place = |mut placed: Placed| {
            let operand = self.operands[placed.number as usize].as_mut().expect("the brush is there");
            if let Some(old) = &operand.body {
                self.places.remove(&old.bounds, placed.number);
                for face in &old.faces {
                    let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                    *count -= u8::from(*count < u8::MAX);
                }
            }
            if let Some(new) = &placed.body {
                self.places.insert(&new.bounds, placed.number);
                for face in &new.faces {
                    let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                    *count = count.saturating_add(1);
                }
                operand.mark = mark_of(&new.faces);
            }
            std::mem::swap(&mut operand.body, &mut placed.body);
            std::mem::swap(&mut operand.edges, &mut placed.edges);
            if let (Some(new), Some(old)) = (&operand.body, &placed.body) {
                for (face, edges) in new.faces.iter().zip(&mut operand.edges) {
                    let is_same = |other: &BodyFace| (other.plane, other.material) == (face.plane, face.material);
                    let place = old.place_on(face.plane).filter(|place| is_same(&old.faces[*place]));
                    if let Some(place) = place {
                        std::mem::swap(edges, &mut placed.edges[place]);
                    }
                }
            }
            placed
        };
        bodies.into_iter().map(&mut place).collect()
    }

    /// The faces, sorted, on which the boundary may differ: those of the bodies that have changed, and those of others that
    /// reach into them or into what they were.
    fn faces_to_redo(&mut self, changed: &[u32], old: &[Placed], reach: Reach) -> Vec<(u32, u32)> {
        let mut faces = std::mem::take(&mut self.buffers.faces);
        faces.clear();
        let all_of = |number: u32| {
            let body = super::body_of(&self.operands, number);
            (0..body.map_or(0, |body| body.faces.len()) as u32).map(move |face| (number, face))
        };
        if reach == Reach::Everywhere || changed.len() >= self.by_id.len() {
            faces.extend((0..self.operands.len() as u32).flat_map(all_of));
        } else {
            let new = changed.iter().filter_map(|number| super::body_of(&self.operands, *number));
            new.for_each(|body| self.touch(body, reach == Reach::Appended, &mut faces));
            old.iter().filter_map(|placed| placed.body.as_ref()).for_each(|body| self.touch(body, false, &mut faces));
            faces.extend(changed.iter().copied().flat_map(all_of));
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Notes the faces that may reach into a body. A body that comes last and does not intersect can only take away from the
    /// boundary on them, but where it has a face on their plane.
    fn touch(&self, by: &Body, is_last: bool, faces: &mut Vec<(u32, u32)>) {
        let (bounds, table) = (&by.bounds, &self.planes.table);
        for other in self.places.near(bounds) {
            let Some(Operand { body: Some(body), edges, .. }) = &self.operands[other as usize] else { continue };
            let reaches = |(number, face): &(u32, &BodyFace)| {
                let half_space = table.half_space(face.plane);
                let may_matter = || !is_last || !edges[*number as usize].is_empty() || by.face_on(face.plane).is_some();
                face.bounds.may_share_area(bounds)
                    && may_matter()
                    && !misses(bounds, half_space.normal(), half_space.offset())
                    && !by.is_surely_apart_from(table, body.corners(face))
            };
            faces.extend((0..).zip(&body.faces).filter(reaches).map(|(face, _)| (other, face)));
        }
    }

    /// Frees the indices of planes that are not used any more, but those by which points and lines are still known.
    fn free_planes(&mut self, retired: &[u32]) {
        self.waiting.extend(retired);
        let unnamed: Vec<u32> = self.welded.take_unnamed();
        for index in retired.iter().chain(&unnamed) {
            if !self.welded.names(*index) && self.waiting.remove(index) {
                self.bodies_on_plane[*index as usize] = 0;
                self.planes.free(*index);
            }
        }
    }
}
