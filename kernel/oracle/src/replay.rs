//! Runs a script against the kernel and checks every single answer on the way.

use planecut_kernel::{AddPlaneResult, IncrementalPolytope, PlaneIdx};

use crate::exact::Coefficients;
use crate::handles::{Changes, Handles};
use crate::kernel_calls::{half_space, move_plane, remove_planes};
use crate::script::Op;
use crate::structure::Structure;

/// How often the interesting things happened, so that a test can tell that it tested them.
#[derive(Debug, Default, Clone, Copy)]
pub struct Tally {
    /// Operations done.
    pub operations: usize,
    /// Single planes removed.
    pub removals: usize,
    /// Planes removed that had no face.
    pub removed_redundant: usize,
    /// Planes added that got no face.
    pub added_redundant: usize,
    /// A removal gave a face to a plane that had none.
    pub revealed: usize,
    /// Additions that made the set empty.
    pub emptied: usize,
    /// Steps after which the set was empty.
    pub empty: usize,
    /// A removal made an empty set come back.
    pub revived: usize,
    /// Steps after which the set was not empty but unbounded.
    pub unbounded: usize,
    /// Planes moved.
    pub moved: usize,
}

impl Tally {
    /// Adds the counts of another run.
    pub fn absorb(&mut self, other: &Tally) {
        self.operations += other.operations;
        self.removals += other.removals;
        self.removed_redundant += other.removed_redundant;
        self.added_redundant += other.added_redundant;
        self.revealed += other.revealed;
        self.emptied += other.emptied;
        self.empty += other.empty;
        self.revived += other.revived;
        self.unbounded += other.unbounded;
        self.moved += other.moved;
    }
}

/// A plane that is there.
struct Live {
    name: usize,
    index: PlaneIdx,
    plane: Coefficients,
}

/// A polytope and what must be true of it.
pub struct Replay {
    /// The polytope as it is now.
    pub polytope: IncrementalPolytope,
    /// What has happened so far.
    pub tally: Tally,
    live: Vec<Live>,
    last_stamp: Option<u64>,
    handles: Handles,
    /// The polytope that was cloned before the last operation, and what it was.
    original: Option<(IncrementalPolytope, Vec<PlaneIdx>, Structure)>,
}

impl Replay {
    /// Starts from `polytope`, which must be all of space.
    #[must_use]
    pub fn new(polytope: IncrementalPolytope) -> Self {
        Self {
            polytope,
            tally: Tally::default(),
            live: Vec::new(),
            last_stamp: None,
            handles: Handles::new(),
            original: None,
        }
    }

    /// Indices of the planes that are there, in the order of insertion.
    #[must_use]
    pub fn order(&self) -> Vec<PlaneIdx> {
        self.live.iter().map(|l| l.index).collect()
    }

    /// Coefficients of the planes that are there, in the order of insertion.
    #[must_use]
    pub fn planes(&self) -> Vec<Coefficients> {
        self.live.iter().map(|l| l.plane).collect()
    }

