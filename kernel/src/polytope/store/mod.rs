//! Flat arrays of planes and vertices with free lists: a clone is a few copies of memory.
//!
//! A record of a plane is one cache line, a record of a vertex half of one, and a link between vertices names the way
//! back: walking around a face touches one line a vertex and searches nothing.

mod plane;
mod vertex;

pub(super) use plane::{Leaving, PlaneState, PlaneStore};
pub(super) use vertex::{Link, Steps, VertexStore};

use super::VertexIdx;

/// No plane, no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// The index that follows 0, 1, 2 in the cyclic order of the three planes of a vertex.
pub(super) const NEXT: [usize; 3] = [1, 2, 0];
/// The index before.
pub(super) const BEFORE: [usize; 3] = [2, 0, 1];

/// The vertices that an operation took away, made and moved.
#[derive(Debug, Default)]
pub(super) struct Change {
    pub(super) removed: Vec<VertexIdx>,
    pub(super) created: Vec<VertexIdx>,
    pub(super) moved: Vec<VertexIdx>,
}
