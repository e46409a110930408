//! Runs a script against the kernel and checks every single answer on the way.

use planecut_kernel::{AddPlaneResult, IncrementalPolytope, PlaneIdx};

use crate::exact::{Coefficients, half_space};
use crate::script::Op;

/// How often the interesting things happened, so that a test can tell that it tested them.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Tally {
    pub(crate) operations: usize,
    pub(crate) removals: usize,
    pub(crate) removed_redundant: usize,
    pub(crate) added_redundant: usize,
    /// A removal gave a face to a plane that had none.
    pub(crate) revealed: usize,
    pub(crate) emptied: usize,
    /// Steps after which the set was empty.
    pub(crate) empty: usize,
    /// A removal made an empty set come back.
    pub(crate) revived: usize,
    /// Steps after which the set was not empty but unbounded.
    pub(crate) unbounded: usize,
}

impl Tally {
    pub(crate) fn absorb(&mut self, other: &Tally) {
        self.operations += other.operations;
        self.removals += other.removals;
        self.removed_redundant += other.removed_redundant;
        self.added_redundant += other.added_redundant;
        self.revealed += other.revealed;
        self.emptied += other.emptied;
        self.empty += other.empty;
        self.revived += other.revived;
        self.unbounded += other.unbounded;
    }
}

/// A plane that is there.
struct Live {
    name: usize,
    index: PlaneIdx,
    plane: Coefficients,
}

/// A polytope and what must be true of it.
pub(crate) struct Replay {
    pub(crate) polytope: IncrementalPolytope,
    pub(crate) tally: Tally,
    live: Vec<Live>,
    last_stamp: Option<u64>,
}

impl Replay {
    pub(crate) fn new(polytope: IncrementalPolytope) -> Self {
        Self { polytope, tally: Tally::default(), live: Vec::new(), last_stamp: None }
    }

    /// Indices of the planes that are there, in the order of insertion.
    pub(crate) fn order(&self) -> Vec<PlaneIdx> {
        self.live.iter().map(|l| l.index).collect()
    }

    /// Coefficients of the planes that are there, in the order of insertion.
    pub(crate) fn planes(&self) -> Vec<Coefficients> {
        self.live.iter().map(|l| l.plane).collect()
    }

    /// Runs one operation. A `Remove` whose plane is not there (its `Add` was shrunk away) does nothing.
    ///
    /// # Errors
    /// An answer of the kernel that cannot be right.
    pub(crate) fn apply(&mut self, op: &Op) -> Result<(), String> {
        self.tally.operations += 1;
        match *op {
            Op::Add { name, plane } => self.add(name, plane)?,
            Op::Remove { name } => {
                if let Some(k) = self.live.iter().position(|l| l.name == name) {
                    self.remove(k)?;
                }
            }
        }
        self.tally.empty += usize::from(self.polytope.is_empty());
        self.tally.unbounded += usize::from(!self.polytope.is_bounded());
        self.check_planes()
    }

    fn add(&mut self, name: usize, plane: Coefficients) -> Result<(), String> {
        let was_empty = self.polytope.is_empty();
        let outcome = self.polytope.add_plane(half_space(plane));
        let index = outcome.plane();
        let (empty, redundant) = (self.polytope.is_empty(), self.polytope.is_redundant(index));
        let fits = match outcome {
            AddPlaneResult::Added { .. } => !empty && !redundant,
            AddPlaneResult::Redundant { .. } => !empty && redundant,
            AddPlaneResult::Empty { .. } => empty,
        };
        if !fits || (was_empty && !empty) {
            return Err(format!("{outcome:?}, but empty: {was_empty} then {empty}, redundant: {redundant}"));
        }
        let stamp = self.polytope.stamp(index);
        if stamp.is_none() || stamp <= self.last_stamp {
            return Err(format!("stamp {stamp:?} after {:?}", self.last_stamp));
        }
        if self.live.iter().any(|l| l.index == index) {
            return Err(format!("{index:?} was given twice"));
        }
        self.tally.added_redundant += usize::from(!empty && redundant);
        self.tally.emptied += usize::from(empty && !was_empty);
        self.last_stamp = stamp;
        self.live.push(Live { name, index, plane });
        Ok(())
    }

    fn remove(&mut self, k: usize) -> Result<(), String> {
        let Live { index, plane, .. } = self.live.remove(k);
        let hidden = self.hidden();
        let was_empty = self.polytope.is_empty();
        let was_redundant = self.polytope.is_redundant(index);
        let removed = self.polytope.remove_plane(index);
        let removed = removed.ok_or_else(|| format!("{index:?} is there, but remove_plane returned None"))?;
        if removed.half_space != half_space(plane) || removed.had_face != (!was_empty && !was_redundant) {
            return Err(format!("{removed:?}, but empty: {was_empty}, redundant: {was_redundant} before"));
        }
        if self.polytope.plane(index).is_some() || self.polytope.stamp(index).is_some() {
            return Err(format!("{index:?} is still there after its removal"));
        }
        if self.polytope.remove_plane(index).is_some() {
            return Err(format!("{index:?} was removed twice"));
        }
        let empty = self.polytope.is_empty();
        if !was_empty && empty {
            return Err("a removal made the set empty".into());
        }
        self.tally.removals += 1;
        self.tally.revived += usize::from(was_empty && !empty);
        if !was_empty {
            self.tally.removed_redundant += usize::from(was_redundant);
            self.tally.revealed += usize::from(hidden.iter().any(|&p| p != index && !self.polytope.is_redundant(p)));
        }
        Ok(())
    }

    fn hidden(&self) -> Vec<PlaneIdx> {
        self.live.iter().map(|l| l.index).filter(|&p| self.polytope.is_redundant(p)).collect()
    }

    /// The kernel lists exactly the planes that are there, as they were given.
    fn check_planes(&self) -> Result<(), String> {
        let mut listed: Vec<PlaneIdx> = self.polytope.planes().map(|(index, _)| index).collect();
        let mut expected = self.order();
        listed.sort_unstable();
        expected.sort_unstable();
        if listed != expected {
            return Err(format!("planes() lists {listed:?}, there are {expected:?}"));
        }
        for l in &self.live {
            if self.polytope.plane(l.index) != Some(&half_space(l.plane)) {
                return Err(format!("{:?} is no longer the plane that was given", l.index));
            }
        }
        let stamps = self.live.iter().map(|l| self.polytope.stamp(l.index));
        if stamps.clone().any(|s| s.is_none()) || !stamps.is_sorted_by(|a, b| a < b) {
            return Err("stamps changed or are out of order".into());
        }
        Ok(())
    }
}
