//! Materials in files: colours, the list of all that a file has, and which ones look alike.

mod color;
mod library;
mod looks;

pub(crate) use color::linear_to_srgb;
pub use color::{distinct_color, material_color};
pub(crate) use library::{Library, unique, unique_names};
pub(crate) use looks::{Looks, looks};
