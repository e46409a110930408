//! How a change of brushes goes through planes, bodies, boundary and weld.

use std::sync::Arc;

use planecut_parallel::prelude::*;

use super::boundary::Found;
use super::history::New;
use super::operand::{Operand, Role, State};
use super::planes::{PlaneUse, Settled};
use super::reach::Reach;
use super::tree::Extent;
use super::{BrushId, Change, EditError, LiveModel};
use crate::boundary::BoundaryEdge;
use crate::evaluate::EvaluateError;
use crate::ids::{Id, OperandId};
use crate::model::Brush;
use crate::plane_table::size_of;

impl LiveModel {
    /// Gives brushes other states, and changes the boundary that those make which are no meshes; gives the states before.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`]; then all is as it was. [`EvaluateError::Weld`]: a bug in this crate.
    pub(super) fn change_convex(&mut self, new: Vec<New>, extent: &Extent) -> Result<(Change, Vec<New>), EditError> {
        if let Some(done) = self.move_in_place(&new) {
            return Ok(done);
        }
        let reach = Reach::of(extent);
        let (before, numbers, settled) = self.set_states(new, &[]);
        let mut changed = numbers.clone();
        changed.extend(settled.users.iter().filter(|user| self.operands[user.index()].is_some()));
        changed.extend(extent.brushes.iter().filter_map(|id| self.by_id.get(id)));
        changed.sort_unstable();
        changed.dedup();
        let reach = if changed.len() > numbers.len() && reach == Reach::Appended { Reach::Near } else { reach };
        let local = self.local(&changed, &before, extent);
        let bodies = self.build(&changed, &before);
        let old = self.place(bodies);
        let (faces, nearby) = self.faces_to_redo(&changed, &old, reach, &local);
        let found = self.find_boundary(&faces, &changed, nearby, reach);
        let outer = &self.outer;
        let is_outside =
            |edge: &BoundaryEdge| [edge.face, edge.edge, edge.start, edge.end].iter().any(|plane| outer.holds(*plane));
        let are_outside = |found: &Found| found.changes.iter().flat_map(|(_, change)| &change.added).any(is_outside);
        // what one thread has found it looks at itself: waking others takes longer than most edits
        let any_outside =
            if found.len() > 1 { found.par_iter().any(are_outside) } else { found.iter().any(are_outside) };
        if any_outside {
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
        self.exchange(&found);
        drop(found);
        self.buffers.faces = faces;
        let ids = changed.iter().filter_map(|number| self.operands[number.index()].as_ref());
        let mut brushes: Vec<BrushId> = ids.map(|operand| operand.id).collect();
        brushes.sort_unstable();
        self.forget(&numbers);
        self.welded.update(&self.planes.table).map_err(EvaluateError::from)?;
        self.free_planes(&settled.retired);
        let (removed, added) = self.welded.changes();
        Ok((Change { brushes, removed: removed.to_vec(), added: added.to_vec() }, before))
    }

    /// Sets what is said of brushes, and settles their planes; bodies stay. Gives what was said before, the numbers of the
    /// brushes, and what became of planes; `kept` are indices of planes that stay those of these planes.
    fn set_states(&mut self, new: Vec<New>, kept: &[u32]) -> (Vec<New>, Vec<OperandId>, Settled) {
        let (mut before, mut numbers) = (Vec::with_capacity(new.len()), Vec::with_capacity(new.len()));
        if new.len() > self.by_id.len() {
            self.planes.reserve(new.iter().flat_map(|(_, state)| state).map(|state| state.brush.faces.len()).sum());
        }
        for (id, state) in new {
            let known = self.by_id.get(&id).copied();
            assert!(known.is_some() || state.is_some(), "a brush that is to go is there");
            let number = known.unwrap_or_else(|| self.make_room(id));
            let operand = self.operands[number.index()].as_mut().expect("the brush is there");
            // planes that stay are in use all the time
            let mut old_uses: Vec<Option<PlaneUse>> = operand.uses.drain(..).map(Some).collect();
            let places = state.as_ref().map_or(Vec::new(), |state| state.places_in(&operand.state));
            let take = |place: &Option<usize>| place.and_then(|place| old_uses.get_mut(place)?.take());
            let staying: Vec<Option<PlaneUse>> = places.iter().map(take).collect();
            for (face, used) in operand.state.brush.faces.iter().zip(old_uses) {
                if let Some(used) = used {
                    self.planes.release(&face.half_space, used, number);
                }
            }
            operand.is_there = state.is_some();
            self.planes.count_size(operand.size.take(), false);
            operand.size = state.as_ref().and_then(|state| size_of(state.brush.half_spaces()));
            self.planes.count_size(operand.size, true);
            let old = match state {
                Some(state) => {
                    let faces = state.brush.faces.iter().zip(staying);
                    let planes = &mut self.planes;
                    let uses = faces.map(|(face, used)| used.unwrap_or_else(|| planes.take(&face.half_space, number)));
                    operand.uses.extend(uses);
                    std::mem::replace(&mut operand.state, state)
                }
                None => Arc::clone(&operand.state),
            };
            before.push((id, known.map(|_| old)));
            numbers.push(number);
        }
        (before, numbers, self.planes.settle(kept))
    }

    /// The number of a brush that is new.
    fn make_room(&mut self, id: BrushId) -> OperandId {
        let empty = State::new(Brush::default(), Role::Add);
        let operand = Operand {
            id,
            is_there: true,
            state: Arc::new(empty),
            size: None,
            uses: Vec::new(),
            body: None,
            mark: 0,
            edges: Vec::new(),
        };
        let number = self.free.pop().unwrap_or_else(|| OperandId::from_index(self.operands.len()));
        match self.operands.get_mut(number.index()) {
            Some(place) => *place = Some(operand),
            None => self.operands.push(Some(operand)),
        }
        self.by_id.insert(id, number);
        number
    }

    /// Frees the numbers of those of some brushes that are no longer there.
    fn forget(&mut self, numbers: &[OperandId]) {
        for &number in numbers {
            if let Some(gone) = self.operands[number.index()].take_if(|operand| !operand.is_there) {
                self.by_id.remove(&gone.id);
                self.free.push(number);
            }
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
