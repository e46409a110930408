//! The tests of the crate, one module for each subject.

mod blocks;
mod live;
mod tree;
mod union;
