//! Solids from solids: hulls, Minkowski sums, slices and shadows.

mod convex;
mod hull;
mod minkowski;
mod section;

pub use hull::hull;
pub use minkowski::minkowski;
pub use section::{project, slice};
