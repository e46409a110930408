//! Solids from solids: hulls, Minkowski sums, slices and shadows.

mod boxes;
mod convex;
mod hull;
mod minkowski;
mod section;

pub use hull::{hull, hull_with_points};
pub use minkowski::minkowski;
pub use section::{project, slice};
