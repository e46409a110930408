//! Exact dynamic convex polyhedra.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod double_double;
mod half_space;
mod meet;
mod polytope;
pub mod sign;

pub use glam::{DVec2, DVec3, DVec4};
pub use half_space::{HalfSpace, HalfSpaceError, MAX_NORMAL, MAX_NORMAL_RATIO, MAX_OFFSET_RATIO, MIN_NORMAL};
pub use meet::meet;
pub use polytope::{
    AddPlaneResult, DEFAULT_EPSILON, Face, IncrementalPolytope, InvariantError, Measures, PlaneIdx, RemovePlaneResult,
    Vertex,
};
