//! Queries and measures against exact answers from the plane coefficients alone, without a line of the kernel's code.
//!
//! - [`truth`]: vertices from all triples of planes, extrema from all dual solutions, moments, in rationals.
//! - [`cases`]: random sets of planes, most of them degenerate; a failing one is printed with its seed as Rust.
//!
//! `PLANECUT_SEED` sets the first seed.

mod ball;
mod cases;
mod cone;
mod gain;
mod measure;
mod points;
mod truth;
