//! Combinations of closed meshes.

mod bodies;
mod cases;
mod coincidences;
mod flat_faces;
mod gears;
mod hidden;
mod holes;
mod integers;
mod mixed;
mod random;
mod slits;
pub(crate) mod soup;
mod winding;
