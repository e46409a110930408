//! How much a model may grow: counted before anything is copied.

use planecut_csg::Tree;

use super::MAX_PLANES;
use super::error::{Checked, Fault};
use super::json::Entry;
use crate::source::{at_most, planes_of};

/// Most nodes that are evaluated, those in parts counting each time: a bound on work that leaves no brush behind.
pub(super) const MAX_STEPS: u64 = 1 << 26;

/// What is there at the moment.
#[derive(Debug)]
pub(super) struct Budget {
    /// Most brushes, and most corners of outlines.
    limit: usize,
    /// Those of all outlines that were made, those included that later ones took the place of: each is work.
    corners: usize,
    brushes: usize,
    planes: usize,
    steps: u64,
}

/// Brushes and planes of something; triangles of closed meshes count as planes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Size {
    pub(super) brushes: usize,
    pub(super) planes: usize,
}

impl Size {
    /// That of a tree.
    pub(super) fn of(tree: &Tree) -> Self {
        Self { brushes: tree.brushes().len(), planes: planes_of(tree) }
    }

    /// The size of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self { brushes: self.brushes + other.brushes, planes: self.planes + other.planes }
    }

    /// A multiple of it.
    pub(super) fn times(self, count: f64) -> (f64, f64) {
        (self.brushes as f64 * count, self.planes as f64 * count)
    }
}

impl Budget {
    /// Nothing yet, and how many brushes and corners there may be.
    pub(super) fn new(limit: usize) -> Self {
        Self { limit, corners: 0, brushes: 0, planes: 0, steps: 0 }
    }

    /// Counts the corners of an outline.
    ///
    /// # Errors
    /// A fault of the outline where there are too many by now.
    pub(super) fn add_corners(&mut self, entry: Entry, corners: usize) -> Checked<()> {
        self.corners += corners;
        if self.corners <= self.limit {
            return Ok(());
        }
        let found = format!("outlines of {} corners in all, each step counted", self.corners);
        Err(Fault::new(entry, found, at_most(self.limit)))
    }

    /// Counts one more node.
    ///
    /// # Errors
    /// A fault of the node where there were too many.
    pub(super) fn step(&mut self, node: Entry) -> Checked<()> {
        self.steps += 1;
        if self.steps <= MAX_STEPS {
            return Ok(());
        }
        let found = format!("more than {MAX_STEPS} nodes once parts are put in their places");
        Err(Fault::new(node, found, format!("at most {MAX_STEPS}")))
    }

    /// Counts a tree.
    ///
    /// # Errors
    /// A fault of the node where it is too much.
    pub(super) fn add(&mut self, node: Entry, tree: &Tree) -> Checked<()> {
        let size = Size::of(tree);
        self.allow(node, size, 1.0)?;
        self.brushes += size.brushes;
        self.planes += size.planes;
        Ok(())
    }

    /// Counts a tree that is gone.
    pub(super) fn remove(&mut self, tree: &Tree) {
        self.release(Size::of(tree));
    }

    /// Counts something that is gone.
    pub(super) fn release(&mut self, size: Size) {
        self.brushes = self.brushes.saturating_sub(size.brushes);
        self.planes = self.planes.saturating_sub(size.planes);
    }

    /// Whether this number of copies of something still fits.
    ///
    /// # Errors
    /// A fault of the node where they do not.
    pub(super) fn allow(&self, node: Entry, size: Size, copies: f64) -> Checked<()> {
        let (brushes, planes) = size.times(copies);
        let (brushes, planes) = (brushes + self.brushes as f64, planes + self.planes as f64);
        if brushes > self.limit as f64 || copies > self.limit as f64 {
            let found = format!("{} brushes in all", brushes.max(copies));
            return Err(Fault::new(node, found, at_most(self.limit)));
        }
        if planes > MAX_PLANES as f64 {
            return Err(Fault::new(node, format!("{planes} planes in all"), format!("at most {MAX_PLANES}")));
        }
        Ok(())
    }
}
