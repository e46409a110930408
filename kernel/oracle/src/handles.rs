//! Keeps books of vertex handles by what each operation says it removed and made.

use std::collections::BTreeSet;

use planecut_kernel::{IncrementalPolytope, VertexIdx};

/// Vertices of the simple structure of all of space: the corners of four infinity planes, which no operation named.
const UNNAMED: usize = 4;

/// What an operation says about vertices.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    pub(crate) removed: Vec<VertexIdx>,
    pub(crate) new: Vec<VertexIdx>,
    pub(crate) moved: Vec<VertexIdx>,
}

/// The handles that are there, as the operations named them.
#[derive(Debug)]
pub(crate) struct Handles {
    named: BTreeSet<VertexIdx>,
    unnamed: usize,
}

impl Handles {
    /// Those of all of space.
    pub(crate) fn new() -> Self {
        Self { named: BTreeSet::new(), unnamed: UNNAMED }
    }

    /// Takes in what an operation said, and compares the number of vertices.
    ///
    /// # Errors
    /// Where a removed vertex was not there, a new one was, a moved one is not, or the numbers differ.
    pub(crate) fn update(&mut self, changes: &Changes, polytope: &IncrementalPolytope) -> Result<(), String> {
        for vertex in &changes.removed {
            if !self.named.remove(vertex) {
                let left = self.unnamed.checked_sub(1);
                self.unnamed = left.ok_or_else(|| format!("{vertex:?} was removed but not there: {changes:?}"))?;
            }
        }
        for vertex in &changes.new {
            if !self.named.insert(*vertex) {
                return Err(format!("{vertex:?} is new but was there: {changes:?}"));
            }
        }
        let is_kept = |vertex: &VertexIdx| self.unnamed > 0 || self.named.contains(vertex);
        if changes.moved.iter().any(|v| !is_kept(v) || changes.new.contains(v)) {
            return Err(format!("a moved vertex is new or gone: {changes:?}"));
        }
        if polytope.is_empty() {
            // the operation that emptied the set does not name what went with it
            (self.named, self.unnamed) = (BTreeSet::new(), 0);
            return if changes.new.is_empty() { Ok(()) } else { Err(format!("empty with new vertices: {changes:?}")) };
        }
        let (kept, there) = (self.named.len() + self.unnamed, polytope.simple_vertices().count());
        if kept == there {
            Ok(())
        } else {
            Err(format!("{kept} vertices by the changes, {there} are there: {changes:?}"))
        }
    }
}
