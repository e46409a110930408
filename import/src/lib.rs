//! Readers of brush maps and meshes.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod map;
pub mod mesh;
mod warning;

pub use warning::Warning;
