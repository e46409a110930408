//! Combinations of closed meshes.

mod cases;
mod mixed;
mod random;
pub(crate) mod soup;
mod winding;
