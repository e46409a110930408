//! The tests of the crate, one module for each subject.

mod coarsen;
mod solid;
