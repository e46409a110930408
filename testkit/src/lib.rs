//! What tests of several crates share. For tests only: no crate of the product depends on it but for its tests.
//!
//! - [`random`]: the one seeded generator; a printed seed repeats a test on every machine.
//! - [`data`]: files that others made, and tests that are ignored where these are absent.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod data;
pub mod random;
