//! Closed surfaces as convex cells, against oracles that share no code with them: volumes of the given triangles by the
//! divergence theorem, membership by solid angles, counts of voxels, and genus by Euler's formula on what was given.
//!
//! - [`random`]: the surfaces of random trees, as they are, rounded to `f32` and to six digits; [`voxels`]: unions of lattice
//!   cubes, which touch in edges and corners and have cavities and handles.
//! - [`cases`]: surfaces that are easily forgotten; [`errors`]: those that bound no solid; [`materials`].
//! - [`convex`]: bodies that must stay whole; [`data`]: meshes of others.

mod cases;
mod convex;
mod data;
mod errors;
mod judge;
mod materials;
mod random;
mod voxels;
mod winding;
