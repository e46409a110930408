//! The stages of the pipeline one by one, for the other crates of this project. What is here may change in any release.
//!
//! - [`Bounds`], [`Boxes`] (a tree of them), [`DisjointSets`] and [`CompensatedSum`] serve many stages.
//! - [`KnownPlanes`] finds planes that are nearly the same, [`size_of`] and [`smallest_size`] say from which difference on they are two,
//!   [`compare`] orders half-spaces, [`curve_number`] places.
//! - [`HalfEdges`] tells which triangles of an index mesh meet at its edges.
//! - [`Body`] is what planes bound, and [`mesh_of_union`] the boundary of several bodies.
//! - [`Ray`] and [`RayCaster`] tell where rays meet boxes and triangles.
//! - [`evaluate_shape`] evaluates a tree whatever its materials.

pub use crate::base::{Bounds, Boxes, CompensatedSum, DisjointSets, Ray, RayCaster};
pub use crate::body::Body;
pub use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, are_all_paired, next, previous};
pub use crate::evaluate::{check_materials, evaluate_shape, material_ranks, mesh_of_union};
pub use crate::plane_table::{KnownPlanes, compare, curve_number, size_of, smallest_size};
