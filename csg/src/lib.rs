//! Exact CSG over convex bodies.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod brush;
pub mod check;
mod mesh;

pub use brush::{Brush, BrushFace, Material, MaterialId, Model};
pub use mesh::{Mesh, MeshFace};
