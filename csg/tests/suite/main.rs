//! The tests of the crate, one module for each subject.

mod arrangement;
mod blocks;
mod fuzz_corpus;
mod live;
#[cfg(feature = "serde")]
mod saved;
mod tree;
mod union;