    /// Runs one operation. A `Remove` whose plane is not there (its `Add` was shrunk away) does nothing.
    ///
    /// # Errors
    /// An answer of the kernel that cannot be right.
    pub fn apply(&mut self, op: &Op) -> Result<(), String> {
        self.tally.operations += 1;
        let original = self.original.take();
        match op {
            Op::Add { name, plane } => self.add(*name, *plane)?,
            Op::Remove { name } => {
                if let Some(k) = self.live.iter().position(|l| l.name == *name) {
                    self.remove(k)?;
                }
            }
            Op::RemoveMany { names } => self.remove_many(names)?,
            Op::Move { name, plane } => {
                if let Some(k) = self.live.iter().position(|l| l.name == *name) {
                    self.move_to(k, *plane)?;
                }
            }
            Op::Clone => self.clone_polytope()?,
            Op::Clear => self.clear(),
        }
        if let Some((polytope, order, before)) = original {
            let after = Structure::of(&polytope, &order)?;
            if after != before {
                return Err(format!("a change of the clone changed the original from {before:?} to {after:?}"));
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
        let mut changes = Changes::default();
        if let AddPlaneResult::Added { removed_vertices, new_vertices, .. } = outcome {
            changes = Changes { removed: removed_vertices.to_vec(), new: new_vertices.to_vec(), moved: Vec::new() };
        }
        let claimed = match outcome {
            AddPlaneResult::Added { .. } => "Added",
            AddPlaneResult::Redundant { .. } => "Redundant",
            AddPlaneResult::Empty { .. } => "Empty",
        };
        let (empty, redundant) = (self.polytope.is_empty(), self.polytope.is_redundant(index));
        let fits = claimed == if empty { "Empty" } else { ["Added", "Redundant"][usize::from(redundant)] };
        if !fits || (was_empty && !empty) {
            return Err(format!("{claimed}, but empty: {was_empty} then {empty}, redundant: {redundant}"));
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
        self.handles.update(&changes, &self.polytope)
    }

    fn remove(&mut self, k: usize) -> Result<(), String> {
        let Live { index, plane, .. } = self.live.remove(k);
        let hidden = self.hidden();
        let was_empty = self.polytope.is_empty();
        let was_redundant = self.polytope.is_redundant(index);
        let removed = self.polytope.remove_plane(index);
        let removed = removed.ok_or_else(|| format!("{index:?} is there, but remove_plane returned None"))?;
        let (gone, new) = (removed.removed_vertices.to_vec(), removed.new_vertices.to_vec());
        let (half_space_was, had_face) = (removed.half_space, removed.had_face);
        if half_space_was != half_space(plane) || had_face != (!was_empty && !was_redundant) {
            return Err(format!(
                "{half_space_was:?} with a face: {had_face}, but empty: {was_empty}, redundant: {was_redundant} before"
            ));
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
        self.handles.update(&Changes { removed: gone, new, moved: Vec::new() }, &self.polytope)
    }

    fn remove_many(&mut self, names: &[usize]) -> Result<(), String> {
        let (gone, left): (Vec<Live>, Vec<Live>) = self.live.drain(..).partition(|l| names.contains(&l.name));
        self.live = left;
        let (hidden, was_empty) = (self.hidden(), self.polytope.is_empty());
        let planes: Vec<PlaneIdx> = gone.iter().map(|l| l.index).collect();
        let (removed, changes) = remove_planes(&mut self.polytope, &planes);
        if removed != planes.len() {
            return Err(format!("remove_planes removed {removed} of {planes:?}"));
        }
        if remove_planes(&mut self.polytope, &planes).0 != 0 {
            return Err(format!("{planes:?} were removed twice"));
        }
        let empty = self.polytope.is_empty();
        if !was_empty && empty {
            return Err("a removal made the set empty".into());
        }
        self.tally.removals += removed;
        self.tally.revived += usize::from(was_empty && !empty);
        self.tally.revealed += usize::from(!was_empty && hidden.iter().any(|&p| !self.polytope.is_redundant(p)));
        self.handles.update(&changes, &self.polytope)
    }

    fn move_to(&mut self, k: usize, plane: Coefficients) -> Result<(), String> {
        let changes = move_plane(&mut self.polytope, self.live[k].index, half_space(plane))?;
        self.live[k].plane = plane;
        self.tally.moved += 1;
        self.handles.update(&changes, &self.polytope)
    }

    fn clone_polytope(&mut self) -> Result<(), String> {
        let order = self.order();
        let structure = Structure::of(&self.polytope, &order)?;
        let copy = self.polytope.clone();
        self.original = Some((std::mem::replace(&mut self.polytope, copy), order, structure));
        Ok(())
    }

    fn clear(&mut self) {
        self.polytope.clear();
        self.live.clear();
        self.handles = Handles::new();
        self.last_stamp = None;
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
