//! The kernel's integration tests, one program.
//!
//! - [`oracle`]: against the independent oracle of the crate `planecut-oracle`, after every operation.
//! - [`paper`]: the paper's own checks under their names.
//! - [`query`]: queries and measures against exact answers from the plane coefficients alone.
//! - [`view`]: what is seen from outside: vertices, edges, faces, meshes and their validation.
//! - [`hull`]: hulls of points against brute force.
//! - [`figures`]: the figures of the documentation are what the program draws.
//! - `saved`: polytopes and results as data (feature `serde`).
//! - [`vectors`]: the public interface with arrays, tuples and the vectors of other libraries.

mod figures;
mod hull;
mod oracle;
mod paper;
mod query;
#[cfg(feature = "serde")]
mod saved;
mod vectors;
mod view;
