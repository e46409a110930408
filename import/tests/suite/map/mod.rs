//! Quake maps.

mod damaged;
mod files;
mod fuzz;
mod syntax;
