//! Copies of brushes.
//!
//! A copy stands directly behind what it is a copy of, so that it does to all others what that does: the copy of a hole is a hole in what was there before the hole, and not in what was added later. Where operands are
//! intersected, or one of them is what others are taken from, a brush and its copies are one operand together, as their union.

use std::sync::Arc;

use planecut_kernel::HalfSpace;
use rustc_hash::FxHashSet;

use super::history::States;
use super::operand::State;
use super::tree::{NodeState, OrderKey, Place, Planned, Room};
use super::{BrushId, Change, EditError, LiveModel, NodeId, Role, TreeOperand};
use crate::model::{Operation, Transform};

/// Maximum number of copies that one edit makes.
const MOST_COPIES: usize = 1 << 20;

impl LiveModel {
    /// Copies brushes, each to where a map takes it. A copy has the role, the materials and the name of what it is a copy of, and comes directly behind it; of a brush that intersects, or is the first operand of a
    /// difference or one of an intersection, the copy and it are one operand together, as their union. Gives the numbers of the copies.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Twice`], [`EditError::Copies`], [`EditError::Transform`], [`EditError::Evaluate`].
    pub fn copy_brushes(
        &mut self,
        brushes: &[BrushId],
        transform: &Transform,
    ) -> Result<(Vec<BrushId>, Change), EditError> {
        self.add_copies(brushes, &[*transform])
    }

    /// The same by the mirror image in a plane, of which either side may be given. In planes across an axis it is exact: normals are not rounded, and offsets once.
    ///
    /// # Errors
    /// As of [`copy_brushes`](Self::copy_brushes).
    pub fn mirror_brushes(
        &mut self,
        brushes: &[BrushId],
        plane: &HalfSpace,
    ) -> Result<(Vec<BrushId>, Change), EditError> {
        self.add_copies(brushes, &[Transform::mirror_at(plane)?])
    }

    /// Copies brushes several times, each copy moved on by a map from the one before it. Gives the numbers of the first copies of all, then of the second ones, and so on.
    ///
    /// # Errors
    /// As of [`copy_brushes`](Self::copy_brushes).
    pub fn array_brushes(
        &mut self,
        brushes: &[BrushId],
        transform: &Transform,
        count: usize,
    ) -> Result<(Vec<BrushId>, Change), EditError> {
        check_count(brushes.len().saturating_mul(count))?;
        let mut transforms: Vec<Transform> = Vec::with_capacity(count);
        while transforms.len() < count {
            transforms.push(match transforms.last() {
                Some(last) => last.then(transform)?,
                None => *transform,
            });
        }
        self.add_copies(brushes, &transforms)
    }

    fn add_copies(
        &mut self,
        brushes: &[BrushId],
        transforms: &[Transform],
    ) -> Result<(Vec<BrushId>, Change), EditError> {
        check_count(brushes.len().saturating_mul(transforms.len()))?;
        let mut seen = FxHashSet::default();
        if let Some(twice) = brushes.iter().find(|id| !seen.insert(**id)) {
            return Err(EditError::Twice(TreeOperand::Brush(*twice)));
        }
        let mut moved: Vec<State> = Vec::with_capacity(brushes.len() * transforms.len());
        for transform in transforms {
            for id in brushes {
                let state = self.state(*id)?;
                let State { role, line, .. } = **state;
                let brush = state.brush.clone().transformed(transform)?;
                moved.push(State { line, ..State::new(brush, role) });
            }
        }
        let first = self.next_id;
        let ids: Vec<BrushId> = (first..).map(BrushId).take(moved.len()).collect();
        let (_, change) = self.edit_in_order(|model| model.with_copies(brushes, &moved, &ids))?;
        self.next_id += ids.len() as u64;
        Ok((ids, change))
    }

    /// The states that put copies behind brushes; `moved` are the first copies of all, then the second ones, and so on.
    fn with_copies(&self, brushes: &[BrushId], moved: &[State], ids: &[BrushId]) -> Planned<((), States)> {
        let mut new = States::default();
        let mut nodes = self.tree.new_nodes();
        let times = moved.len() / brushes.len().max(1);
        if times == 0 {
            return Ok(Ok(((), new)));
        }
        for (which, original) in brushes.iter().enumerate() {
            let State { place, role, .. } = **self.state(*original)?;
            let is_one_operand = self.tree.is_needed(place) || (place.parent.is_none() && role == Role::Intersect);
            let places = if is_one_operand {
                let node: NodeId = nodes.next().expect("numbers do not end");
                let within = |index| Place { parent: Some(node), key: OrderKey::of_index(index) };
                new.nodes.insert(node, Some(NodeState { operation: Operation::Union, role, place }));
                new.set_place(self, TreeOperand::Brush(*original), within(0))?;
                (1..=times).map(within).collect()
            } else {
                let next = self.next_operand(place);
                match self.places_before(place.parent, next, &FxHashSet::default(), times, Room::Before)? {
                    Ok(places) => places,
                    Err(none) => return Ok(Err(none)),
                }
            };
            for (time, place) in places.into_iter().enumerate() {
                let at = time * brushes.len() + which;
                new.brushes.insert(ids[at], Some(Arc::new(State { place, ..moved[at].clone() })));
            }
        }
        Ok(Ok(((), new)))
    }
}

fn check_count(found: usize) -> Result<(), EditError> {
    if found > MOST_COPIES { Err(EditError::Copies { found, limit: MOST_COPIES }) } else { Ok(()) }
}
