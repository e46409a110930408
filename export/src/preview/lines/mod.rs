//! Edges worth drawing, and their ink.

pub(super) mod dashes;
pub(super) mod edges;
pub(super) mod ink;
