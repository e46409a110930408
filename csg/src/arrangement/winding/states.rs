//! Combinations of winding numbers.

use rustc_hash::FxHashMap;

use crate::ids::{Id, StateId};

/// Winding numbers of operands, ascending; those that are zero are left out.
pub(in crate::arrangement) type Windings = Vec<(u32, i32)>;

/// The different combinations of winding numbers that there are.
#[derive(Debug, Default)]
pub(in crate::arrangement) struct States {
    pub(in crate::arrangement) windings: Vec<Windings>,
    number: FxHashMap<Windings, StateId>,
    steps: FxHashMap<(StateId, u32, bool), StateId>,
}

impl States {
    pub(super) fn number(&mut self, windings: Windings) -> StateId {
        let fresh = StateId::from_index(self.windings.len());
        let number = *self.number.entry(windings.clone()).or_insert(fresh);
        if number == fresh {
            self.windings.push(windings);
        }
        number
    }

    /// The combination in which the number of an operand is one more, or one less.
    pub(super) fn step(&mut self, state: StateId, operand: u32, is_up: bool) -> StateId {
        if let Some(found) = self.steps.get(&(state, operand, is_up)) {
            return *found;
        }
        let mut windings = self.windings[state.index()].clone();
        let by = if is_up { 1 } else { -1 };
        match windings.binary_search_by_key(&operand, |(operand, _)| *operand) {
            Ok(k) if windings[k].1 + by == 0 => {
                windings.remove(k);
            }
            Ok(k) => windings[k].1 += by,
            Err(k) => windings.insert(k, (operand, by)),
        }
        let found = self.number(windings);
        self.steps.insert((state, operand, is_up), found);
        found
    }
}
