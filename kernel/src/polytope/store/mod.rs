//! Flat arrays of planes and vertices with free lists: a clone is a few copies of memory.
//!
//! A record of a plane is one cache line, one of a vertex with its position as well, and a link between vertices names the way
//! back: walking around a face touches one line a vertex and searches nothing.

mod places;
mod plane;
mod vertex;

pub(super) use crate::sign::{BEFORE, NEXT};
pub(super) use places::Farthest;
pub(super) use plane::{Leaving, PlaneState, PlaneStore};
pub(super) use vertex::{Link, VertexStore};

use super::VertexIdx;

/// No plane, no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// The vertices that an operation took away, made and moved.
#[derive(Debug, Default)]
pub(super) struct Change {
    pub(super) removed: Vec<VertexIdx>,
    pub(super) created: Vec<VertexIdx>,
    pub(super) moved: Vec<VertexIdx>,
}

/// Whether an operation can take away vertices that it made itself.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    /// It cannot.
    #[default]
    One,
    /// It can: new vertices are marked until it ends.
    Several,
}
