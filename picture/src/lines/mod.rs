//! Edges worth drawing, and their ink.

pub(crate) mod dashes;
pub(crate) mod edges;
pub(crate) mod ink;
