//! Convex bodies are written and read back by the project's own readers.

mod exact;
mod files;
mod names;
mod random;
mod refused;
mod support;
