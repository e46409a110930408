//! The tests of the crate, one module for each subject.

mod blocks;
mod live;
#[cfg(feature = "serde")]
mod saved;
mod tree;
mod union;
