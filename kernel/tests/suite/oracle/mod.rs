//! The kernel against its independent oracle, the crate `planecut-oracle`.
//!
//! - [`signs`]: the predicates against determinants of big integers.
//! - [`tiers`]: which tier answers them.
//! - [`fresh_build`]: any history of adds and removes against a fresh build of the planes that are left.
//! - [`large`]: polytopes of hundreds of planes, the same way.
//! - [`batches`]: batch removal from larger polytopes, the same way.
//! - [`moves`]: what a move reports.
//! - [`copies`]: `clone_from` into what is there.
//! - [`points`]: order and turn of meeting points against rationals.
//! - [`brute_force`]: small polytopes against all plane triples, symbolic perturbation included.
//! - [`corpus`]: what the fuzzer found worth keeping.
//! - [`membership`]: random points against the mesh that leaves the kernel.
//!
//! `PLANECUT_OPS` sets the least number of operations per category and test, `PLANECUT_CASES` that of scripts,
//! `PLANECUT_SEED` the first seed. For millions of operations on all cores there is
//! `PLANECUT_OPS=10000000 cargo run --release -p planecut-oracle --bin soak`.
//! A failing sequence is shrunk and printed as Rust that can be pasted into [`regressions`].

mod batches;
mod brute_force;
mod copies;
mod corpus;
mod fresh_build;
mod large;
mod membership;
mod mesh;
mod moves;
mod points;
mod regressions;
mod signs;
mod tiers;
