//! Combinations of closed meshes.

mod cases;
mod random;
mod soup;
mod winding;
