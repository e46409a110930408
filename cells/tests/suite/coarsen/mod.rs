//! Coarsening, against oracles that share no code with it.
//!
//! - [`judge`]: whether cells hold points, in exact rationals; whether they leave anything of the solid out.
//! - [`cases`]: solids whose figures are known; [`clear_radius`]: what a ball can reach;
//!   [`limits`]: caps, regions kept clear, materials, thickness; [`inner`]: cells within;
//!   [`lower`]: polytopes with fewer planes; [`random`]: hulls of random lattice points at every cap; [`surface`]: meshes; [`recut`]: rings; [`data`]: decompositions that others made; [`written`]: cells as files hold them.

mod cases;
mod clear_radius;
mod data;
mod inner;
mod judge;
mod limits;
mod lower;
mod random;
mod recut;
mod surface;
mod written;
