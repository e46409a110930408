//! Shapes against the formulas and definitions of `docs/model-file.md`, worked out here a second time.
//!
//! - [`convex`], [`revolved`], [`extruded`]: volumes, areas and counts of faces and corners; membership of random points from
//!   the definitions, or from the winding number of triangles that the test makes itself.
//! - [`outlines`]: areas, lattice counts, distances. [`hulls`], [`sums`], [`sections`]: identities and mixed volumes.
//! - [`parameters`]: what is not accepted.
//!
//! `PLANECUT_SCENES` multiplies the number of random cases (default 1). A failure names its seed.

mod convex;
mod extruded;
mod hulls;
mod judge;
mod offsets;
mod outlines;
mod parameters;
mod partitions;
mod polygon;
mod revolved;
mod sections;
mod sums;
