//! Closed surfaces as convex cells, against oracles that share no code with them: volumes of the given triangles by the
//! divergence theorem, membership by solid angles, counts of voxels, and genus by Euler's formula on what was given.
//!
//! - [`random`]: the surfaces of random trees, as they are, rounded to `f32` and to six digits; [`voxels`]: unions of lattice
//!   cubes, which touch in edges and corners and have cavities and handles.
//! - [`cases`]: surfaces that are easily forgotten; [`errors`]: those that bound no solid; [`materials`].
//! - [`convex`]: bodies that must stay whole; [`data`]: meshes of others.

#[path = "../union/generate.rs"]
#[allow(dead_code, reason = "shared with the tests of unions")]
mod generate;
#[path = "../union/rng.rs"]
#[allow(dead_code, reason = "shared with the tests of unions")]
mod rng;
#[path = "../union/scene.rs"]
#[allow(dead_code, unused_macros, unused_imports, reason = "shared with the tests of unions")]
mod scene;
#[path = "../solid/shape.rs"]
#[allow(dead_code, reason = "shared with the tests of solids")]
mod shape;

mod cases;
mod convex;
mod data;
mod errors;
mod judge;
mod materials;
mod random;
mod voxels;
