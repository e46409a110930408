//! Convex bodies are written and read back by the project's own readers.
#![forbid(unsafe_code)]

#[path = "../common/mod.rs"]
mod common;
mod exact;
mod files;
mod names;
mod random;
mod refused;
mod support;
