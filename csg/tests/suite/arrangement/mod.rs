//! Combinations of closed meshes.

mod cases;
mod random;
pub(crate) mod soup;
mod winding;
