//! The union of convex brushes, from planes to watertight mesh, against oracles that share no code with it.
//!
//! - [`grid`]: boxes on a lattice, also sheared and turned, against voxels: volume, area, faces, components, Euler
//!   characteristic and materials, all counted.
//! - [`sloped`], [`general`]: volume by inclusion and exclusion, membership of points by the winding number of the mesh.
//! - [`invariance`]: what must not change the outcome; [`edge_cases`]: what is easily forgotten.
//!
//! `PLANECUT_SCENES` multiplies the number of random scenes (default 1). A failure prints its seed and the smallest scene
//! found that still fails, as Rust for [`regressions`].

mod edge_cases;
mod general;
mod grid;
mod invariance;
mod materials;
mod measure;
mod regressions;
mod sloped;
mod voxels;
