//! Keys by which operands are in order, with room between them.

use rustc_hash::FxHashSet;

use super::{LiveTree, NodeId, Place, TreeOperand};
use crate::live::history::States;
use crate::live::{Change, EditError, LiveModel};

/// A place in the order of the operands of an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(in crate::live) struct OrderKey(u128);

/// How far apart the keys of operands are that are appended.
const APART: u128 = 1 << 96;

/// Where the first operand goes: as many can be put before it as after it.
const MIDDLE: u128 = 1 << 127;

/// Of the room between two operands this part is left on the side on which the next operand is less likely to come: one after another is put
/// behind, or before, the same operand.
const SHARE: u128 = 8;

/// On which side of operands to come there is to be more room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::live) enum Room {
    /// Before them.
    Before,
    /// Behind them.
    Behind,
}

impl OrderKey {
    pub(in crate::live) const FIRST: Self = Self(0);
    pub(super) const LAST: Self = Self(u128::MAX);

    /// The key of an operand among those that are there from the beginning.
    pub(in crate::live) fn of_index(index: usize) -> Self {
        Self(MIDDLE + APART * index as u128)
    }
}

/// Ascending keys between two others, or beyond one; nothing where there are not enough.
fn between(low: Option<OrderKey>, high: Option<OrderKey>, count: usize, room: Room) -> Option<Vec<OrderKey>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let number = count as u128;
    let (first, step) = match (low, high) {
        (None, None) => (MIDDLE, APART),
        (Some(low), None) => (low.0.checked_add(APART)?, APART),
        (None, Some(high)) => (high.0.checked_sub(APART.checked_mul(number)?)?, APART),
        (Some(low), Some(high)) => {
            let gap = high.0 - low.0;
            let step = gap / (number + SHARE - 1).max(2);
            match room {
                Room::Before => (high.0 - step * number, step),
                Room::Behind => (low.0 + step, step),
            }
        }
    };
    let last = first.checked_add(step.checked_mul(number - 1)?)?;
    let is_within = low.is_none_or(|low| low.0 < first) && high.is_none_or(|high| last < high.0);
    (step > 0 && first > 0 && is_within).then(|| (0..number).map(|k| OrderKey(first + step * k)).collect())
}

impl LiveTree {
    /// The last key among the operands of an operation.
    pub(super) fn last_key(&self, parent: Option<NodeId>) -> Option<OrderKey> {
        self.operands(parent).next_back().map(|(key, _)| key)
    }
}

/// What an edit of the order comes to.
pub(in crate::live) type Planned<T> = Result<Result<T, NoRoom>, EditError>;

/// Keys between two operands have run out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::live) struct NoRoom {
    parent: Option<NodeId>,
}

impl LiveModel {
    /// Places for operands before another one of an operation, or behind all; some operands are going to leave their places.
    pub(in crate::live) fn places_before(
        &self,
        parent: Option<NodeId>,
        before: Option<TreeOperand>,
        leaving: &FxHashSet<TreeOperand>,
        count: usize,
        room: Room,
    ) -> Planned<Vec<Place>> {
        let high = match before {
            Some(before) => {
                let place = self.place_of(before)?;
                if place.parent != parent {
                    return Err(EditError::NotAnOperand { operand: before, of: parent });
                }
                place.key
            }
            None => OrderKey::LAST,
        };
        let stays = |entry: &(OrderKey, TreeOperand)| !leaving.contains(&entry.1);
        let is_below = |entry: &(OrderKey, TreeOperand)| before.is_none() || entry.0 < high;
        let low = self.tree.operands_in(parent, OrderKey::FIRST..=high).rev().filter(is_below).find(stays);
        let above = self.tree.operands_in(parent, high..=OrderKey::LAST).filter(|entry| !is_below(entry)).find(stays);
        let keys = between(low.map(|entry| entry.0), above.map(|entry| entry.0), count, room);
        let places = keys.map(|keys| keys.into_iter().map(|key| Place { parent, key }).collect());
        Ok(places.ok_or(NoRoom { parent }))
    }

    /// The operand after another one.
    pub(in crate::live) fn next_operand(&self, place: Place) -> Option<TreeOperand> {
        let from = self.tree.operands_in(place.parent, place.key..=OrderKey::LAST);
        from.filter(|(key, _)| *key != place.key).map(|(_, operand)| operand).next()
    }

    /// Does an edit for which places are sought among other operands; where there is no room, these make it, as part of the edit.
    pub(in crate::live) fn edit_in_order<T>(
        &mut self,
        plan: impl Fn(&Self) -> Planned<(T, States)>,
    ) -> Result<(T, Change), EditError> {
        let NoRoom { parent } = match plan(self)? {
            Ok((found, new)) => return Ok((found, self.edit(new)?)),
            Err(none) => none,
        };
        if !self.is_step_open() {
            self.begin_step()?;
            let outcome = self.spread(parent).and_then(|_| self.edit_in_order(plan));
            match outcome {
                Ok(_) => drop(self.commit_step()?),
                Err(_) => drop(self.cancel_step()?),
            }
            return outcome;
        }
        self.spread(parent)?;
        self.edit_in_order(plan)
    }

    /// Gives the operands of an operation other keys, with room between them.
    fn spread(&mut self, parent: Option<NodeId>) -> Result<Change, EditError> {
        let mut new = States::default();
        for (index, (_, operand)) in self.tree.operands(parent).enumerate() {
            new.set_place(self, operand, Place { parent, key: OrderKey::of_index(index) })?;
        }
        self.edit(new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_between_those_around_them_as_long_as_there_is_room() {
        let (low, high) = (OrderKey::of_index(3), OrderKey::of_index(4));
        for room in [Room::Before, Room::Behind] {
            for (low, high) in [(None, None), (Some(low), None), (None, Some(high)), (Some(low), Some(high))] {
                for count in [0, 1, 2, 1000] {
                    let keys = between(low, high, count, room).unwrap();
                    let all: Vec<OrderKey> = low.into_iter().chain(keys.clone()).chain(high).collect();
                    assert!(keys.len() == count && all.is_sorted_by(|a, b| a < b), "{low:?} {high:?} {count}");
                }
            }
        }
        let mut last = high;
        let mut count = 0;
        while let Some(keys) = between(Some(low), Some(last), 1, Room::Before) {
            last = keys[0];
            count += 1;
        }
        assert!(count > 300, "{count}");
        assert_eq!(between(Some(OrderKey(7)), Some(OrderKey(8)), 1, Room::Behind), None);
        assert_eq!(between(None, Some(OrderKey(8)), 1, Room::Behind), None);
        assert_eq!(between(Some(OrderKey::LAST), None, 1, Room::Behind), None);
    }
}
