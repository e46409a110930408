//! Shapes as trees of convex bodies: [`primitives`], planar [`outline`]s, hulls, Minkowski sums and sections ([`shaping`]), and closed
//! surfaces of facets ([`mod@polyhedron`]).
//!
//! ```
//! use planecut_csg::{Material, MaterialId, Model, Tree, evaluate};
//! use planecut_shapes::primitives;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let tree = Tree::from(primitives::prism(2.0, 1.0, 4, MaterialId(0))?);
//! let prism = evaluate(&Model { materials: vec![Material::named("stone")], tree })?;
//! assert!((prism.solid.volume - 4.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod outline;
mod parameter;
pub mod polyhedron;
pub mod primitives;
pub mod shaping;
pub mod tolerances;

pub use outline::Outline;
pub use parameter::ShapeError;

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
