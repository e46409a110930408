//! What the benchmarks share: inputs as plain numbers, and one face for the libraries that are compared.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod cells;
pub mod cubic;
pub mod inputs;
pub mod library;
