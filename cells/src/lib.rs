//! Solids as unions of disjoint convex cells, and their coarsening to fewer cells.
//!
//! [`Solid`] is made from a [`Tree`](planecut_csg::Tree); planes cut it and are removed again, solids are combined, and points
//! and rays are asked for. [`coarsen`] covers a solid by fewer convex bodies.
//!
//! ```
//! use planecut_cells::Solid;
//! use planecut_csg::{Brush, MaterialId, Tree};
//! use planecut_kernel::DVec3;
//!
//! let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
//! let shell = Solid::from_tree(&(block(0.0, 3.0) - block(1.0, 2.0)));
//! assert_eq!(shell.volume(), Some(26.0));
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod coarsen;
mod solid;
pub mod tolerances;

pub use solid::{Cell, CellPlane, CutId, RayHit, Solid, convex_union, joined};

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
