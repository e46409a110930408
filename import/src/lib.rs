//! Readers of brush maps, model files, OpenSCAD's trees and meshes.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod edits;
pub mod file;
mod lines;
pub mod map;
pub mod mesh;
pub mod model;
pub mod scad;
mod source;
pub mod stream;
mod stream_error;
mod warning;

pub use source::DEFAULT_MAX_PIECES;
pub use warning::Warning;

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
