//! The readers: one executable, a folder for each kind of file.
#![forbid(unsafe_code)]

mod edits;
mod map;
mod measures;
mod mesh;
mod model;
mod scad;
