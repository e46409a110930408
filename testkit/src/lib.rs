//! What tests of several crates share. For tests only: no crate of the product depends on it but for its tests.
//!
//! - [`random`]: the one seeded generator; a printed seed repeats a test on every machine.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod random;
