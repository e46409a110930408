//! The independent oracle of the kernel: every answer is computed a second time, from the definitions,
//! with big integers and without a line of the kernel's code.
//!
//! - [`signs`]: the three predicates against determinants of big integers.
//! - [`fresh_build`]: any history of adds and removes against a fresh build of the planes that are left.
//! - [`brute_force`]: small polytopes against all plane triples, symbolic perturbation included.
//! - [`membership`]: random points against the mesh that leaves the kernel.
//!
//! `PLANECUT_OPS` sets the number of operations per category and test, `PLANECUT_SEED` the first seed.
//! A failing sequence is shrunk and printed as Rust that can be pasted into [`regressions`].

mod brute_force;
mod category;
mod edges;
mod exact;
mod facets;
mod fresh_build;
mod generators;
mod measures;
mod membership;
mod mesh;
mod random;
mod regressions;
mod replay;
mod script;
mod settings;
mod shrink;
mod signs;
mod solid;
mod structure;
mod truth;
mod watchdog;
