//! Trees of set operations, from planes to watertight mesh, against oracles that share no code with it.
//!
//! - [`random`]: random trees over bodies with shared planes, turned bodies and half-spaces; [`volume`]: their volume as a
//!   sum over intersections, their membership from the half-spaces alone.
//! - [`algebra`]: the identities of set algebra, bit for bit where the mesh must be the same.
//! - [`cutaway`]: models cut open, against counts of unit cubes.
//! - [`ownership`]: which of coplanar faces emits, against unit faces of a grid and the truth table of `docs/weld.md`.
//! - [`mesh_leaves`]: closed meshes as leaves.
//! - [`edge_cases`]: empty and unbounded results, deep and wide trees, materials.
//! - [`source_lines`]: lines of the input stay with their brushes.

mod algebra;
mod cutaway;
mod edge_cases;
mod materials;
mod mesh_leaves;
mod ownership;
pub(crate) mod random;
mod regressions;
mod sheets;
mod source_lines;
mod touching;
pub(crate) mod volume;
