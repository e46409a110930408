//! The tests of the crate, one module for each subject.

mod polyhedron;
mod shapes;
